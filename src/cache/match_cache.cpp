// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/cache/match_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cache/match_file.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "io/atomic_file.hpp"
#include "io/directory_names.hpp"
#include "io/file_reader.hpp"
#include "io/made_directories.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::size_t kKeyDigits = 64;
constexpr std::size_t kFolderDigits = 2;
constexpr const char* kMadeWith = "made-with";  // a file for each engine and probability
constexpr std::string_view kAccept = "_accept_";
constexpr std::size_t kMaxBytes = std::size_t{1} << 24;  // of thousands of hypotheses

/// What is told of matches that were made with other engines or probabilities, which are not of use here.
std::string describe_unused(std::vector<std::string> made_with) {
  std::sort(made_with.begin(), made_with.end());
  std::vector<std::string> engines, accepts;
  for (const std::string& one : made_with) {
    const std::string engine = one.substr(0, one.find(kAccept));
    if (engine == engine_id()) {
      accepts.push_back(one.substr(one.find(kAccept) + kAccept.size()));
    } else if (engines.empty() || engines.back() != engine) {
      engines.push_back(engine);
    }
  }
  if (!accepts.empty())
    return fmt::format(
        "its matches are not used, as they were made with accept {}: give the same to use them",
        fmt::join(accepts, ", "));
  return fmt::format(
      "its matches are not used, as they are of gridmerge {}, and this is {}: use that again, or delete the "
      "directory when it is of no use any more",
      fmt::join(engines, ", "), engine_id());
}

}  // namespace

MatchCache::MatchCache(std::filesystem::path directory, Warn warn)
    : directory_(std::move(directory)),
      made_(std::make_shared<MadeDirectories>(directory_)),
      warn_(std::move(warn)) {
  if (!std::filesystem::is_directory(directory_)) throw FileError(directory_, "is no directory");
  // Whether it can be written to is known for sure when something was.
  const std::filesystem::path trial = directory_ / fmt::format("trial-{}", ::getpid());
  try {
    StagedFile(trial, "trial\n");
  } catch (const FileError& error) {
    const std::string_view why = error.what();
    const std::size_t cause = why.rfind(": ");
    throw FileError(directory_, fmt::format("cannot be written to: {}",
                                            why.substr(cause == std::string_view::npos ? 0 : cause + 2)));
  }
}

std::optional<MatchResult> MatchCache::find(const std::string& key) {
  const std::filesystem::path file = file_of(key);
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, error))) return {};
  try {
    FileReader reader(file, NamedBy::file);
    return parse_match_file(reader.read_all(kMaxBytes), key);
  } catch (const std::invalid_argument& why) {
    if (++damaged_ == 1)
      warn(fmt::format("{}: {}: it is not used, and its maps are matched again", file.string(), why.what()));
  } catch (const FileError& why) {
    if (++damaged_ == 1) warn(fmt::format("{}: it is not used, and its maps are matched again", why.what()));
  }
  return {};
}

void MatchCache::keep(const std::string& key, const MatchResult& match) const {
  const std::filesystem::path file = file_of(key);
  const MadeDirectories made(file.parent_path());
  write_file_atomically(file, format_match_file(match, key));
}

void MatchCache::keep_if_possible(const std::string& key, const MatchResult& match) {
  try {
    keep(key, match);
  } catch (const FileError& error) {
    warn_not_kept(error);
  }
}

void MatchCache::announce(double accept_probability) {
  const std::string name = fmt::format("{}{}{}", engine_id(), kAccept, accept_probability);
  if (!announced_.insert(name).second) return;
  const std::filesystem::path folder = directory_ / kMadeWith;
  std::error_code unreadable;
  std::vector<std::string> others = names_in(folder, unreadable);
  if (std::find(others.begin(), others.end(), name) != others.end()) return;
  std::erase_if(others, [](const std::string& other) {
    return other.starts_with('.') || other.find(kAccept) == std::string::npos;
  });
  try {
    const MadeDirectories made(folder);
    write_file_atomically(folder / name, name + "\n");
  } catch (const FileError& error) {
    warn_not_kept(error);
  }
  if (!others.empty()) warn(fmt::format("{}: {}", directory_.string(), describe_unused(std::move(others))));
}

MatchResult MatchCache::find_or_make(const std::string& key, const std::function<MatchResult()>& make) {
  if (std::optional<MatchResult> match = find(key)) return *std::move(match);
  MatchResult match = make();
  keep_if_possible(key, match);
  return match;
}

void MatchCache::warn_not_kept(const std::exception& why) {
  if (has_kept_all_) warn(fmt::format("{}: matches that cannot be kept are made all the same", why.what()));
  has_kept_all_ = false;
}

void MatchCache::warn(const std::string& message) const {
  if (warn_) warn_(message);
}

std::filesystem::path MatchCache::file_of(const std::string& key) const {
  const bool is_digest =
      key.size() == kKeyDigits && key.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!is_digest)  // any other may lead out of the directory
    throw std::invalid_argument("the key of a match has 64 hexadecimal digits, as match_key() gives it");
  return directory_ / key.substr(0, kFolderDigits) / (key.substr(kFolderDigits) + ".match");
}

}  // namespace gridmerge
