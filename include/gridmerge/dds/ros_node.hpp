// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/online/team.hpp"

namespace gridmerge {

/// Where a RosNode publishes the transforms of robots.
enum class TransformTopic {
  tf_static,  ///< `/tf_static`: when they change, kept for whoever listens later
  tf,         ///< `/tf`: ten times per second, stamped with the system's time
  none,       ///< nowhere
};

/// A recorded map, at one moment.
struct PlayedMap {
  double seconds = 0.0;  ///< since any moment that is the same for all of a recording [s]
  std::string frame;     ///< the frame of the map
  OccupancyGrid grid;    ///< with the pose of its lower left corner in that frame
};

/// A topic of recorded maps, which a RosNode publishes again as a robot would.
struct PlayedTopic {
  std::string topic;   ///< where they are published: "/tb1/map"
  std::string source;  ///< for messages: where they come from
  /// The next map, by time; none after the last. What it throws ends RosNode::run(). While it runs there,
  /// throw_if_cancelled() throws once the node is stopped.
  std::function<std::optional<PlayedMap>()> next;
  /// Topics of the same recording keep their distance in time; one without a name is a recording of its own.
  std::string recording = {};
};

/// What a RosNode hears and publishes.
struct RosNodeOptions {
  /// Topics of robots' maps: `*` stands for any characters between two slashes, a level `**` for any levels.
  std::vector<std::string> patterns;
  std::map<std::string, std::string> robots;     ///< further topics of maps, by the names of their robots
  std::map<std::string, KnownPose> known_poses;  ///< what is known of robots' map frames, by their names
  std::string world_frame = "world";             ///< the frame of merged map 1; others get `_2`, ...
  std::string name = "gridmerge";                ///< of the node
  std::string enclave = "/";                     ///< of DDS Security, where ROS_SECURITY_ENABLE is true
  std::string output = "/merged_map";            ///< topic of merged map 1, likewise (TeamComponent::number)
  TransformTopic transforms = TransformTopic::tf_static;  ///< where the robots' transforms go
  TeamOptions team;                                       ///< how maps are merged
  /// Recorded maps that are published, and heard as any others. The first maps of all recordings come at
  /// once. More than ten minutes without a map, as where a clock jumped, are passed over, with a warning.
  /// Where several topics begin with the same frame, the frames of each are put into the topic's namespace:
  /// "map" becomes "tb1/map".
  std::vector<PlayedTopic> played;
  double play_rate = 1.0;  ///< seconds of the recording per second, above 0; the same for all topics
  bool once = false;       ///< end when all maps that are heard are merged as far as they can be
  std::optional<double>
      wait;  ///< so long a first map is waited for [s]; without it for ever, or 10 s with `once`
  std::function<void(const std::string&)> tell;    ///< called by run() with a line on what happened
  std::function<void(const std::string&)> warn;    ///< likewise, on what should not have
  std::function<void(const std::string&)> detail;  ///< likewise, with the figures of each answer
  std::function<void(const std::shared_ptr<const TeamAnswer>&)> answered;  ///< likewise, with each new answer
};

/// Throws std::invalid_argument for names, topics, patterns, frames and options that cannot be, for known
/// poses of robots that cannot be heard, and for played topics that are not heard or that two play.
GRIDMERGE_EXPORT void validate(const RosNodeOptions& options);

/// Whether a node with these options takes what is published on this topic for the map of a robot. Throws
/// std::invalid_argument as validate(), for patterns and robots.
GRIDMERGE_EXPORT bool is_heard(const RosNodeOptions& options, const std::string& topic);

/// A node of ROS 2 that hears the maps of robots on DDS, merges them as a Team does, and publishes the merged
/// maps, the transforms of the robots' map frames and diagnostics. Nodes of one domain agree on whose frame
/// is the world's. It needs no installation of ROS. One at a time in a process.
class GRIDMERGE_EXPORT RosNode {
 public:
  /// How run() came to an end.
  enum class End {
    stopped,  ///< by stop()
    merged,   ///< `once`: all maps are one
    refused,  ///< `once`: not all maps could be merged into one
  };

  /// Reads the variables by which ROS is set up (ROS_DOMAIN_ID and so on; for DDS Security
  /// ROS_SECURITY_ENABLE, ROS_SECURITY_KEYSTORE, ROS_SECURITY_ENCLAVE_OVERRIDE). Throws std::invalid_argument
  /// for names, topics, patterns, frames and options that cannot be, and for known poses of robots that
  /// cannot be heard; std::runtime_error for a variable that ROS would not take, a file of the enclave that
  /// is missing, and when the network does not let the node in.
  explicit RosNode(RosNodeOptions options);
  ~RosNode();
  RosNode(const RosNode&) = delete;
  RosNode& operator=(const RosNode&) = delete;

  /// Hears and publishes until it ends. Throws std::runtime_error when no map came in within `wait`, saying
  /// which topics are there that come near; with `once` when maps cannot be merged, saying why; and when the
  /// network changes and does not let the node in again.
  End run();

  /// Ends run() soon, from any thread, also before it begins.
  void stop();

  /// A line for each robot: its state, where it lies, or why it does not. Not during run().
  std::string describe() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace gridmerge
