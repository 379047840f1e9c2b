// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dds/entity.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge::test {

/// A nav_msgs/OccupancyGrid with nothing checked.
struct RawMap {
  std::string frame = "map";
  std::int32_t seconds = 1;
  float resolution = 0.05F;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
  std::vector<std::int8_t> data{0};
  std::optional<dds_time_t> written = {};  // by the publisher's clock; now where it is not given
};

RawMap raw_map(const std::string& frame, const OccupancyGrid& grid);

/// A map_msgs/OccupancyGridUpdate likewise.
struct RawUpdate {
  std::string frame = "map";
  std::int32_t seconds = 1;
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::vector<std::int8_t> data{0};
  std::optional<dds_time_t> written = {};  // likewise
};

struct RawTransform {
  std::string parent;
  std::string child;
  SE2 T_parent_child;
};

struct RawDiagnosis {
  std::uint64_t received = 0;  // messages of all nodes up to the one that has it
  double stamp = 0.0;          // its time [s since 1970]
  int level = -1;
  std::string message;
  std::map<std::string, std::string> values;
};

/// Something that is published, until it goes.
class MapTopic {
 public:
  MapTopic(dds_entity_t participant, const std::string& topic, const internal::TopicQos& qos)
      : writer_(internal::make_writer(participant, internal::kMapType, internal_name(topic), qos)) {}
  void publish(const RawMap& map) const;

 private:
  static std::string internal_name(const std::string& topic) { return "rt" + topic; }
  internal::DdsEntity writer_;
};

/// A participant beside the node, in this process or over the network.
class Peer {
 public:
  explicit Peer(std::uint32_t domain);

  dds_entity_t participant() const { return participant_.get(); }

  MapTopic maps(const std::string& topic, bool transient_local = true, bool reliable = true) const {
    return {participant_.get(), topic, {reliable, transient_local, 1}};
  }

  void publish_update(const std::string& topic, const RawUpdate& update);

  /// A diagnosis of a robot with these values.
  void publish_diagnosis(const std::map<std::string, std::string>& values);

  /// The newest map that was received on a topic since it was asked for first; a late subscriber then.
  std::optional<RawMap> take_map(const std::string& topic);
  /// All transforms that were received, by child.
  const std::map<std::string, RawTransform>& transforms(const std::string& topic = "/tf_static");
  /// Messages of transforms that were received.
  std::uint64_t transform_messages() const { return transform_messages_; }
  /// The newest diagnoses of each node, by name.
  const std::map<std::string, RawDiagnosis>& diagnoses();

 private:
  dds_entity_t reader_of(const std::string& topic, const internal::TopicType& type,
                         const internal::TopicQos& qos);

  internal::DdsEntity participant_;
  std::map<std::string, internal::DdsEntity> readers_;
  std::map<std::string, internal::DdsEntity> updates_;
  std::map<std::string, RawMap> maps_;
  std::map<std::string, RawTransform> transforms_;
  std::map<std::string, RawDiagnosis> diagnoses_;
  std::uint64_t received_ = 0;
  std::uint64_t transform_messages_ = 0;
};

}  // namespace gridmerge::test
