// SPDX-License-Identifier: Apache-2.0
// The page of `gridmerge node --page`, as a browser asks for it, beside a peer of this process.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "../cli/http_client.hpp"
#include "../cli/program.hpp"
#include "dds/environment.hpp"
#include "dds/participant.hpp"
#include "online/explorers.hpp"
#include "peer.hpp"
#include "running_node.hpp"

namespace gridmerge::test {
namespace {

using Json = nlohmann::json;

class NodePage : public testing::Test {
 protected:
  /// Starts the node, and reads where it serves.
  NodePage() {
    const std::string line = program.read_line(), start = "page: http://127.0.0.1:";
    EXPECT_EQ(line.find(start), 0u) << line;
    port = std::stoi(line.substr(start.size()));
  }

  std::string get(const std::string& path) const {
    const std::optional<HttpAnswer> answer = HttpClient(port).get(path);
    EXPECT_TRUE(answer && answer->status == 200) << path;
    return answer ? answer->body : "";
  }

  int newest() const { return Json::parse(get("/news")).at("answer").get<int>(); }

  /// What the page was given; null while it waits for maps.
  Json data() const {
    const std::string page = get("/"), start = R"(id="report-data">)";
    const std::size_t at = page.find(start);
    if (at == std::string::npos) return nullptr;
    const std::size_t from = at + start.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  void publish(const MapTopic& topic, const std::string& frame, int robot, int step) const {
    topic.publish(raw_map(frame, explorers.map(robot, step)));
  }

  const std::uint32_t domain = own_domain();
  const Explorers explorers{};
  // Sets the domain up as the program does; both are alike in this process's environment.
  const internal::Participant network{internal::read_ros_environment(internal::process_environment), 1 << 20};
  RunningProgram program{{"node", "--page", "0"}};
  Peer peer{domain};
  int port = 0;
};

TEST_F(NodePage, FollowsAlong) {
  EXPECT_EQ(newest(), 0);
  const std::string waiting = get("/");
  EXPECT_NE(waiting.find("No map was heard yet"), std::string::npos) << waiting;
  EXPECT_NE(waiting.find(R"(http-equiv="refresh")"), std::string::npos);

  const MapTopic b = peer.maps("/b/map");
  publish(b, "b/map", 1, Explorers::kSteps);
  ASSERT_TRUE(comes_true([&] { return !data().is_null(); }));
  Json page = data();
  EXPECT_EQ(page.at("live"), true);
  ASSERT_EQ(page.at("maps").size(), 1u);
  EXPECT_EQ(page.at("maps").at(0).at("name"), "b");
  ASSERT_EQ(page.at("left_out").size(), 1u);

  const MapTopic a = peer.maps("/a/map"), stranger = peer.maps("/c/map");
  publish(a, "a/map", 0, Explorers::kSteps);
  publish(stranger, "c/map", 3, Explorers::kSteps);
  ASSERT_TRUE(comes_true([&] {
    page = data();
    return page.at("maps").size() == 3 && page.at("components").size() == 1;
  }));
  // Maps stay in the order in which they came, so that links to the page's layers hold.
  EXPECT_EQ(page.at("maps").at(0).at("name"), "b");
  const Json& component = page.at("components").at(0);
  EXPECT_EQ(component.at("frame"), 0);
  ASSERT_EQ(component.at("members").size(), 2u);
  EXPECT_EQ(component.at("members").at(0).at("map"), 0);
  EXPECT_GT(component.at("width").get<int>(), 100);
  EXPECT_GT(component.at("agreeing").get<int>(), 1000);
  ASSERT_EQ(page.at("left_out").size(), 1u);
  const std::size_t other = page.at("left_out").at(0).at("map");
  EXPECT_EQ(page.at("maps").at(other).at("name"), "c");
  EXPECT_FALSE(page.at("joins").empty());
  ASSERT_TRUE(comes_true([&] { return data().at("answer") == newest(); }));
}

TEST_F(NodePage, RefinesWhatIsPlacedByHand) {
  const MapTopic a = peer.maps("/a/map"), b = peer.maps("/b/map");
  publish(a, "a/map", 0, Explorers::kSteps);
  publish(b, "b/map", 1, Explorers::kSteps);
  Json page;
  ASSERT_TRUE(comes_true([&] {
    page = data();
    return !page.is_null() && page.at("components").size() == 1;
  }));
  const Json& members = page.at("components").at(0).at("members");
  Json displaced = members.at(1).at("transform");
  displaced["x"] = displaced.at("x").get<double>() + 0.3;
  Json question{
      {"merge", page.at("merge")},
      {"moving", members.at(1).at("map")},
      {"transform", displaced},
      {"fixed", {{{"map", members.at(0).at("map")}, {"transform", members.at(0).at("transform")}}}}};
  const auto answer = HttpClient(port).post("/refine", question.dump(), "application/json");
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  const Json refined = Json::parse(answer->body).at("transform");
  EXPECT_NEAR(refined.at("x").get<double>(), members.at(1).at("transform").at("x").get<double>(), 0.1);

  // A reader who is at work asks on about the maps of that page, while others load newer ones.
  const MapTopic stranger = peer.maps("/c/map");
  publish(stranger, "c/map", 3, Explorers::kSteps);
  ASSERT_TRUE(comes_true([&] { return data().at("maps").size() == 3; }));
  const auto later = HttpClient(port).post("/refine", question.dump(), "application/json");
  ASSERT_TRUE(later);
  EXPECT_EQ(later->status, 200) << later->body;
  question["merge"] = "0123456789abcdef";
  const auto other = HttpClient(port).post("/refine", question.dump(), "application/json");
  ASSERT_TRUE(other);
  EXPECT_EQ(other->status, 409) << other->body;
}

TEST_F(NodePage, IsForItsOwnPageAlone) {
  const HttpClient client(port);
  for (const char* path : {"/", "/news"}) {
    EXPECT_EQ(client.get(path, {{"Host", "elsewhere.example:80"}})->status, 403) << path;
    EXPECT_EQ(client.get(path, {{"Origin", "http://elsewhere.example"}})->status, 403) << path;
    EXPECT_EQ(client.post(path, "{}", "application/json")->status, 404) << path;
  }
  EXPECT_EQ(client.get("/merged.yaml")->status, 404);
  EXPECT_EQ(client.post("/refine", "{}", "application/json")->status, 400);
}

TEST_F(NodePage, EndsWithTheNode) {
  const Connection idle(port);  // asks nothing, and is no reason to stay
  const Outcome outcome = program.end_with(SIGTERM);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.signal;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THROW(HttpClient(port).get("/news"), std::runtime_error);
}

TEST(NodePageOptions, WhatCannotBeServedIsAnError) {
  own_domain();
  const Outcome any = run({"node", "--page", "0", "--page-address", "0.0.0.0"});
  EXPECT_EQ(any.exit_code, 2);
  EXPECT_NE(any.err.find("--page-address: '0.0.0.0' is no single address"), std::string::npos) << any.err;
  EXPECT_EQ(run({"node", "--page", "65536"}).exit_code, 2);
  EXPECT_EQ(run({"node", "--page-address", "127.0.0.1"}).exit_code, 2);
  RunningProgram first({"node", "--page", "0"});
  const std::string line = first.read_line();
  const std::string port = line.substr(line.rfind(':') + 1, line.rfind('/') - line.rfind(':') - 1);
  const Outcome taken = run({"node", "--page", port});
  EXPECT_EQ(taken.exit_code, 1);
  EXPECT_NE(taken.err.find("cannot serve at 127.0.0.1:" + port), std::string::npos) << taken.err;
  EXPECT_NE(taken.err.find("choose another port"), std::string::npos) << taken.err;
}

}  // namespace
}  // namespace gridmerge::test
