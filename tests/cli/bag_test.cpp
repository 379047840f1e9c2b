// SPDX-License-Identifier: Apache-2.0
// Bags wherever the program takes a map.
#include "bag/bag_builder.hpp"
#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class BagCommand : public CliTest {
 protected:
  BagCommand() {
    const OccupancyGrid left_map = map_part(draw_building(1), {0, 0, 13, 13}, T_left_building);
    const OccupancyGrid right_map = map_part(draw_building(1), {5, 0, 18, 13}, T_right_building);
    team = directory.write("team.mcap", mcap_file({record("/left/map", 1, make_grid(5, 5, 0.05)),
                                                   record("/left/map", 2, left_map),
                                                   record("/right/map", 3, right_map),
                                                   {"/chatter", 4, "hi", "std_msgs/msg/String", "cdr"}},
                                                  {.compression = "zstd"}));
    write_db3(directory.file("stranger.db3"), {record("/map", 1, draw_building(2))});
    stranger = directory.file("stranger.db3");
  }

  std::string team, stranger;
};

TEST_F(BagCommand, InfoShowsTheLastMapOfEachTopic) {
  const Outcome outcome = run({"info", team, stranger});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(team + "#/left/map\n  topic       /left/map, 2 maps, 0 updates\n"
                                    "  frame       robot\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find(team + "#/right/map\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(stranger + "#/map\n"), std::string::npos) << outcome.out;
  const Outcome one = run({"info", team + "#/right/map"});
  EXPECT_NE(one.out.find("/right/map, 1 maps"), std::string::npos) << one.out;
  EXPECT_EQ(one.out.find("/left/map"), std::string::npos) << one.out;
}

TEST_F(BagCommand, InfoShowsOtherTopicsThanTheOneThatHasNone) {
  const std::string path = directory.write(
      "empty.mcap",
      mcap_file({record("/a/map", 1, make_grid(0, 0, 0.05)), record("/b/map", 2, draw_building(2))}, {}));
  const Outcome outcome = run({"info", path});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out.find(path + "#/b/map\n"), 0u) << outcome.out;
  EXPECT_NE(outcome.err.find("warning: " + path + ": has no map with cells on /a/map"), std::string::npos)
      << outcome.err;
  const Json maps = Json::parse(run({"info", "--json", path}).out).at("maps");
  ASSERT_EQ(maps.size(), 1u);
  EXPECT_EQ(maps.at(0).at("source"), path + "#/b/map");
  expect_error(run({"info", path + "#/a/map"}), path, "has no map with cells on /a/map");
  const std::string none =
      directory.write("none.mcap", mcap_file({record("/a/map", 1, make_grid(0, 0, 0.05))}, {}));
  expect_error(run({"info", none}), none, "has no map with cells on /a/map");
}

TEST_F(BagCommand, InfoTellsProgramsTheSameAsOfMapFiles) {
  Json of_bag = Json::parse(run({"info", "--json", team}).out).at("maps").at(0);
  Json of_file = Json::parse(run({"info", "--json", left}).out).at("maps").at(0);
  EXPECT_EQ(of_bag.at("source"), team + "#/left/map");
  EXPECT_EQ(of_bag.at("bag"),
            Json::parse(R"({"topic": "/left/map", "frame_id": "robot", "maps": 2, "updates": 0})"));
  EXPECT_NEAR(of_bag.at("origin").at("theta"), of_file.at("origin").at("theta"), 1e-9);
  of_bag.erase("bag");
  for (const char* place : {"source", "origin"}) {
    of_bag.erase(place);
    of_file.erase(place);
  }
  EXPECT_EQ(of_bag, of_file);
}

