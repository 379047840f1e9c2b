// SPDX-License-Identifier: Apache-2.0
#include "evaluate/dataset.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/io/map_file.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

SimulateOptions quick(int robots) {
  SimulateOptions options;
  options.kind = BuildingKind::hall;
  options.width = 20.0;
  options.height = 12.0;
  options.robots = robots;
  options.scan_every = 1.0;
  options.longest_way = 20.0;
  options.sensor.angular_step = 0.03;
  return options;
}

TEST(TruthText, ReadsBackToTheSameValues) {
  const test::TemporaryDirectory directory;
  const std::vector<TruePair> pairs{
      {{"a.yaml", {}}, {"b c.yaml", {}}, {0.1, -2.0 / 3.0, 3.0}, 0.7, "B", 0.123, 7.65}};
  const std::vector<TruePair> read = read_pairs(directory.write("pairs.tsv", format_pairs(pairs)));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].moving.name, "b c.yaml");
  EXPECT_EQ(read[0].T_fixed_moving, pairs[0].T_fixed_moving);
  EXPECT_EQ(read[0].tolerance, 0.7);
  EXPECT_EQ(read[0].tier, "B");
  EXPECT_EQ(read[0].overlap, 0.123);
  EXPECT_EQ(read[0].shared_wall, 7.65);

  std::vector<TruePair> untiered = pairs;
  untiered[0].tier.clear();
  EXPECT_EQ(read_pairs(directory.write("untiered.tsv", format_pairs(untiered))).at(0).tier, "");
  EXPECT_THROW(format_pairs({pairs[0], untiered[0]}), std::invalid_argument);

  const auto negatives =
      read_negatives(directory.write("negatives.tsv", format_negatives({{{"a.yaml", {}}, {"x.yaml", {}}}})));
  ASSERT_EQ(negatives.size(), 1U);
  EXPECT_EQ(negatives[0].moving.name, "x.yaml");

  const std::vector<TrueSet> sets{{"s", {{{"a.yaml", {}}, {}, 0.5}, {{"b.yaml", {}}, {1.0, 2.0, 0.3}, 0.6}}}};
  const auto read_back = read_sets(directory.write("sets.tsv", format_sets(sets)));
  ASSERT_EQ(read_back.size(), 1U);
  EXPECT_EQ(read_back[0].members[1].T_set_map, sets[0].members[1].T_set_map);
  EXPECT_EQ(read_back[0].members[1].tolerance, 0.6);

  EXPECT_THROW(format_negatives({{{"a\tb", {}}, {"x", {}}}}), std::invalid_argument);
  EXPECT_THROW(format_negatives({{{"", {}}, {"x", {}}}}), std::invalid_argument);
}

