// SPDX-License-Identifier: Apache-2.0
#include "cache/comparison_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/io/file_error.hpp"
#include "merge/team.hpp"

namespace gridmerge {

using namespace internal;

namespace {

const std::vector<float> kSome{0.0f, -1.5f, 3.25e-7f, std::numeric_limits<float>::max()};

TEST(ComparisonFile, GivesWhatItWasGiven) {
  EXPECT_EQ(parse_comparisons(format_comparisons(kSome, "name"), "name"), kSome);
  EXPECT_TRUE(parse_comparisons(format_comparisons({}, "name"), "name").empty());
}

TEST(ComparisonFile, WhatIsDamagedOrAnothersIsRefused) {
  const std::string good = format_comparisons(kSome, "name");
  EXPECT_THROW(parse_comparisons(good, "nam"), std::invalid_argument);
  EXPECT_THROW(parse_comparisons(good, "name2"), std::invalid_argument);
  for (std::size_t i = 0; i < good.size(); ++i) {
    EXPECT_THROW(parse_comparisons(good.substr(0, i), "name"), std::invalid_argument) << i;
    std::string changed = good;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_THROW(parse_comparisons(changed, "name"), std::invalid_argument) << i;
  }
}

/// A shard of many maps that has hardly a match to make.
class ComparisonsTest : public testing::Test {
 protected:
  ComparisonsTest() {
    const OccupancyGrid building = downsample(test::draw_building(1), 4);
    for (int i = 0; i < 51; ++i)
      maps.push_back(test::map_part(building, {0.1 * i, 0, 9.0 + 0.1 * i, 13}, {1.0 * i, 0.0, 0.3 * i}));
  }

  MatchWork work(std::size_t shard) {
    MergeOptions options;
    options.max_missed = 0.9;
    options.match.search = SearchMethod::quick;
    Merger merger(maps, options);
    MatchCache cache(directory.file("matches"), [this](const std::string& line) { warned.push_back(line); });
    MatchWorkOptions how;
    how.shard = {shard, 100000};
    return match_with_cache(merger, cache, how);
  }

  std::map<std::string, std::filesystem::file_time_type> parts() const {
    std::map<std::string, std::filesystem::file_time_type> parts;
    for (const auto& entry : std::filesystem::directory_iterator(directory.file("matches/compared")))
      parts[entry.path().filename()] = entry.last_write_time();
    return parts;
  }

  const test::TemporaryDirectory directory;
  std::vector<OccupancyGrid> maps;
  std::vector<std::string> warned;
};

TEST_F(ComparisonsTest, AreMadeOnceForAllShards) {
  const std::size_t missing = work(50000).missing;
  const auto made = parts();
  EXPECT_GT(made.size(), 8u);
  EXPECT_EQ(work(70000).missing, missing);
  EXPECT_EQ(parts(), made);
  const std::string damaged = made.begin()->first;
  directory.write("matches/compared/" + damaged, "somebody's notes");
  EXPECT_EQ(work(70000).missing, missing);
  EXPECT_EQ(parts().size(), made.size());
  const std::string again = test::read_file(directory.file("matches/compared/" + damaged));
  EXPECT_FALSE(parse_comparisons(again, damaged).empty());
  EXPECT_TRUE(warned.empty());
}

TEST_F(ComparisonsTest, WhatCannotBeKeptIsMadeAllTheSame) {
  const std::size_t missing = work(50000).missing;
  std::filesystem::remove_all(directory.file("matches"));
  directory.write("matches/compared", "a file");
  EXPECT_EQ(work(50000).missing, missing);
  EXPECT_EQ(warned.size(), 1u);
  MatchCache cache(directory.file("matches"));
  EXPECT_THROW(comparisons_in(cache, {}, false).keep("part", kSome), FileError);
}

}  // namespace
}  // namespace gridmerge
