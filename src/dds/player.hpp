// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dds/entity.hpp"
#include "dds/participant.hpp"
#include "gridmerge/dds/ros_node.hpp"

namespace gridmerge::internal {

/// Publishes recorded maps as robots do that map at the same time: reliable and transient local, stamped with
/// the system's time.
class Player {
 public:
  /// Reads the first map of each topic. `warn` is called by play(). Throws what PlayedTopic::next does,
  /// std::runtime_error for a topic without a map, and as require_dds().
  Player(const Participant& participant, std::vector<PlayedTopic> topics, double rate,
         std::function<void(const std::string&)> warn);

  /// Lets go of the participant, before it goes.
  void leave();
  /// Goes on with another one. The newest maps are published once more, to who comes late too.
  void join(const Participant& participant);

  /// Publishes what is due `seconds` after the beginning. Of several maps of a topic that are due, only the
  /// newest is published. What a subscriber holds back is tried again by the next call. Throws what
  /// PlayedTopic::next does, and Cancelled.
  void play(double seconds);

  /// Whether all maps of all topics were published.
  bool is_over() const;

  std::vector<dds_guid_t> writers() const;

 private:
  struct Topic {
    PlayedTopic played;
    DdsEntity writer;
    bool has_own_frames = false;    // in the topic's namespace
    std::optional<PlayedMap> sent;  // the last that was published
    std::optional<PlayedMap> due;   // is to be published now
    std::optional<PlayedMap> next;  // comes later
  };

  struct Recording {
    std::vector<std::size_t> topics;
    double begin = 0.0;  // PlayedMap::seconds of what is played at once
    double last = 0.0;   // when the last map was due, since the beginning
  };

  /// The topic whose map comes next; null if there are no more.
  Topic* next_of(const Recording& recording);
  void advance(Recording& recording, double seconds);

  std::vector<Topic> topics_;
  std::vector<Recording> recordings_;
  double rate_ = 1.0;
  std::function<void(const std::string&)> warn_;
};

}  // namespace gridmerge::internal
