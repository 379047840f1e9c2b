// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dds/entity.hpp"
#include "dds/message.hpp"
#include "dds/participant.hpp"
#include "dds/status.hpp"
#include "gridmerge/dds/ros_node.hpp"

namespace gridmerge::internal {

/// Publishes what a team of robots has come to, as a node of ROS 2.
class Publisher {
 public:
  /// The node's name and where it publishes come from `options`. Throws std::runtime_error.
  Publisher(const Participant& participant, const RosNodeOptions& options);

  /// A map for each component of the answer, with its time. One that is as it was last is not sent again; of
  /// a component that is no more, late subscribers find no old map. Returns whether all was sent: a
  /// subscriber that does not keep up may hold a map back, and it is worth trying again then.
  bool publish_maps(const TeamAnswer& answer, const std::vector<Stamp>& times);

  /// All transforms that there are. On /tf_static only what has changed is sent.
  void publish_transforms(const std::vector<NamedTransform>& transforms);

  void publish_diagnoses(const std::vector<Diagnosis>& diagnoses);

  /// Tells ROS's tools which node this participant is, and that it has these readers, and these writers
  /// besides those of this.
  void publish_node(const std::vector<dds_guid_t>& readers, const std::vector<dds_guid_t>& writers);

  /// Until all subscribers that are there have what was sent, at most so long.
  void flush(std::chrono::milliseconds most) const;

 private:
  struct MapTopic {
    DdsEntity writer;
    std::shared_ptr<const OccupancyGrid> sent;  // null if nothing was
  };

  void make_transform_writer();
  void make_map_writer(std::size_t number);

  dds_entity_t participant_;
  dds_guid_t guid_;
  std::string name_;
  std::string world_;
  std::string output_;
  TransformTopic transform_topic_;
  std::map<std::size_t, MapTopic> maps_;  // by number of the component; the first is always there
  DdsEntity transforms_;
  DdsEntity diagnoses_;
  DdsEntity node_;
  std::vector<NamedTransform> sent_transforms_;
  std::vector<std::string> sent_endpoints_;
};

}  // namespace gridmerge::internal
