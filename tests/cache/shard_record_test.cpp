// SPDX-License-Identifier: Apache-2.0
#include "cache/shard_record.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gridmerge/io/file_error.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "merge/team.hpp"

namespace gridmerge {

using namespace internal;

namespace {

MergeWork some_work() {
  return {
      "1.2.3+abc", {{"accept", "0.95"}, {"max-missed", "0"}, {"known-poses", "none"}}, {"aa", "bb", "cc"}};
}

MergeWork work_with(const std::string& name, const std::string& value) {
  MergeWork work = some_work();
  for (auto& [option, said] : work.options)
    if (option == name) said = value;
  return work;
}

/// Shards of one work, counted from 1.
void add(std::vector<ShardRecord>& records, const MergeWork& work, std::size_t count,
         const std::vector<std::size_t>& shards) {
  for (const std::size_t shard : shards) records.push_back({{shard - 1, count}, work});
}

std::string told_to_merge(const std::vector<ShardRecord>& records) {
  return describe_other_shards(records, some_work(), AskedBy::merge);
}

std::string told_to_shard(const std::vector<ShardRecord>& records) {
  return describe_other_shards(records, some_work(), AskedBy::shard);
}

const std::string kWhatHelps = ". Run all shards with the same N, maps, options and version of gridmerge";

TEST(ShardRecordText, GivesWhatItWasGiven) {
  const ShardRecord record{{1, 4}, some_work()};
  const std::string text = format_shard_record(record);
  const ShardRecord again = parse_shard_record(text).value();
  EXPECT_EQ(again.shard.index, 1u);
  EXPECT_EQ(again.shard.count, 4u);
  EXPECT_EQ(again.work, record.work);
  EXPECT_NE(text.find("shard: 2/4\n"), std::string::npos) << text;
}

TEST(ShardRecordText, WhatIsDamagedIsNone) {
  const std::string good = format_shard_record({{1, 4}, some_work()});
  for (std::size_t i = 0; i < good.size(); ++i) {
    EXPECT_FALSE(parse_shard_record(good.substr(0, i))) << i;
    std::string changed = good;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(parse_shard_record(changed)) << i;
  }
  EXPECT_FALSE(parse_shard_record(good + "x"));
}

TEST(ParseShard, TakesTheFirstToTheLastOfAMillionAtMost) {
  for (const char* text : {"1/1", "3/3", "1/1000000", "1000000/1000000"})
    EXPECT_TRUE(parse_shard(text)) << text;
  EXPECT_EQ(parse_shard("2/8").value().index, 1u);
  EXPECT_EQ(parse_shard("2/8").value().count, 8u);
  for (const char* text : {"", "1", "1/", "/1", "0/3", "4/3", "1/3x", "1/-3", "1/1000001"})
    EXPECT_FALSE(parse_shard(text)) << text;
}

TEST(ShardRecords, AreFoundInTheOrderOfTheirNames) {
  const test::TemporaryDirectory directory;
  for (std::size_t i = 0; i < 9; ++i)
    keep_shard_record(directory.path(), {{(5 * i + 3) % 9, 9}, some_work()});
  std::vector<std::size_t> found;
  for (const ShardRecord& record : find_shard_records(directory.path())) found.push_back(record.shard.index);
  EXPECT_EQ(found, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(ShardRecords, OfMoreThanSixteenMebibytesAreNone) {
  const test::TemporaryDirectory directory;
  keep_shard_record(directory.path(), {{0, 2}, some_work()});
  const MergeWork large = work_with("accept", std::string(std::size_t{1} << 24, '9'));
  directory.write("shards/2-of-2-large.shard", format_shard_record({{1, 2}, large}));
  const std::vector<ShardRecord> found = find_shard_records(directory.path());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].shard.index, 0u);
}

TEST(DescribeOtherShards, SaysNothingOfShardsThatFit) {
  std::vector<ShardRecord> records;
  EXPECT_EQ(told_to_merge(records), "");
  add(records, some_work(), 3, {1, 2, 3});
  EXPECT_EQ(told_to_merge(records), "");
  add(records, some_work(), 2, {1});  // one that was tried before
  add(records, work_with("accept", "0.9"), 2, {1, 2});
  EXPECT_EQ(told_to_merge(records), "");
}

TEST(DescribeOtherShards, NamesThoseThatHaveNotEnded) {
  std::vector<ShardRecord> records;
  add(records, some_work(), 9, {2, 4});
  EXPECT_EQ(told_to_merge(records), "shards that have not ended here: 1/9, 3/9, 5/9, 6/9 and 3 more");
  EXPECT_EQ(told_to_shard(records), "");  // they may be at work
}

TEST(DescribeOtherShards, NamesOtherNumbersOfShards) {
  std::vector<ShardRecord> records;
  add(records, some_work(), 3, {1});
  add(records, some_work(), 4, {2});
  const std::string text = "shards do not fit: 1/3, 2/4 are of different numbers of shards" + kWhatHelps;
  EXPECT_EQ(told_to_merge(records), text);
  EXPECT_EQ(told_to_shard(records), text);
}

TEST(DescribeOtherShards, NamesOtherOptionsMapsAndEngines) {
  std::vector<ShardRecord> records;
  MergeWork other = work_with("max-missed", "0.25");
  other.engine = "1.2.2+abc";
  add(records, some_work(), 3, {1});
  add(records, other, 3, {2});
  add(records, work_with("known-poses", "1234"), 5, {1});
  other = some_work();
  other.maps = {"bb", "cc", "dd", "ee"};
  add(records, other, 3, {3});
  const std::string text =
      "shards do not fit: 2/3 was made with gridmerge 1.2.2+abc instead of 1.2.3+abc, max-missed 0.25 "
      "instead of "
      "0; 1/5 was made with other known poses; 3/3 was made with 4 maps, of which 2 are among the 3 here" +
      kWhatHelps;
  EXPECT_EQ(told_to_merge(records), text);
  EXPECT_EQ(told_to_shard(records), text);
}

TEST(DescribeOtherShards, MergesOfTheirOwnAreNamedOnlyWhereThereIsNothingElse) {
  std::vector<ShardRecord> records;
  MergeWork strange = some_work();
  strange.maps = {"xx", "yy"};
  add(records, strange, 2, {1});
  EXPECT_EQ(told_to_merge(records), "");
  add(records, work_with("accept", "0.9"), 2, {1, 2});
  EXPECT_EQ(told_to_merge(records),
            "shards do not fit: 1/2, 2/2 were made with accept 0.9 instead of 0.95" + kWhatHelps);
  EXPECT_EQ(told_to_shard(records), "");
  add(records, some_work(), 3, {1});
  EXPECT_EQ(told_to_merge(records), "shards that have not ended here: 2/3, 3/3");
}

class ShardsTest : public testing::Test {
 protected:
  Merger filled(const MergeOptions& options = {},
                const std::vector<std::optional<KnownPose>>& known = {}) const {
    return Merger(team.maps, options, known);
  }

