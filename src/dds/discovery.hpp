// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <string>
#include <vector>

#include "dds/entity.hpp"

namespace gridmerge::internal {

/// A writer of another participant, on a topic of ROS's.
struct RemoteWriter {
  dds_instance_handle_t handle = 0;  // what samples are marked with
  std::string guid;           // in 32 hexadecimal digits: the same after an outage, another after a restart
  std::string participant;    // likewise
  std::string topic;          // in ROS
  std::string type;           // in DDS
  TopicQos qos;               // what it offers; the depth is that of its own history
  bool in_partition = false;  // of DDS's, which ROS knows nothing of
  bool is_merged = false;     // a gridmerge node's
  bool is_own = false;        // of this participant, which plays a recording
};

/// What became of writers since the last look, in the order in which it happened.
struct WriterEvent {
  bool alive = false;
  RemoteWriter writer;  // of one that went only the handle
};

/// Tells of the writers of all topics of ROS's in the participant's domain, except the participant's own.
class Discovery {
 public:
  Discovery(dds_entity_t participant, const dds_guid_t& own);

  /// For a wait set.
  dds_entity_t reader() const { return reader_.get(); }

  std::vector<WriterEvent> take();

 private:
  std::string own_;
  DdsEntity reader_;
};

}  // namespace gridmerge::internal
