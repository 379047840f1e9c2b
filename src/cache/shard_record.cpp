// SPDX-License-Identifier: Apache-2.0
#include "cache/shard_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <system_error>

#include "grid/sha256.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "io/atomic_file.hpp"
#include "io/directory_names.hpp"
#include "io/file_reader.hpp"
#include "io/made_directories.hpp"
#include "match/bytes.hpp"
#include "merge/pair_choice.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::string_view kFormat = "gridmerge shard 1\n";
constexpr std::string_view kEnding = ".shard";
constexpr std::string_view kDigestLine = "sha256: ";
constexpr std::size_t kDigits = 16;                      // of a digest that tells a few thousand things apart
constexpr std::size_t kMaxBytes = std::size_t{1} << 24;  // of hundreds of thousands of maps

std::string digest_of(std::string_view text, std::size_t digits) {
  return to_hex(Sha256().add(text).digest()).substr(0, digits);
}

std::string describe_known_poses(const Merger& merger, const std::vector<std::string>& contents) {
  const std::vector<Merger::MapId> ids = merger.maps();
  std::vector<std::string> known;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::optional<KnownPose> pose = merger.known_pose(ids[i]);
    if (!pose) continue;
    ByteWriter bytes;
    bytes.text(contents[i]);
    bytes.pose(pose->T_world_map);
    bytes.number(pose->sd_position);
    bytes.number(pose->sd_theta);
    bytes.byte(pose->fixed ? 1 : 0);
    known.push_back(bytes.take());
  }
  if (known.empty()) return "none";
  std::sort(known.begin(), known.end());
  std::string all;
  for (const std::string& one : known) all += one;
  return digest_of(all, kDigits);
}

