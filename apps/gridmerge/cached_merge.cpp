// SPDX-License-Identifier: Apache-2.0
#include "cached_merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cache/shard_record.hpp"
#include "gridmerge/match/stored_match.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

const CLI::Validator kShard(
    [](const std::string& text) {
      return parse_shard(text)
                 ? std::string()
                 : fmt::format("{} is no shard: 2/8 is the second of eight, and there are at most {}", text,
                               kMostShards);
    },
    "");

std::string matches(std::size_t count) {
  return fmt::format("{} {}", count, count == 1 ? "match" : "matches");
}

}  // namespace

std::size_t CacheOptions::shards() const {
  return is_shard() ? parse_shard(shard).value().count : 1;
}

void add_cache_option(CLI::App& command, CacheOptions& options) {
  command
      .add_option(
          "--cache", options.directory,
          "Directory in which the match of each pair is kept, by what the two maps hold and the options "
          "that matter; made if need be. A run that was ended goes on from it, and several may share it")
      ->type_name("DIR");
}

void add_shard_option(CLI::App& command, CacheOptions& options) {
  command
      .add_option(
          "--shard", options.shard,
          "Make the I-th of N parts of the matches, keep them in --cache, and merge nothing. The exit "
          "code is 3 while matches of the merge are missing")
      ->type_name("I/N")
      ->check(kShard);
}

CachedEngine::CachedEngine(const CacheOptions& options, Console& console)
    : options_(options), console_(console) {
  if (options.is_used())
    cache_ = std::make_unique<MatchCache>(options.directory,
                                          [&console](const std::string& message) { console.warn(message); });
}

MergeResult CachedEngine::merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                                const std::vector<std::optional<KnownPose>>& known_poses) {
  if (!cache_) return gridmerge::merge(maps, options, known_poses);
  Merger merger(maps, options, known_poses);
  MatchWorkOptions work;
  work.progress = options.progress;
  const MatchWork done = match_with_cache(merger, *cache_, work);
  work_.found += done.found;
  work_.made += done.made;
  return merger.solve();
}

MatchResult CachedEngine::match(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                const MatchOptions& options, const std::function<MatchResult()>& make) {
  if (!cache_) return make();
  bool is_made = false;
  MatchResult result = cache_->find_or_make(match_key(content_id(fixed), content_id(moving), options), [&] {
    cache_->announce(options.accept_probability);
    is_made = true;
    return make();
  });
  ++(is_made ? work_.made : work_.found);
  return result;
}

void CachedEngine::tell_of_use() {
  if (cache_) console_.tell(fmt::format("{} of the cache, {} made", matches(work_.found), work_.made));
}

ShardOutcome CachedEngine::make_shard(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                                      const std::vector<std::optional<KnownPose>>& known_poses) {
  Merger merger(maps, options, known_poses);
  MatchWorkOptions work;
  work.shard = parse_shard(options_.shard).value();
  work.goes_on_when_full = false;
  work.progress = options.progress;
  const MatchWork done = match_with_cache(merger, *cache_, work);
  std::string text = fmt::format("shard {}: {} made, {} were in the cache\n", options_.shard,
                                 matches(done.made), done.found);
  if (done.missing == 0)
    return {text + "all pairs are matched: merge with --cache and without --shard\n", true};
  return {text + fmt::format(
                     "{} missing, of other shards: run each shard again when all have ended, for the pairs "
                     "that are looked at twice; or merge with --cache, which makes the rest\n",
                     done.missing == 1 ? "1 match is" : fmt::format("{} matches are", done.missing)),
          false};
}

}  // namespace gridmerge::cli