  MatchWork work(const MergeOptions& options, const Shard& shard) {
    Merger merger = filled(options);
    MatchCache cache(directory.file("matches"), [this](const std::string& line) { warned.push_back(line); });
    MatchWorkOptions how;
    how.shard = shard;
    return match_with_cache(merger, cache, how);
  }

  const test::Team team;
  const test::TemporaryDirectory directory;
  std::vector<std::string> warned;
};

TEST_F(ShardsTest, LeaveARecordThatReplacesTheirLast) {
  work({}, {0, 2});
  work({}, {0, 2});
  work({}, {1, 2});
  work({}, {0, 1});  // no shard
  const std::vector<ShardRecord> records = find_shard_records(directory.file("matches"));
  ASSERT_EQ(records.size(), 2u);
  for (const ShardRecord& record : records) EXPECT_EQ(record.work, work_of(filled()));
  EXPECT_TRUE(warned.empty());
}

TEST_F(ShardsTest, WorkIsToldApartByWhatChangesMatches) {
  const MergeWork plain = work_of(filled());
  MergeOptions options;
  options.max_missed = 0.5;  // of few maps all pairs are looked at
  options.transform = MapTransform::affine;
  EXPECT_EQ(work_of(filled(options)), plain);
  options.max_false_joins = 0.2;
  EXPECT_NE(work_of(filled(options)), plain);
  const KnownPose known{{1.0, 2.0, 0.3}, 1.0, 0.1, false};
  EXPECT_NE(work_of(filled({}, {known})), plain);
  std::vector<OccupancyGrid> others = team.maps;
  std::swap(others[0], others[1]);
  EXPECT_EQ(work_of(Merger(others)), plain);
  others[0].cells[3] = Cell::occupied;
  EXPECT_NE(work_of(Merger(others)), plain);
}

TEST_F(ShardsTest, WorkIsToldApartByEveryNumberOfAKnownPose) {
  const MergeWork plain = work_of(filled());
  EXPECT_EQ(plain.engine, engine_id());
  EXPECT_TRUE(std::find(plain.options.begin(), plain.options.end(),
                        std::pair<std::string, std::string>("known-poses", "none")) != plain.options.end());
  const KnownPose known{{1.0, 2.0, 0.3}, 1.0, 0.1, false};
  std::vector<MergeWork> works{plain, work_of(filled({}, {known})),
                               work_of(filled({}, {std::nullopt, known}))};
  for (int i = 0; i < 6; ++i) {
    KnownPose other = known;
    if (i < 5)
      *std::array{&other.T_world_map.x, &other.T_world_map.y, &other.T_world_map.theta, &other.sd_position,
                  &other.sd_theta}[static_cast<std::size_t>(i)] += 0.01;
    other.fixed = i == 5;
    works.push_back(work_of(filled({}, {other})));
  }
  for (std::size_t i = 0; i < works.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(works[i], works[j]) << i << " " << j;
  EXPECT_EQ(works[1], work_of(filled({}, {known})));
}

TEST_F(ShardsTest, AMergeThatLacksMatchesIsTold) {
  MergeOptions surer;
  surer.match.accept_probability = 0.99;
  work({}, {0, 2});
  EXPECT_TRUE(warned.empty());
  work(surer, {1, 2});
  ASSERT_EQ(warned.size(), 2u);
  const std::string folder = directory.file("matches");
  EXPECT_EQ(warned[0], folder +
                           ": its matches are not used, as they were made with accept 0.95: give the same to "
                           "use them");
  EXPECT_EQ(warned[1],
            folder + ": shards do not fit: 1/2 was made with accept 0.95 instead of 0.99" + kWhatHelps);
  warned.clear();
  const MatchWork last = work({}, {0, 1});
  EXPECT_GT(last.found, 0u);
  EXPECT_EQ(last.found + last.made, 14u);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_EQ(warned[0],
            folder + ": shards do not fit: 2/2 was made with accept 0.99 instead of 0.95" + kWhatHelps);
  work({}, {0, 1});
  EXPECT_EQ(warned.size(), 1u) << "nothing is missing by now";
}

TEST_F(ShardsTest, WhoMakesMatchesElsewhereMayAsk) {
  work({}, {0, 2});
  MatchCache cache(directory.file("matches"), [this](const std::string& line) { warned.push_back(line); });
  warn_of_other_shards(filled(), cache);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_NE(warned[0].find("shards that have not ended here: 2/2"), std::string::npos) << warned[0];
}

TEST_F(ShardsTest, WhatIsNoRecordIsPassedOver) {
  work({}, {0, 2});
  const std::string folder = directory.file("matches/shards/");
  directory.write("matches/shards/1-of-2-0.shard", "somebody's notes");
  std::filesystem::create_directories(folder + "2-of-2-0.shard");
  ASSERT_EQ(::mkfifo((folder + "3-of-3-0.shard").c_str(), 0600), 0);  // nobody writes to it
  EXPECT_EQ(find_shard_records(directory.file("matches")).size(), 1u);
}

TEST_F(ShardsTest, SeveralMayEndAtOnce) {
  std::vector<std::thread> shards;
  for (std::size_t i = 0; i < 8; ++i)
    shards.emplace_back([&, i] {
      for (int round = 0; round < 10; ++round) keep_shard_record(directory.path(), {{i / 2, 4}, some_work()});
    });
  for (std::thread& shard : shards) shard.join();
  EXPECT_EQ(find_shard_records(directory.path()).size(), 4u);
}

TEST_F(ShardsTest, ARecordThatCannotBeKeptIsAnErrorUnlessTheWorkMayGoOn) {
  directory.write("matches/shards", "a file");
  EXPECT_GT(work({}, {0, 2}).made, 0u);
  EXPECT_EQ(warned.size(), 1u);
  Merger merger = filled();
  MatchCache cache(directory.file("matches"));
  MatchWorkOptions how;
  how.shard = {0, 2};
  how.goes_on_when_full = false;
  EXPECT_THROW(match_with_cache(merger, cache, how), FileError);
}

}  // namespace
}  // namespace gridmerge