TEST(Dataset, HoldsMapsAndTruthThatBelongTogether) {
  const test::TemporaryDirectory directory;
  const Simulation simulation = simulate(quick(3));
  SimulateOptions other = quick(1);
  other.seed = 77;
  const std::filesystem::path folder = directory.path() / "made" / "here";
  const Simulation elsewhere = simulate(other);
  write_dataset(folder, simulation, {elsewhere});

  for (std::size_t i = 0; i < 3; ++i) {
    const OccupancyGrid map = load_map(folder / ("robot_" + std::to_string(i + 1) + ".yaml")).grid;
    EXPECT_EQ(map.cells, simulation.maps[i].grid.cells);
    EXPECT_EQ(map.origin, simulation.maps[i].grid.origin);
  }
  EXPECT_EQ(load_map(folder / "elsewhere_1.yaml").grid.cells, elsewhere.maps[0].grid.cells);
  const OccupancyGrid building = load_map(folder / "building.yaml").grid;
  EXPECT_GT(count_cells(building).free, 1000U);
  EXPECT_EQ(building.resolution, 0.05);
  const std::vector<TruePair> pairs = read_pairs(folder / "pairs.tsv");
  ASSERT_EQ(pairs.size(), simulation.pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].T_fixed_moving, simulation.pairs[i].T_fixed_moving);
    EXPECT_EQ(pairs[i].fixed.name, "robot_" + std::to_string(simulation.pairs[i].fixed + 1) + ".yaml");
    EXPECT_TRUE(std::filesystem::exists(pairs[i].moving.path));
  }
  const std::vector<TruePair> on_building = read_pairs(folder / "building.tsv");
  ASSERT_EQ(on_building.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(on_building[i].fixed.name, "building.yaml");
    EXPECT_EQ(on_building[i].moving.name, "robot_" + std::to_string(i + 1) + ".yaml");
    EXPECT_EQ(on_building[i].T_fixed_moving, simulation.maps[i].T_building_map);
  }
  EXPECT_EQ(read_negatives(folder / "negatives.tsv").size(), 3U + simulation.strangers.size());
  const std::vector<TrueSet> sets = read_sets(folder / "sets.tsv");
  ASSERT_EQ(sets.size(), 1U);
  EXPECT_EQ(sets[0].members.size(), 3U);
  EXPECT_EQ(sets[0].members[0].T_set_map, SE2{});
  for (std::size_t i = 0; i < 3; ++i) {
    const SimulatedMap &first = simulation.maps[0], &map = simulation.maps[i];
    const TrueMember& member = sets[0].members[i];
    EXPECT_EQ(member.map.name, "robot_" + std::to_string(i + 1) + ".yaml");
    EXPECT_EQ(member.tolerance, std::max(kMinTolerance, 0.3 + 2.0 * (first.bend + map.bend)));
    const SE2 T = inverse(first.T_building_map) * map.T_building_map;
    EXPECT_NEAR(member.T_set_map.x, T.x, 1e-12);
    EXPECT_NEAR(member.T_set_map.y, T.y, 1e-12);
  }
  const std::vector<NegativePair> strangers = read_negatives(folder / "negatives.tsv");
  EXPECT_EQ(strangers.back().fixed.name, "robot_3.yaml");
  EXPECT_EQ(strangers.back().moving.name, "elsewhere_1.yaml");
}

TEST(Dataset, TolerancesGrowWithHowMuchMapsBend) {
  const test::TemporaryDirectory directory;
  Simulation simulation = simulate(quick(3));
  simulation.maps[0].bend = 0.25;
  simulation.maps[1].bend = 0.5;
  simulation.maps[2].bend = 0.02;
  write_dataset(directory.path(), simulation, {});
  // On the building by twice the map's own bend and 0.3 m, half a metre at least.
  const std::vector<TruePair> on_building = read_pairs(directory.path() / "building.tsv");
  EXPECT_NEAR(on_building.at(0).tolerance, 0.8, 1e-9);
  EXPECT_NEAR(on_building.at(1).tolerance, 1.3, 1e-9);
  EXPECT_NEAR(on_building.at(2).tolerance, 0.5, 1e-9);
  // In a set the first map's bend comes on top.
  const std::vector<TrueSet> sets = read_sets(directory.path() / "sets.tsv");
  EXPECT_NEAR(sets.at(0).members.at(0).tolerance, 1.3, 1e-9);
  EXPECT_NEAR(sets.at(0).members.at(1).tolerance, 1.8, 1e-9);
  EXPECT_NEAR(sets.at(0).members.at(2).tolerance, 0.84, 1e-9);
}

TEST(Dataset, HoldsEachMapAtEarlierMoments) {
  const test::TemporaryDirectory directory;
  SimulateOptions options = quick(2);
  options.steps = 3;
  const Simulation simulation = simulate(options);
  write_dataset(directory.path(), simulation, {});
  for (std::size_t robot = 0; robot < 2; ++robot) {
    for (std::size_t step = 0; step < 2; ++step) {
      const std::string name =
          "robot_" + std::to_string(robot + 1) + "_step_" + std::to_string(step + 1) + ".yaml";
      EXPECT_EQ(load_map(directory.path() / name).grid.cells, simulation.maps[robot].earlier[step].cells);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "robot_1_step_3.yaml"));
}

