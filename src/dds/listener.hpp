// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dds/ages.hpp"
#include "dds/discovery.hpp"
#include "dds/entity.hpp"
#include "dds/message.hpp"
#include "dds/participant.hpp"
#include "dds/reserve.hpp"
#include "dds/selection.hpp"

namespace gridmerge::internal {

/// So many robots are heard; who comes later is reported, and heard when another goes that never sent a map.
inline constexpr std::size_t kMaxRobots = 256;
/// The newest maps of all robots may have so many cells together.
inline constexpr std::size_t kMaxCellsTogether = std::size_t{1} << 30;

/// What was heard of a robot.
struct HeardRobot {
  std::string name;
  std::string topic;
  std::string frame;           // of its newest map; empty before the first
  std::size_t cells = 0;       // of its newest map
  std::uint64_t maps = 0;      // that were taken
  std::uint64_t parts = 0;     // likewise, of updates
  std::uint64_t refused = 0;   // maps and updates that were not
  std::string last_refusal;    // why
  std::uint64_t outdated = 0;  // updates that their publisher wrote before its map
  std::size_t publishers = 0;  // of the map that are there now
  std::uint64_t unheard = 0;   // messages of publishers beside the one that is heard
  bool awaited = false;        // after join(): the publisher may be there, and not be discovered yet
  std::string publisher;       // RemoteWriter::guid of the one that is heard; empty before the first map
  TeamTime heard_first;        // since when this frame is heard, by the oldest account
};

/// Hears the maps of robots and their updates. One publisher of a topic is heard: the first that sent a map.
/// When it goes, the one that sent a map last takes its place, with that map; it is the map of a robot that
/// was started anew. A publisher that comes back after an outage goes on with its map. After join() it is
/// waited for, so that no other takes its place that is discovered earlier.
class MapListener {
 public:
  struct Callbacks {
    /// A map that may be used. `restarted`: it has nothing to do with what this robot sent before. May throw
    /// RefusedMessage.
    std::function<void(const std::string& robot, HeardMap map, bool restarted)> map;
    /// A part of the newest map; returns whether it fits in there.
    std::function<bool(const std::string& robot, const HeardPart& part)> part;
    /// For people, when something is seen for the first time: of a topic or of a message. `kind` is the same
    /// where the topic comes anew.
    std::function<void(const std::string& kind, const std::string& text)> warn;
  };

  /// What wakes `waitset` is then dealt with by hear().
  MapListener(const Participant& participant, dds_entity_t waitset, RobotSelection selection,
              Callbacks callbacks);

  /// Lets go of the participant, and keeps what was heard: before the participant goes.
  void leave();
  /// Goes on with another one.
  void join(const Participant& participant);

  /// Takes what has come in since it was last called.
  void hear();

  /// Takes over an older account of a robot that is heard. One of another frame, or of the future, tells
  /// nothing.
  void hear_age(const RobotAge& age);

  /// By topic.
  std::vector<HeardRobot> robots() const;
  /// Writers that are not heard because there are kMaxRobots others.
  std::size_t over_limit() const { return over_limit_.size(); }
  /// GUIDs of all readers, 16 bytes each.
  std::vector<dds_guid_t> readers() const;
  /// Counts up with every robot that is discovered and every first map of one.
  std::uint64_t news() const { return news_; }
  /// Topics that might be meant and cannot be used, each with why, at most kMaxNear.
  std::vector<std::string> near_misses() const;

  static constexpr std::size_t kMaxNear = 64;
  /// So long after join() publishers that were heard before are waited for.
  static constexpr std::chrono::seconds kAwaited{5};

 private:
  /// Readers of one topic, one for each kind of writers: a reader that asks for more than a writer offers
  /// gets nothing.
  using Readers = std::map<TopicQos, DdsEntity>;

  struct Robot {
    HeardRobot heard;
    dds_time_t map_written = 0;  // of the newest whole map, by its publisher's clock; 0 where it does not say
    std::chrono::steady_clock::time_point map_taken;  // likewise
    Readers maps;
    Readers parts;
    std::optional<dds_instance_handle_t> followed;  // the writer whose maps count
    bool is_own = false;                            // what is heard is played by this program
    Reserve others;
    std::size_t part_publishers = 0;
  };

  struct Known {
    RemoteWriter writer;
    std::string topic;  // of the map; the writer's may be that of its updates
    bool is_parts = false;
  };

  void discover();
  void come(const RemoteWriter& writer);
  void go(dds_instance_handle_t handle);
  bool offer(const RemoteWriter& writer);
  void add_near(const RemoteWriter& writer, std::string why);
  void hear_maps(Robot& robot);
  void hear_parts(Robot& robot);
  void take_map(Robot& robot, const RemoteWriter& writer, const MapSample& message, dds_time_t written);
  void use_map(Robot& robot, const RemoteWriter& writer, HeardMap map, dds_time_t written);
  void take_part(Robot& robot, const RemoteWriter& writer, const UpdateSample& message, dds_time_t written);
  void use_part(Robot& robot, const HeardPart& part) const;
  void take_over(Robot& robot);
  bool has_room_for(const Robot& robot, std::size_t cells) const;
  void keep_aside(Robot& robot, const RemoteWriter& writer, const MapSample& message, dds_time_t written);
  void refuse(Robot& robot, const std::string& why) const;
  static bool is_publisher(const Robot& robot, const RemoteWriter& writer);
  bool is_awaited(const Robot& robot) const;
  const Known* find(dds_instance_handle_t handle);
  std::vector<WriterEvent> take_events();

  dds_entity_t participant_ = 0;
  dds_entity_t waitset_;
  RobotSelection selection_;
  Callbacks callbacks_;
  std::optional<Discovery> discovery_;
  std::chrono::steady_clock::time_point awaits_until_;
  std::vector<WriterEvent> pending_;     // what discovery told, for the next discover()
  std::map<std::string, Robot> robots_;  // by topic of the map
  std::map<dds_instance_handle_t, Known> writers_;
  std::map<dds_instance_handle_t, RemoteWriter> over_limit_;
  std::map<dds_instance_handle_t, std::pair<std::string, std::string>> near_;  // topic, and why it is none
  std::uint64_t news_ = 0;
  bool warned_of_limit_ = false;
};

}  // namespace gridmerge::internal