TEST_F(BagCommand, MatchTakesTopics) {
  const Outcome outcome = run({"match", "--json", team + "#/left/map", team + "#/right/map"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json.at("verdict"), "accepted");
  EXPECT_EQ(json.at("moving"), team + "#/right/map");
  expect_near(json.at("transform"), T_left_right, 0.1, 0.01);
  EXPECT_EQ(run({"match", team + "#left/map", stranger}).exit_code, 3);
  EXPECT_EQ(run({"match", left, team + "#/right/map"}).exit_code, 0) << "a file and a bag";
}

TEST_F(BagCommand, MergeTakesTopicsAndItsReportReadsThemAgain) {
  const std::string merged = directory.file("merged");
  const std::string poses =
      directory.write("poses/poses.tsv", "map\tx\ty\ttheta\n../team.mcap#/left/map\t10\t20\t0\n");
  const Outcome outcome = run({"merge", team + "#/left/map", team + "#/right/map", stranger, "--init", poses,
                               "--fix", team + "#left/map", "-o", merged});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  const Json json = Json::parse(read_file(merged + "/transforms.json"));
  EXPECT_EQ(json.at("left_out"), Json::array({stranger}));
  const Json members = json.at("components").at(0).at("members");
  ASSERT_EQ(members.size(), 2u);
  EXPECT_EQ(members.at(0).at("source"), team + "#/left/map");
  expect_near(members.at(0).at("transform"), {10.0, 20.0, 0.0}, 1e-6, 1e-9);
  const std::string page = read_file(merged + "/report.html");
  const Outcome again = run({"report", merged});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_file(merged + "/report.html"), page);
  std::filesystem::remove(team);
  expect_error(run({"report", merged}), "team.mcap#/left/map", "is not there");
}

TEST_F(BagCommand, ATopicGivenTwiceCountsOnce) {
  const Outcome outcome = run(
      {"merge", team + "#/left/map", team + "#left/map", team + "#/right/map", "-o", directory.file("m")});
  EXPECT_NE(outcome.err.find("given twice, and counted once: " + team + "#left/map"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find(team + "#/right/map"), std::string::npos) << outcome.err;
}

TEST_F(BagCommand, EvaluateAndMeasureTakeTopics) {
  const std::string table =
      directory.write("negatives.tsv",
                      "fixed\tmoving\nteam.mcap#/left/map\tstranger.db3\nteam.mcap#/right/map\tother.yaml\n");
  const std::string result = directory.file("result.json");
  const Outcome outcome = run({"evaluate", "--negatives", table, "--json", result});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(read_file(result)).at("negatives").at("accepted"), 0);
  expect_error(run({"evaluate", "--negatives", table, "--json", team}), team, "is an input");
  const std::string pose = std::to_string(T_left_right.x) + "," + std::to_string(T_left_right.y) + "," +
                           std::to_string(T_left_right.theta);
  EXPECT_EQ(run({"measure", team + "#/left/map", team + "#/right/map", "--pose", pose}).exit_code, 0);
}

TEST_F(BagCommand, WhatCannotBeReadIsSaidInOneLine) {
  expect_error(run({"match", team, stranger}), team, "has 2 topics of maps: add #TOPIC");
  expect_error(run({"info", team + "#/nothing"}), team,
               "'/nothing'; its topics of maps are /left/map, /right/map");
  expect_error(run({"info", left + "#/map"}), left, "is no bag");
  const std::string bytes = read_file(team);
  std::string damaged = bytes;
  damaged[bytes.size() / 3] ^= 0x55;
  expect_error(run({"info", directory.write("damaged.mcap", damaged)}), "damaged.mcap", "do not unpack");
  expect_error(run({"info", directory.write("old.bag", "#ROSBAG V2.0\n")}), "old.bag", "gridmerge[rosbags]");
  const Outcome cut = run({"info", directory.write("cut.mcap", bytes.substr(0, bytes.size() - 30))});
  EXPECT_EQ(cut.exit_code, 0) << cut.err;
  EXPECT_NE(cut.out.find("warning     the file has no end"), std::string::npos) << cut.out;
}

}  // namespace
}  // namespace gridmerge::test