/// The whole number at the beginning, which is taken off.
std::optional<std::size_t> take_whole(std::string_view& text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

/// "1/3, 2/3 and 5 more".
std::string list_shards(const std::set<std::pair<std::size_t, std::size_t>>& shards) {
  constexpr std::size_t kMost = 4;
  std::string text;
  std::size_t listed = 0;
  for (const auto& [count, index] : shards) {
    if (listed == kMost) return text + fmt::format(" and {} more", shards.size() - kMost);
    text += fmt::format("{}{}/{}", listed++ == 0 ? "" : ", ", index + 1, count);
  }
  return text;
}

std::size_t count_common(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common.size();
}

/// In what another work differs, as "accept 0.9 instead of 0.95".
std::string describe_difference(const MergeWork& other, const MergeWork& work) {
  std::vector<std::string> parts;
  if (other.engine != work.engine)
    parts.push_back(fmt::format("gridmerge {} instead of {}", other.engine, work.engine));
  const std::map<std::string, std::string> own(work.options.begin(), work.options.end());
  for (const auto& [name, value] : other.options) {
    const auto found = own.find(name);
    if (name == "known-poses") {
      if (found != own.end() && found->second != value) parts.emplace_back("other known poses");
    } else if (found == own.end() || found->second != value) {
      parts.push_back(
          fmt::format("{} {} instead of {}", name, value, found == own.end() ? "none" : found->second));
    }
  }
  if (other.maps != work.maps) {
    const std::size_t common = count_common(other.maps, work.maps);
    parts.push_back(fmt::format("{} maps, of which {} are among the {} here", other.maps.size(), common,
                                work.maps.size()));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The shards of one work, by number of shards.
using Shards = std::set<std::pair<std::size_t, std::size_t>>;  // count, index

bool is_any_whole(const Shards& shards) {
  std::map<std::size_t, std::size_t> there;
  for (const auto& [count, index] : shards) {
    if (++there[count] == count) return true;
  }
  return false;
}

/// Those that are not there, if all are of one number of shards.
Shards missing_of(const Shards& shards) {
  Shards missing;
  if (shards.empty() || shards.begin()->first != shards.rbegin()->first) return missing;
  const std::size_t count = shards.begin()->first;
  for (std::size_t index = 0; index < count; ++index) {
    if (!shards.contains({count, index})) missing.insert({count, index});
  }
  return missing;
}

}  // namespace

std::optional<Shard> parse_shard(std::string_view text) {
  const std::optional<std::size_t> index = take_whole(text);
  if (!index || !text.starts_with('/')) return std::nullopt;
  text.remove_prefix(1);
  const std::optional<std::size_t> count = take_whole(text);
  if (!count || !text.empty() || *index == 0 || *index > *count || *count > kMostShards) return std::nullopt;
  return Shard{*index - 1, *count};
}

MergeWork work_of(const Merger& merger) {
  const std::vector<std::string> contents = merger.contents();
  const MergeOptions& options = merger.options();
  // Copies count once, as in the merge.
  const std::set<std::string> distinct(contents.begin(), contents.end());
  const bool takes_all = takes_all_pairs(distinct.size(), options.max_missed);
  MergeWork work;
  work.engine = engine_id();
  work.options = {{"search", name_of(options.match.search)},
                  {"accept", fmt::format("{}", options.match.accept_probability)},
                  {"max-false-joins", fmt::format("{}", options.max_false_joins)},
                  {"max-missed", fmt::format("{}", takes_all ? 0.0 : options.max_missed)},
                  {"known-poses", describe_known_poses(merger, contents)}};
  for (const std::string& content : contents) work.maps.push_back(content.substr(0, kDigits));
  std::sort(work.maps.begin(), work.maps.end());
  return work;
}

std::string format_shard_record(const ShardRecord& record) {
  std::string text(kFormat);
  text += fmt::format("shard: {}/{}\nengine: {}\n", record.shard.index + 1, record.shard.count,
                      record.work.engine);
  for (const auto& [name, value] : record.work.options) text += fmt::format("{}: {}\n", name, value);
  for (const std::string& map : record.work.maps) text += fmt::format("map: {}\n", map);
  return text + fmt::format("{}{}\n", kDigestLine, digest_of(text, std::string::npos));
}

std::optional<ShardRecord> parse_shard_record(std::string_view text) {
  const std::size_t last = text.rfind(kDigestLine);
  if (!text.starts_with(kFormat) || last == std::string_view::npos) return std::nullopt;
  if (text.substr(last) !=
      fmt::format("{}{}\n", kDigestLine, digest_of(text.substr(0, last), std::string::npos)))
    return std::nullopt;
  ShardRecord record;
  record.shard.count = 0;
  for (std::string_view rest = text.substr(kFormat.size(), last - kFormat.size()); !rest.empty();) {
    const std::size_t end = rest.find('\n'), colon = rest.find(": ");
    if (end == std::string_view::npos || colon > end) return std::nullopt;
    const std::string_view name = rest.substr(0, colon);
    const std::string value(rest.substr(colon + 2, end - colon - 2));
    rest.remove_prefix(end + 1);
    if (name == "shard") {
      const std::optional<Shard> shard = parse_shard(value);
      if (!shard) return std::nullopt;
      record.shard = *shard;
    } else if (name == "engine") {
      record.work.engine = value;
    } else if (name == "map") {
      record.work.maps.push_back(value);
    } else {
      record.work.options.emplace_back(name, value);
    }
  }
  return record.shard.count == 0 ? std::nullopt : std::optional(record);
}

void keep_shard_record(const std::filesystem::path& cache, const ShardRecord& record) {
  const std::filesystem::path folder = cache / "shards";
  const MadeDirectories made(folder);
  const std::string text = format_shard_record(record);
  write_file_atomically(folder / fmt::format("{}-of-{}-{}{}", record.shard.index + 1, record.shard.count,
                                             digest_of(text, kDigits), kEnding),
                        text);
}

std::vector<ShardRecord> find_shard_records(const std::filesystem::path& cache) {
  std::vector<ShardRecord> records;
  std::error_code unreadable;
  std::vector<std::string> names = names_in(cache / "shards", unreadable);
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    if (!name.ends_with(kEnding)) continue;
    try {
      FileReader reader(cache / "shards" / name, NamedBy::file);
      if (std::optional<ShardRecord> record = parse_shard_record(reader.read_all(kMaxBytes)))
        records.push_back(*std::move(record));
    } catch (const FileError&) {  // no record, as a shard that has not ended
    }
  }
  return records;
}

std::string describe_other_shards(const std::vector<ShardRecord>& records, const MergeWork& work,
                                  AskedBy asked) {
  Shards own;
  std::vector<std::pair<MergeWork, Shards>> others;
  for (const ShardRecord& record : records) {
    const std::pair shard(record.shard.count, record.shard.index);
    if (record.work == work) {
      own.insert(shard);
      continue;
    }
    if (count_common(record.work.maps, work.maps) == 0) continue;
    const auto same = std::find_if(others.begin(), others.end(),
                                   [&](const auto& other) { return other.first == record.work; });
    if (same == others.end()) {
      others.emplace_back(record.work, Shards{shard});
    } else {
      same->second.insert(shard);
    }
  }
  if (is_any_whole(own)) return {};
  std::vector<std::string> parts;
  if (!own.empty() && own.begin()->first != own.rbegin()->first)
    parts.push_back(fmt::format("{} are of different numbers of shards", list_shards(own)));
  for (const auto& [other, shards] : others) {
    const bool is_of_its_own = is_any_whole(shards) && !(asked == AskedBy::merge && own.empty());
    if (!is_of_its_own)
      parts.push_back(fmt::format("{} {} made with {}", list_shards(shards),
                                  shards.size() == 1 ? "was" : "were", describe_difference(other, work)));
  }
  if (!parts.empty())
    return fmt::format(
        "shards do not fit: {}. Run all shards with the same N, maps, options and version of gridmerge",
        fmt::join(parts, "; "));
  const Shards missing = missing_of(own);
  if (asked == AskedBy::shard || missing.empty()) return {};
  return fmt::format("shards that have not ended here: {}", list_shards(missing));
}

}  // namespace gridmerge::internal
