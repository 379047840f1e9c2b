// SPDX-License-Identifier: Apache-2.0
#include "dds/publisher.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

#include "dds/names.hpp"
#include "dds/samples.hpp"
#include "grid/equal_grids.hpp"

namespace gridmerge::internal {

namespace {

/// Whether messages of both maps are the same: these have no probabilities.
bool is_same(const OccupancyGrid& a, const OccupancyGrid& b) {
  return a.origin == b.origin && has_equal_cells(a, b);
}

rmw_dds_common_msg_dds__Gid_ gid_of(const dds_guid_t& guid) {
  rmw_dds_common_msg_dds__Gid_ gid{};
  static_assert(sizeof gid.data == sizeof guid.v);
  std::memcpy(gid.data, guid.v, sizeof guid.v);
  return gid;
}

}  // namespace

Publisher::Publisher(const Participant& participant, const RosNodeOptions& options)
    : participant_(participant.get()),
      guid_(participant.guid()),
      name_(options.name),
      world_(options.world_frame),
      output_(options.output),
      transform_topic_(options.transforms) {
  make_transform_writer();
  diagnoses_ = make_writer(participant_, kDiagnosticType, dds_topic("/diagnostics"), {true, false, 1});
  node_ = make_writer(participant_, kGraphType, "ros_discovery_info", {true, true, 1});
  make_map_writer(1);
}

void Publisher::make_transform_writer() {
  if (transform_topic_ == TransformTopic::none) return;
  const bool is_static = transform_topic_ == TransformTopic::tf_static;
  transforms_ = {};  // first the old one goes, with what it keeps for whoever comes late
  transforms_ = make_writer(participant_, kTransformType, dds_topic(is_static ? "/tf_static" : "/tf"),
                            {true, is_static, is_static ? 1 : 100});
}

void Publisher::make_map_writer(std::size_t number) {
  const std::string topic = component_frame(output_, number);  // /merged_map, /merged_map_2, ...
  maps_[number] = {};                                          // first the old one goes, with its map
  maps_[number].writer = make_writer(participant_, kMapType, dds_topic(topic), {true, true, 1}, kMergedMark);
}

bool Publisher::publish_maps(const TeamAnswer& answer, const std::vector<Stamp>& times) {
  std::set<std::size_t> numbers;
  for (const TeamComponent& component : answer.components) numbers.insert(component.number);
  std::erase_if(maps_, [&](const auto& one) { return one.first != 1 && !numbers.contains(one.first); });
  if (!numbers.contains(1) && maps_.at(1).sent) make_map_writer(1);
  bool all = true;
  for (std::size_t i = 0; i < answer.components.size(); ++i) {
    const TeamComponent& component = answer.components[i];
    const std::shared_ptr<const OccupancyGrid>& map = component.map;
    if (!maps_.contains(component.number)) make_map_writer(component.number);
    MapTopic& topic = maps_.at(component.number);
    if (!map || (topic.sent && (topic.sent == map || is_same(*topic.sent, *map)))) continue;
    if (write_map(topic.writer, *map, component_frame(world_, component.number), times.at(i))) {
      topic.sent = map;
    } else {
      all = false;
    }
  }
  return all;
}

void Publisher::publish_transforms(const std::vector<NamedTransform>& transforms) {
  const bool is_static = transform_topic_ == TransformTopic::tf_static;
  if (!transforms_ || (is_static && transforms == sent_transforms_)) return;
  if (transforms.empty()) {
    if (is_static) make_transform_writer();
    sent_transforms_.clear();
    return;
  }
  const Stamp stamp = now();
  std::vector<geometry_msgs_msg_dds__TransformStamped_> elements;
  for (const NamedTransform& transform : transforms) {
    const SE2& T = transform.T_parent_child;
    geometry_msgs_msg_dds__TransformStamped_ element{};
    element.header.stamp = time_of(stamp);
    element.header.frame_id = text(transform.parent);
    element.child_frame_id = text(transform.child);
    element.transform.translation = {T.x, T.y, 0.0};
    element.transform.rotation = {0.0, 0.0, std::sin(T.theta / 2), std::cos(T.theta / 2)};
    elements.push_back(element);
  }
  tf2_msgs_msg_dds__TFMessage_ sample{};
  refer(sample.transforms, elements);
  if (write(transforms_, &sample, "transforms")) sent_transforms_ = transforms;
}

void Publisher::publish_diagnoses(const std::vector<Diagnosis>& diagnoses) {
  std::vector<std::vector<diagnostic_msgs_msg_dds__KeyValue_>> values;
  values.reserve(diagnoses.size());
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> elements;
  for (const Diagnosis& diagnosis : diagnoses) {
    values.emplace_back();
    values.back().reserve(diagnosis.values.size());
    for (const auto& [key, value] : diagnosis.values) values.back().push_back({text(key), text(value)});
    diagnostic_msgs_msg_dds__DiagnosticStatus_ element{};
    element.level = diagnosis.level;
    element.name = text(diagnosis.name);
    element.message = text(diagnosis.message);
    element.hardware_id = text(diagnosis.hardware);
    refer(element.values, values.back());
    elements.push_back(element);
  }
  diagnostic_msgs_msg_dds__DiagnosticArray_ sample{};
  const std::string no_frame;
  sample.header.stamp = time_of(now());
  sample.header.frame_id = text(no_frame);
  refer(sample.status, elements);
  write(diagnoses_, &sample, "diagnostics");
}

void Publisher::publish_node(const std::vector<dds_guid_t>& readers, const std::vector<dds_guid_t>& writers) {
  const auto gid_of_entity = [](const DdsEntity& entity) { return gid_of(guid_of(entity.get())); };
  std::vector<rmw_dds_common_msg_dds__Gid_> reader_gids;
  reader_gids.reserve(readers.size());
  for (const dds_guid_t& guid : readers) reader_gids.push_back(gid_of(guid));
  std::vector<rmw_dds_common_msg_dds__Gid_> writer_gids;
  writer_gids.reserve(writers.size() + maps_.size() + 2);
  for (const dds_guid_t& guid : writers) writer_gids.push_back(gid_of(guid));
  if (transforms_) writer_gids.push_back(gid_of_entity(transforms_));
  writer_gids.push_back(gid_of_entity(diagnoses_));
  for (const auto& [number, map] : maps_) writer_gids.push_back(gid_of_entity(map.writer));

  std::vector<std::string> endpoints;
  for (const auto* gids : {&reader_gids, &writer_gids})
    for (const auto& gid : *gids)
      endpoints.emplace_back(reinterpret_cast<const char*>(gid.data), sizeof gid.data);
  if (endpoints == sent_endpoints_) return;

  const std::string root = "/";
  std::vector<rmw_dds_common_msg_dds__NodeEntitiesInfo_> nodes(1);
  nodes.front() = {};
  nodes.front().node_namespace = text(root);
  nodes.front().node_name = text(name_);
  refer(nodes.front().reader_gid_seq, reader_gids);
  refer(nodes.front().writer_gid_seq, writer_gids);
  rmw_dds_common_msg_dds__ParticipantEntitiesInfo_ sample{};
  sample.gid = gid_of(guid_);
  refer(sample.node_entities_info_seq, nodes);
  if (write(node_, &sample, "the node's name")) sent_endpoints_ = std::move(endpoints);
}

void Publisher::flush(std::chrono::milliseconds most) const {
  const auto end = std::chrono::steady_clock::now() + most;
  const auto wait = [&](const DdsEntity& writer) {
    const auto left = std::max(std::chrono::nanoseconds(end - std::chrono::steady_clock::now()),
                               std::chrono::nanoseconds(0));
    dds_wait_for_acks(writer.get(), left.count());  // that time runs out is no error here
  };
  for (const auto& [number, map] : maps_) wait(map.writer);
  if (transforms_) wait(transforms_);
  wait(diagnoses_);
}

}  // namespace gridmerge::internal
