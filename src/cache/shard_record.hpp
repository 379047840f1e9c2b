// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gridmerge/cache/match_cache.hpp"
#include "gridmerge/merge/merger.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// "2/8" is the second of eight shards, of at most kMostShards; none for anything else.
GRIDMERGE_INTERNAL_EXPORT std::optional<Shard> parse_shard(std::string_view text);

/// What a merge needs matches of, and how.
struct MergeWork {
  std::string engine;
  std::vector<std::pair<std::string, std::string>>
      options;                    // that change which matches are due, or what they say
  std::vector<std::string> maps;  // the first digits of content_id(), ascending

  bool operator==(const MergeWork&) const = default;
};

/// That of a merger.
MergeWork work_of(const Merger& merger);

/// What a shard leaves in the cache once its run has ended.
struct ShardRecord {
  Shard shard;
  MergeWork work;
};

/// Lines of text for people, too: the last one has the SHA-256 of all others.
std::string format_shard_record(const ShardRecord& record);

/// What format_shard_record() was given; none for anything else.
std::optional<ShardRecord> parse_shard_record(std::string_view text);

/// Throws FileError. A shard that ends again replaces its record.
void keep_shard_record(const std::filesystem::path& cache, const ShardRecord& record);

/// All that can be read.
std::vector<ShardRecord> find_shard_records(const std::filesystem::path& cache);

/// Who asks for shards that do not fit: a merge, for which all have to be there, or a shard.
enum class AskedBy { merge, shard };

/// What the user should know of the records where matches of `work` are missing; "" if they fit. Shards that
/// have nothing in common with it are merges of their own, and so are all N of N that differ, unless a merge
/// finds no others.
std::string describe_other_shards(const std::vector<ShardRecord>& records, const MergeWork& work,
                                  AskedBy asked);

}  // namespace gridmerge::internal
