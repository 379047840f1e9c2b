// SPDX-License-Identifier: Apache-2.0
#include "dds/entity.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "ros_messages.h"

namespace gridmerge::internal {

namespace {

// A writer waits no longer for a reader that does not keep up.
constexpr dds_duration_t kLongestWait = DDS_MSECS(200);

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

Qos make_qos(const TopicType& type, const TopicQos& wanted, std::string_view mark) {
  Qos qos(dds_create_qos());
  if (!qos) throw std::bad_alloc();
  dds_qset_reliability(qos.get(), wanted.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kLongestWait);
  dds_qset_durability(qos.get(),
                      wanted.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, wanted.depth);
  if (wanted.transient_local)  // as much for readers that come late
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, wanted.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  std::string user_data;
  if (*type.hash != '\0') user_data = fmt::format("typehash={};", type.hash);
  user_data += mark;
  if (!user_data.empty()) dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  return qos;
}

DdsEntity make_topic(dds_entity_t participant, const TopicType& type, const std::string& topic) {
  return {dds_create_topic(participant, type.descriptor, topic.c_str(), nullptr, nullptr),
          fmt::format("the topic {}", topic)};
}

}  // namespace

const TopicType kMapType{&nav_msgs_msg_dds__OccupancyGrid__desc,
                         "RIHS01_8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7"};
const TopicType kUpdateType{&map_msgs_msg_dds__OccupancyGridUpdate__desc,
                            "RIHS01_c4095b0be2e4363f8978a1570e0293ee093436f1e1c61d99b48502ac317025e8"};
const TopicType kTransformType{&tf2_msgs_msg_dds__TFMessage__desc,
                               "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"};
const TopicType kDiagnosticType{&diagnostic_msgs_msg_dds__DiagnosticArray__desc,
                                "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"};
const TopicType kGraphType{&rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc, ""};

std::int32_t require_dds(std::int32_t code, std::string_view what) {
  if (code < 0) throw std::runtime_error(fmt::format("DDS: {}: {}", what, dds_strretcode(-code)));
  return code;
}

DdsEntity::DdsEntity(DdsEntity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}

DdsEntity& DdsEntity::operator=(DdsEntity&& other) noexcept {
  if (this == &other) return *this;
  reset();
  handle_ = std::exchange(other.handle_, 0);
  return *this;
}

dds_guid_t guid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  require_dds(dds_get_guid(entity, &guid), "an entity's number");
  return guid;
}

void DdsEntity::reset() {
  if (handle_ > 0) dds_delete(std::exchange(handle_, 0));
}

// Topics are counted: each lives as long as what was made of it.
DdsEntity make_reader(dds_entity_t participant, const TopicType& type, const std::string& topic,
                      const TopicQos& qos) {
  const DdsEntity made = make_topic(participant, type, topic);
  return {dds_create_reader(participant, made.get(), make_qos(type, qos, {}).get(), nullptr),
          fmt::format("a reader of {}", topic)};
}

DdsEntity make_writer(dds_entity_t participant, const TopicType& type, const std::string& topic,
                      const TopicQos& qos, std::string_view mark) {
  const DdsEntity made = make_topic(participant, type, topic);
  const Qos whole = make_qos(type, qos, mark);
  if (mark != kPlayedMark) dds_qset_ignorelocal(whole.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return {dds_create_writer(participant, made.get(), whole.get(), nullptr),
          fmt::format("a writer of {}", topic)};
}

}  // namespace gridmerge::internal
