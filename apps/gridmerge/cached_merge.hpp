// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "gridmerge/cache/match_cache.hpp"
#include "gridmerge/merge/merge.hpp"

namespace gridmerge::cli {

/// Where matches are kept, and which part of them is made.
struct CacheOptions {
  std::string directory;
  std::string shard;  // as the command line says it

  bool is_used() const { return !directory.empty(); }
  bool is_shard() const { return !shard.empty(); }
  /// How many shards share the matches; 1 if none is asked for.
  std::size_t shards() const;
};

/// What became of a shard.
struct ShardOutcome {
  std::string text;          ///< the same in words
  bool is_all_made = false;  ///< no match of the merge is missing
};

/// --cache.
void add_cache_option(CLI::App& command, CacheOptions& options);

/// --shard: needs add_cache_option() of the same command.
void add_shard_option(CLI::App& command, CacheOptions& options);

/// Merges and matches as the engine does, through a cache if one is asked for.
class CachedEngine {
 public:
  /// Throws FileError for a directory that cannot be written to. `console` must outlive this.
  CachedEngine(const CacheOptions& options, Console& console);

  MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                    const std::vector<std::optional<KnownPose>>& known_poses = {});

  /// Of one pair. `make` is what makes it where the cache does not have it.
  MatchResult match(const OccupancyGrid& fixed, const OccupancyGrid& moving, const MatchOptions& options,
                    const std::function<MatchResult()>& make);

  /// Makes the shard's part of the matches of a merge.
  ShardOutcome make_shard(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                          const std::vector<std::optional<KnownPose>>& known_poses);

  /// Tells how many matches the cache had, and how many were made; nothing without a cache.
  void tell_of_use();

 private:
  CacheOptions options_;
  Console& console_;
  MatchWork work_;                     // so far
  std::unique_ptr<MatchCache> cache_;  // none if none is asked for
};

}  // namespace gridmerge::cli
