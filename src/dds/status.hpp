// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dds/listener.hpp"
#include "dds/restarts.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/online/team.hpp"

namespace gridmerge::internal {

/// A transform that TF gets.
struct NamedTransform {
  std::string parent;
  std::string child;
  SE2 T_parent_child;

  friend bool operator==(const NamedTransform&, const NamedTransform&) = default;
};

/// Transforms of placed robots, and why others have none.
struct TeamTransforms {
  std::vector<NamedTransform> transforms;       // by child
  std::map<std::string, std::string> withheld;  // by robot
};

/// The frame of the component of this number: `world`, and `world_2` and so on for further ones, whose pose
/// in the first is unknown.
std::string component_frame(const std::string& world, std::size_t number);

/// From each component's frame to its robots' map frames. A frame that two robots share, or that is a
/// component's own, is withheld: TF knows one pose for each frame, and it would be a wrong one.
TeamTransforms team_transforms(const TeamAnswer& answer, const std::vector<HeardRobot>& robots,
                               const std::string& world);

/// A `diagnostic_msgs/DiagnosticStatus`.
struct Diagnosis {
  enum Level : std::uint8_t { ok = 0, warning = 1 };

  Level level = ok;
  std::string name;
  std::string message;
  std::string hardware;
  std::vector<std::pair<std::string, std::string>> values;
};

/// What the node says of itself.
struct NodeHealth {
  std::string name;               // of the node
  std::uint64_t undecodable = 0;  // messages that were none
  std::size_t over_limit = 0;     // publishers that are not heard
  std::uint64_t dds_warnings = 0;
  std::map<std::string, Restarts> restarts = {};  // of robots that did so
};

/// Asks whether two robots have one topic.
std::string say_many_restarts(const std::string& topic);

/// One of the node, then one of each robot by name.
std::vector<Diagnosis> diagnose(const TeamAnswer& answer, const std::vector<HeardRobot>& robots,
                                const TeamTransforms& transforms, const NodeHealth& health);

/// Why no map was heard: which topics come near, each with why it is none.
std::string explain_silence(const std::vector<HeardRobot>& robots,
                            const std::vector<std::string>& near_misses);

/// The same robots in lines for people: "tb1: placed at ..." and so on.
std::string describe_team(const TeamAnswer& answer, const std::vector<HeardRobot>& robots);

}  // namespace gridmerge::internal
