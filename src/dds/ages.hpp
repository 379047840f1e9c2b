// SPDX-License-Identifier: Apache-2.0
// Nodes of one team tell each other since when they have heard each robot, so that they agree on whose frame
// is the world's. They do so in /diagnostics, where people see it too.
#pragma once

#include <dds/dds.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dds/entity.hpp"
#include "dds/participant.hpp"
#include "gridmerge/online/team.hpp"

namespace gridmerge::internal {

/// Keys of a robot's diagnosis that other nodes read.
inline constexpr const char* kTopicKey = "topic";
inline constexpr const char* kFrameKey = "frame";
inline constexpr const char* kPublisherKey = "publisher";
inline constexpr const char* kHeardFirstKey = "heard first";

/// Since when a node has heard a robot's map frame. A publisher's number and a frame's name tell whether it
/// is the frame that is meant: a robot that starts anew has others.
struct RobotAge {
  std::string topic;
  std::string publisher;
  std::string frame;
  TeamTime heard_first;
};

/// Seconds since 1970 with nine digits behind the point, exact: "1764224401.250000000".
std::string format_time(TeamTime time);
/// The same back; none for what format_time() does not write.
std::optional<TeamTime> read_time(std::string_view text);

/// Hears what nodes say in /diagnostics, this one too.
class AgeListener {
 public:
  explicit AgeListener(const Participant& participant);

  /// What was said since the last call.
  std::vector<RobotAge> take();

  dds_entity_t reader() const { return reader_.get(); }

 private:
  DdsEntity reader_;
};

}  // namespace gridmerge::internal
