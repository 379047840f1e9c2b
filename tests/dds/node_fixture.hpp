// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "online/explorers.hpp"
#include "peer.hpp"
#include "running_node.hpp"

namespace gridmerge::test {

/// A node, and a peer in its domain.
class NodeTest : public testing::Test {
 protected:
  NodeTest() {
    options.patterns = {"/*/map"};
    options.team.quiet = std::chrono::milliseconds(500);
  }

  /// Starts the node, and a peer in its domain.
  void start() {
    node = std::make_unique<RunningNode>(options);
    peer = std::make_unique<Peer>(domain);
  }

  RawMap map_of(int robot, const std::string& frame) const {
    return raw_map(frame, explorers.map(robot, Explorers::kSteps));
  }

  RawDiagnosis diagnosis(const std::string& robot) { return peer->diagnoses().at("gridmerge: " + robot); }

  bool diagnosed(const std::string& robot, const std::string& key, const std::string& value) {
    return comes_true([&] {
      const auto& all = peer->diagnoses();
      const auto found = all.find("gridmerge: " + robot);
      if (found == all.end()) return false;
      const auto entry = found->second.values.find(key);
      return entry != found->second.values.end() && entry->second == value;
    });
  }

  /// Publishes the first two robots' maps, and waits until they are merged.
  void merge_two() {
    a.emplace(peer->maps("/a/map"));
    a->publish(map_of(0, "a/map"));
    ASSERT_TRUE(diagnosed("a", "state", "waiting")) << node->lines();
    b.emplace(peer->maps("/b/map"));
    b->publish(map_of(1, "b/map"));
    ASSERT_TRUE(diagnosed("a", "state", "placed")) << node->lines();
    ASSERT_TRUE(diagnosed("b", "state", "placed")) << node->lines();
  }

  const std::uint32_t domain = own_domain();
  const Explorers explorers;
  RosNodeOptions options;
  std::unique_ptr<RunningNode> node;
  std::unique_ptr<Peer> peer;  // goes before the node, whose domain it is in
  std::optional<MapTopic> a;
  std::optional<MapTopic> b;
};

}  // namespace gridmerge::test
