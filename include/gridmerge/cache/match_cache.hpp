// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merger.hpp"

namespace gridmerge {

namespace internal {
class MadeDirectories;
}

/// Matches on disk, by what they are matches of: match_key(). What takes a key throws std::invalid_argument
/// for one that is not of that form, 64 hexadecimal digits in lower case. A file of a few kilobytes holds
/// one, in one of 256 folders, with a digest of all that it holds. Several processes may use a directory at
/// once, on one machine or on a shared file system: files are written whole, and renamed into place.
///
/// A file that is damaged, or that somebody else has put there, counts as missing. Matches of other maps,
/// options or engines have other names, and so are never found; announce() tells of them.
class GRIDMERGE_EXPORT MatchCache {
 public:
  /// Takes a line for the user.
  using Warn = std::function<void(const std::string&)>;

  /// The directory is made if need be, and goes with this object and its copies if nothing is in it. Throws
  /// FileError, an error that names it, when it cannot be written to.
  explicit MatchCache(std::filesystem::path directory, Warn warn = {});

  /// The match of this key if there is one. Of the first file that is damaged it warns.
  std::optional<MatchResult> find(const std::string& key);

  /// Throws FileError; what was kept is as before then. May be called by several threads at once.
  void keep(const std::string& key, const MatchResult& match) const;

  /// As keep(), for who goes on without it: of the first match that cannot be kept it warns.
  void keep_if_possible(const std::string& key, const MatchResult& match);

  /// The match of this key: the one that is there, or what `make` gives, which is kept if possible.
  MatchResult find_or_make(const std::string& key, const std::function<MatchResult()>& make);

  /// To be called before matches are made; maps are joined from this probability on. Warns if none of this
  /// engine and of this probability was made here yet, but others were, which are not used. Leaves a mark
  /// that these were begun.
  void announce(double accept_probability);

  /// Where it is.
  const std::filesystem::path& directory() const { return directory_; }

  /// Tells the user a line.
  void warn(const std::string& message) const;

  /// How many damaged files were found.
  std::size_t damaged() const { return damaged_; }

  /// For who calls keep() and goes on when it throws: warns, the first time.
  void warn_not_kept(const std::exception& why);

 private:
  std::filesystem::path file_of(const std::string& key) const;

  std::filesystem::path directory_;
  std::shared_ptr<const internal::MadeDirectories> made_;
  Warn warn_;
  std::size_t damaged_ = 0;
  bool has_kept_all_ = true;
  std::set<std::string> announced_;
};

/// More parts than any batch system has jobs: a larger number is a mistake.
inline constexpr std::size_t kMostShards = 1'000'000;

/// A part of the matches of a merge: of each round, in the order in which they are due, every `count`th.
struct Shard {
  std::size_t index = 0;  ///< which part, less than `count`
  std::size_t count = 1;  ///< how many parts there are
};

/// How match_with_cache() goes about it.
struct MatchWorkOptions {
  Shard shard;  ///< what is made; all by default
  /// When a match cannot be written, warns once and goes on; without it that is an error.
  bool goes_on_when_full = true;
  /// Called with the numbers of matches of a round that are there, and that are due; never from two threads
  /// at once.
  std::function<void(std::size_t, std::size_t)> progress;
};

/// What became of the matches that a merge needs.
struct MatchWork {
  std::size_t found = 0;  ///< in the cache
  std::size_t made = 0;   ///< here
  /// Of other shards, which have not made them yet: later rounds wait for them. 0 when all is matched.
  std::size_t missing = 0;
};

/// Warns of the records of shards in the cache, if they do not fit this merge: for who makes the matches that
/// it lacks by other means than match_with_cache().
GRIDMERGE_EXPORT void warn_of_other_shards(const Merger& merger, MatchCache& cache);

/// Hands the merger the matches that are due: those of the cache, and those of the shard that it makes and
/// keeps there. Round by round, until nothing is due or the rest is for others to make. Matches are found and
/// kept by what the merger's maps hold as they are now. Threads as the merger's; may be cancelled, and then
/// goes on where it was.
///
/// A shard of several leaves a record of what it was a part of, once its run has ended. Where matches are
/// missing, the cache warns of records that do not fit: of another number of shards, of other options or
/// maps, or of another engine. Throws FileError, std::invalid_argument for a shard that there is not, and
/// Cancelled.
GRIDMERGE_EXPORT MatchWork match_with_cache(Merger& merger, MatchCache& cache,
                                            const MatchWorkOptions& options = {});

}  // namespace gridmerge