TEST(Dataset, KeepsProbabilitiesToAPercent) {
  const test::TemporaryDirectory directory;
  const Simulation simulation = simulate(quick(1));
  write_dataset(directory.path(), simulation, {}, {.probabilities = true});
  const OccupancyGrid map = load_map(directory.path() / "robot_1.yaml").grid;
  const OccupancyGrid& made = simulation.maps[0].grid;
  ASSERT_EQ(map.probability.size(), made.probability.size());
  for (std::size_t i = 0; i < made.probability.size(); ++i) {
    ASSERT_EQ(std::isnan(map.probability[i]), std::isnan(made.probability[i]));
    if (!std::isnan(made.probability[i])) {
      EXPECT_NEAR(map.probability[i], made.probability[i], 0.0051);
    }
  }
  EXPECT_EQ(map.cells, made.cells);
  EXPECT_TRUE(read_sets(directory.path() / "sets.tsv").empty());
}

TEST(Dataset, RemovesTheFilesOfAnEarlierOneAndNothingElse) {
  const test::TemporaryDirectory directory;
  SimulateOptions options = quick(3);
  options.steps = 2;
  const Simulation elsewhere = simulate(quick(1));
  EXPECT_TRUE(write_dataset(directory.path(), simulate(options), {elsewhere, elsewhere}).empty());
  const std::vector<std::string> of_user{"robot_7.yaml", "robot_3_notes.yaml", "robot_3.png", "notes"};
  for (const std::string& name : of_user) directory.write(name, "mine");
  const std::vector<std::string> before = directory.names();
  const Simulation other = simulate(quick(2));
  EXPECT_NO_THROW(prepare_dataset(directory.path(), {2, 1, 1}));
  EXPECT_EQ(directory.names(), before);
  const auto removed = write_dataset(directory.path(), other, {elsewhere});

  const test::TemporaryDirectory fresh;
  write_dataset(fresh.path(), other, {elsewhere});
  std::vector<std::string> expected = fresh.names();
  expected.insert(expected.end(), of_user.begin(), of_user.end());
  std::ranges::sort(expected);
  EXPECT_EQ(directory.names(), expected);
  for (const std::string& name : fresh.names())
    EXPECT_EQ(test::read_file(directory.path() / name), test::read_file(fresh.path() / name)) << name;

  std::vector<std::string> gone;
  std::ranges::set_difference(before, directory.names(), std::back_inserter(gone));
  std::vector<std::string> told;
  for (const std::filesystem::path& file : removed) {
    EXPECT_EQ(file.parent_path(), directory.path());
    told.push_back(file.filename().string());
  }
  EXPECT_EQ(told, gone);
  EXPECT_EQ(gone.size(), 2U + 2U * 3U + 2U);  // a robot, three earlier moments, a map of another building
}

/// Neither before the work nor after it a dataset takes the place of `name`, nor of anything else.
void expect_refused(const test::TemporaryDirectory& directory, int robots, const std::string& name) {
  std::map<std::string, std::string> before;
  for (const std::string& each : directory.names()) before[each] = test::read_file(directory.path() / each);
  const auto expect_error = [&](const auto& work) {
    try {
      work();
      ADD_FAILURE() << name << " was not told";
    } catch (const FileError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(": " + name + ": choose another directory"), std::string::npos) << text;
    }
  };
  expect_error([&] { prepare_dataset(directory.path(), {static_cast<std::size_t>(robots), 1, 0}); });
  expect_error([&] { write_dataset(directory.path(), simulate(quick(robots)), {}); });
  EXPECT_EQ(directory.names().size(), before.size());
  for (const auto& [each, text] : before) EXPECT_EQ(test::read_file(directory.path() / each), text) << each;
}

TEST(Dataset, TakesThePlaceOfNoFileThatNoSimulationWrote) {
  for (const char* const name : {"robot_1.yaml", "robot_2.pgm", "building.yaml", "pairs.tsv", "building.tsv",
                                 "negatives.tsv", "sets.tsv", "simulation.sha256"}) {
    const test::TemporaryDirectory directory;
    // A truth of one's own names maps of usual names.
    directory.write(name,
                    format_pairs({{{"robot_1.yaml", {}}, {"robot_3.yaml", {}}, {}, 0.5, "", 0.5, 1.0}}));
    directory.write("robot_3.yaml", "mine");
    expect_refused(directory, 2, name);
  }
}

