// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "cache/comparison_file.hpp"
#include "cache/shard_record.hpp"
#include "grid/parallel.hpp"
#include "gridmerge/cache/match_cache.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/match/stored_match.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// A match that the cache does not have.
struct Missing {
  DueMatch due;
  std::string key;
};

class Round {
 public:
  Round(Merger& merger, MatchCache& cache, const MatchWorkOptions& options)
      : merger_(merger), cache_(cache), options_(options) {}

  void make(const std::vector<Missing>& missing, std::size_t done, std::size_t total) {
    std::vector<MatchResult> made(missing.size());
    std::mutex telling;
    parallel_tasks(missing.size(), [&](std::size_t i) {
      throw_if_cancelled();
      made[i] = merger_.make(missing[i].due);
      keep(missing[i].key, made[i], telling);
      const std::lock_guard lock(telling);
      if (options_.progress) options_.progress(++done, total);
    });
    for (std::size_t i = 0; i < missing.size(); ++i) merger_.hand_in(missing[i].due, std::move(made[i]));
  }

 private:
  void keep(const std::string& key, const MatchResult& match, std::mutex& telling) {
    try {
      cache_.keep(key, match);
    } catch (const FileError& error) {
      if (!options_.goes_on_when_full) throw;
      const std::lock_guard lock(telling);
      cache_.warn_not_kept(error);
    }
  }

  Merger& merger_;
  MatchCache& cache_;
  const MatchWorkOptions& options_;
};

std::map<Merger::MapId, std::string> contents_of(const Merger& merger) {
  const std::vector<Merger::MapId> ids = merger.maps();
  const std::vector<std::string> contents = merger.contents();
  std::map<Merger::MapId, std::string> by_id;
  for (std::size_t i = 0; i < ids.size(); ++i) by_id[ids[i]] = contents[i];
  return by_id;
}

void warn_of_misfits(const MatchCache& cache, const std::vector<ShardRecord>& records, const MergeWork& work,
                     AskedBy asked) {
  const std::string text = describe_other_shards(records, work, asked);
  if (!text.empty()) cache.warn(fmt::format("{}: {}", cache.directory().string(), text));
}

/// While it lives.
class KeptComparisons {
 public:
  KeptComparisons(Merger& merger, ComparisonStore store)
      : merger_(merger), before_(merger.keep_comparisons(std::move(store))) {}
  ~KeptComparisons() { merger_.keep_comparisons(std::move(before_)); }
  KeptComparisons(const KeptComparisons&) = delete;
  KeptComparisons& operator=(const KeptComparisons&) = delete;

 private:
  Merger& merger_;
  ComparisonStore before_;
};

/// Keeps its record, and warns of others if it has to wait for them.
void end_shard(MatchCache& cache, const ShardRecord& record, const MatchWork& done,
               const MatchWorkOptions& options) {
  try {
    keep_shard_record(cache.directory(), record);
  } catch (const FileError& error) {
    if (!options.goes_on_when_full) throw;
    cache.warn_not_kept(error);
  }
  if (done.missing > 0)
    warn_of_misfits(cache, find_shard_records(cache.directory()), record.work, AskedBy::shard);
}

}  // namespace

void warn_of_other_shards(const Merger& merger, MatchCache& cache) {
  const std::vector<ShardRecord> records = find_shard_records(cache.directory());
  if (!records.empty()) warn_of_misfits(cache, records, work_of(merger), AskedBy::merge);
}

MatchWork match_with_cache(Merger& merger, MatchCache& cache, const MatchWorkOptions& options) {
  if (options.shard.index >= options.shard.count || options.shard.count > kMostShards)
    throw std::invalid_argument("there is no such shard");
  const std::map<Merger::MapId, std::string> contents = contents_of(merger);
  const KeptComparisons kept(merger, comparisons_in(cache, options.shard, options.goes_on_when_full));
  const bool is_shard = options.shard.count > 1;
  bool is_told = false;  // what the user should know before matches are made
  MatchWork work;
  while (work.missing == 0) {
    const std::vector<DueMatch> due = merger.due();
    if (due.empty()) break;
    const MatchOptions how = merger.match_options(due.front().search);
    std::vector<Missing> missing;
    std::size_t found = 0;
    for (std::size_t i = 0; i < due.size(); ++i) {
      throw_if_cancelled();
      const std::string key = match_key(contents.at(due[i].fixed), contents.at(due[i].moving), how);
      if (std::optional<MatchResult> match = cache.find(key)) {
        merger.hand_in(due[i], std::move(*match));
        ++found;
      } else if (i % options.shard.count == options.shard.index) {
        missing.push_back({due[i], key});
      } else {
        ++work.missing;
      }
    }
    if (!missing.empty() && !is_told) {
      cache.announce(how.accept_probability);
      if (!is_shard)
        warn_of_misfits(cache, find_shard_records(cache.directory()), work_of(merger), AskedBy::merge);
      is_told = true;
    }
    if (options.progress) options.progress(found, due.size());
    with_threads(how.threads, [&] { Round(merger, cache, options).make(missing, found, due.size()); });
    work.found += found;
    work.made += missing.size();
  }
  if (is_shard) end_shard(cache, {options.shard, work_of(merger)}, work, options);
  return work;
}

}  // namespace gridmerge
