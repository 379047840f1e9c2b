// SPDX-License-Identifier: Apache-2.0
#include "peer.hpp"

#include <cmath>
#include <functional>

#include "dds/message.hpp"
#include "dds/samples.hpp"

namespace gridmerge::test {

using namespace internal;

namespace {

template <typename Sample>
void take_all(dds_entity_t reader, const std::function<void(const Sample&)>& take) {
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info{};
    if (require_dds(dds_take(reader, &sample, &info, 1, 1), "taking") == 0) return;
    if (info.valid_data) take(*static_cast<const Sample*>(sample));
    dds_return_loan(reader, &sample, 1);
  }
}

}  // namespace

RawMap raw_map(const std::string& frame, const OccupancyGrid& grid) {
  RawMap map;
  map.frame = frame;
  map.resolution = static_cast<float>(grid.resolution);
  map.width = static_cast<std::uint32_t>(grid.width);
  map.height = static_cast<std::uint32_t>(grid.height);
  map.x = grid.origin.x;
  map.y = grid.origin.y;
  map.yaw = grid.origin.theta;
  map.data = message_values(grid);
  return map;
}

void MapTopic::publish(const RawMap& map) const {
  nav_msgs_msg_dds__OccupancyGrid_ sample{};
  sample.header.stamp.sec = map.seconds;
  sample.header.frame_id = text(map.frame);
  sample.info.resolution = map.resolution;
  sample.info.width = map.width;
  sample.info.height = map.height;
  sample.info.origin.position = {map.x, map.y, 0.0};
  sample.info.origin.orientation = {0.0, 0.0, std::sin(map.yaw / 2), std::cos(map.yaw / 2)};
  refer(sample.data, map.data);
  require_dds(dds_write_ts(writer_.get(), &sample, map.written.value_or(dds_time())), "writing a map");
}

Peer::Peer(std::uint32_t domain)
    : participant_(dds_create_participant(domain, nullptr, nullptr), "a peer's participant") {}

void Peer::publish_update(const std::string& topic, const RawUpdate& update) {
  DdsEntity& writer = updates_[topic];
  if (!writer) writer = make_writer(participant_.get(), kUpdateType, "rt" + topic, {true, true, 10});
  map_msgs_msg_dds__OccupancyGridUpdate_ sample{};
  sample.header.stamp.sec = update.seconds;
  sample.header.frame_id = text(update.frame);
  sample.x = update.x;
  sample.y = update.y;
  sample.width = update.width;
  sample.height = update.height;
  refer(sample.data, update.data);
  require_dds(dds_write_ts(writer.get(), &sample, update.written.value_or(dds_time())), "writing an update");
}

void Peer::publish_diagnosis(const std::map<std::string, std::string>& values) {
  DdsEntity& writer = updates_["/diagnostics"];
  if (!writer) writer = make_writer(participant_.get(), kDiagnosticType, "rt/diagnostics", {true, false, 1});
  std::vector<diagnostic_msgs_msg_dds__KeyValue_> pairs;
  for (const auto& [key, value] : values) pairs.push_back({text(key), text(value)});
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> statuses(1);
  const std::string nothing;
  statuses[0].name = statuses[0].message = statuses[0].hardware_id = text(nothing);
  refer(statuses[0].values, pairs);
  diagnostic_msgs_msg_dds__DiagnosticArray_ sample{};
  sample.header.frame_id = text(nothing);
  refer(sample.status, statuses);
  require_dds(dds_write(writer.get(), &sample), "writing a diagnosis");
}

dds_entity_t Peer::reader_of(const std::string& topic, const TopicType& type, const TopicQos& qos) {
  DdsEntity& reader = readers_[topic];
  if (!reader) reader = make_reader(participant_.get(), type, "rt" + topic, qos);
  return reader.get();
}

std::optional<RawMap> Peer::take_map(const std::string& topic) {
  take_all<nav_msgs_msg_dds__OccupancyGrid_>(
      reader_of(topic, kMapType, {true, true, 1}), [&](const nav_msgs_msg_dds__OccupancyGrid_& sample) {
        RawMap& map = maps_[topic];
        map.frame = sample.header.frame_id;
        map.seconds = sample.header.stamp.sec;
        map.resolution = sample.info.resolution;
        map.width = sample.info.width;
        map.height = sample.info.height;
        map.x = sample.info.origin.position.x;
        map.y = sample.info.origin.position.y;
        map.yaw = 2 * std::atan2(sample.info.origin.orientation.z, sample.info.origin.orientation.w);
        map.data.assign(sample.data._buffer, sample.data._buffer + sample.data._length);
      });
  const auto found = maps_.find(topic);
  return found == maps_.end() ? std::nullopt : std::optional(found->second);
}

const std::map<std::string, RawTransform>& Peer::transforms(const std::string& topic) {
  take_all<tf2_msgs_msg_dds__TFMessage_>(reader_of(topic, kTransformType, {true, topic == "/tf_static", 10}),
                                         [&](const tf2_msgs_msg_dds__TFMessage_& sample) {
                                           ++transform_messages_;
                                           for (std::uint32_t i = 0; i < sample.transforms._length; ++i) {
                                             const auto& one = sample.transforms._buffer[i];
                                             const auto& rotation = one.transform.rotation;
                                             transforms_[one.child_frame_id] = {
                                                 one.header.frame_id,
                                                 one.child_frame_id,
                                                 {one.transform.translation.x, one.transform.translation.y,
                                                  2 * std::atan2(rotation.z, rotation.w)}};
                                           }
                                         });
  return transforms_;
}

const std::map<std::string, RawDiagnosis>& Peer::diagnoses() {
  take_all<diagnostic_msgs_msg_dds__DiagnosticArray_>(
      reader_of("/diagnostics", kDiagnosticType, {true, false, 10}),
      [&](const diagnostic_msgs_msg_dds__DiagnosticArray_& sample) {
        // The first is of the node itself; those of robots begin with its name.
        const std::string node = sample.status._length > 0 ? sample.status._buffer[0].name : "";
        std::erase_if(diagnoses_, [&](const auto& one) {
          return one.first == node || one.first.starts_with(node + ": ");
        });
        ++received_;
        for (std::uint32_t i = 0; i < sample.status._length; ++i) {
          const auto& one = sample.status._buffer[i];
          RawDiagnosis& diagnosis = diagnoses_[one.name];
          diagnosis.received = received_;
          diagnosis.stamp = sample.header.stamp.sec + 1e-9 * sample.header.stamp.nanosec;
          diagnosis.level = one.level;
          diagnosis.message = one.message;
          for (std::uint32_t j = 0; j < one.values._length; ++j)
            diagnosis.values[one.values._buffer[j].key] = one.values._buffer[j].value;
        }
      });
  return diagnoses_;
}

}  // namespace gridmerge::test