TEST(Dataset, TakesThePlaceOfNoFileThatHasChanged) {
  const test::TemporaryDirectory directory;
  write_dataset(directory.path(), simulate(quick(2)), {});
  const std::string pairs = test::read_file(directory.path() / "pairs.tsv");
  directory.write("pairs.tsv", pairs + "robot_1.yaml\tmine.yaml\t0\t0\t0\t0.5\tA\t1\t9\n");
  expect_refused(directory, 2, "pairs.tsv");
  directory.write("pairs.tsv", pairs);
  directory.write("robot_2.yaml", "image: mine.pgm");  // one robot has no map of this name
  expect_refused(directory, 1, "robot_2.yaml");
  std::filesystem::remove(directory.path() / "robot_2.yaml");
  EXPECT_EQ(write_dataset(directory.path(), simulate(quick(1)), {}).size(), 1U);  // its image
}

TEST(Dataset, WithoutItsListIsLikeOtherFiles) {
  const test::TemporaryDirectory directory;
  write_dataset(directory.path(), simulate(quick(1)), {});
  std::filesystem::remove(directory.path() / "simulation.sha256");
  expect_refused(directory, 1,
                 "building.pgm, building.tsv, building.yaml, negatives.tsv, pairs.tsv, robot_1.pgm, "
                 "robot_1.yaml, sets.tsv");
  // Not all of many are named.
  const test::TemporaryDirectory many;
  for (int i = 1; i <= 6; ++i) {
    for (const char* const ending : {".pgm", ".yaml"}) many.write("robot_" + std::to_string(i) + ending, "");
  }
  expect_refused(many, 6,
                 "robot_1.pgm, robot_1.yaml, robot_2.pgm, robot_2.yaml, robot_3.pgm, robot_3.yaml, "
                 "robot_4.pgm, robot_4.yaml, robot_5.pgm, robot_5.yaml and 2 more");
}

TEST(Dataset, WhatAKilledSimulationHasLeftIsPutInOrder) {
  const test::TemporaryDirectory directory;
  write_dataset(directory.path(), simulate(quick(1)), {});
  // Killed when links stood in the place of its files, those of the first map of a second robot among them.
  const std::filesystem::path work = directory.path() / ".gridmerge.tmp";
  std::filesystem::create_directories(work / "old");
  std::filesystem::create_directories(work / "new");
  std::filesystem::create_symlink("old", work / "current");
  for (const char* const name : {"robot_2.pgm", "robot_2.yaml"})
    std::filesystem::create_symlink(std::filesystem::path(".gridmerge.tmp/current") / name,
                                    directory.path() / name);
  EXPECT_NO_THROW(prepare_dataset(directory.path(), {2, 1, 0}));
  EXPECT_FALSE(std::filesystem::exists(work));
  EXPECT_TRUE(write_dataset(directory.path(), simulate(quick(2)), {}).empty());
}

TEST(Dataset, AListNamesFilesOfItsFolderOnly) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path folder = directory.path() / "made";
  write_dataset(folder, simulate(quick(1)), {});
  const std::string list = test::read_file(folder / "simulation.sha256");
  const std::string digest = list.substr(list.find('\n') + 1, 64);  // that of building.pgm
  std::filesystem::copy(folder / "building.pgm", directory.path() / "mine");
  std::string more = list;
  for (const char* const name : {"../mine", "", ".", ".."}) more += digest + "  " + name + "\n";
  directory.write("made/simulation.sha256", more);
  EXPECT_TRUE(write_dataset(folder, simulate(quick(1)), {}).empty());
  EXPECT_TRUE(std::filesystem::exists(directory.path() / "mine"));
}

TEST(Dataset, AFolderThatCannotBeMadeIsAnError) {
  const test::TemporaryDirectory directory;
  const std::string file = directory.write("file", "");
  const std::filesystem::path folder = std::filesystem::path(file) / "folder";
  EXPECT_THROW(write_dataset(folder, simulate(quick(1)), {}), FileError);
  EXPECT_THROW(prepare_dataset(folder, {}), FileError);
  EXPECT_NO_THROW(prepare_dataset(directory.path() / "new" / "folder", {}));
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "new"));
}

}  // namespace
}  // namespace gridmerge
