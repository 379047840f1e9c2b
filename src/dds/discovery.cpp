// SPDX-License-Identifier: Apache-2.0
#include "dds/discovery.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "dds/names.hpp"

namespace gridmerge::internal {

namespace {

std::string digits_of(const dds_guid_t& guid) {
  return fmt::format("{:02x}", fmt::join(guid.v, ""));
}

std::string user_data_of(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &data, &size) || data == nullptr) return {};
  std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  return text;
}

TopicQos qos_of(const dds_qos_t* qos) {
  TopicQos read;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_duration_t wait = 0;
  if (dds_qget_reliability(qos, &reliability, &wait)) read.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  if (dds_qget_durability(qos, &durability)) read.transient_local = durability != DDS_DURABILITY_VOLATILE;
  return read;
}

bool in_partition(const dds_qos_t* qos) {
  std::uint32_t count = 0;
  char** names = nullptr;
  if (!dds_qget_partition(qos, &count, &names)) return false;
  bool named = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    named = named || *names[i] != '\0';
    dds_free(names[i]);
  }
  dds_free(names);
  return named;
}

}  // namespace

Discovery::Discovery(dds_entity_t participant, const dds_guid_t& own)
    : own_(digits_of(own)),
      reader_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
              "a reader of who publishes what") {}

std::vector<WriterEvent> Discovery::take() {
  constexpr std::size_t kAtOnce = 32;
  std::vector<WriterEvent> events;
  for (;;) {
    std::array<void*, kAtOnce> samples{};
    std::array<dds_sample_info_t, kAtOnce> infos{};
    const std::int32_t count =
        require_dds(dds_take(reader_.get(), samples.data(), infos.data(), kAtOnce, kAtOnce), "who publishes");
    if (count == 0) return events;
    for (std::int32_t i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const dds_sample_info_t& info = infos[at];
      WriterEvent event;
      event.writer.handle = info.instance_handle;
      event.alive = info.valid_data && info.instance_state == DDS_IST_ALIVE;
      if (!event.alive) {
        events.push_back(std::move(event));
        continue;
      }
      const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(samples[at]);
      const std::optional<std::string> topic = ros_topic(endpoint.topic_name);
      event.writer.participant = digits_of(endpoint.participant_key);
      const std::string user_data = user_data_of(endpoint.qos);
      const bool is_played = user_data.find(kPlayedMark) != std::string::npos;
      event.writer.is_own = event.writer.participant == own_;
      if (!topic || (event.writer.is_own && !is_played)) continue;
      event.writer.guid = digits_of(endpoint.key);
      event.writer.topic = *topic;
      event.writer.type = endpoint.type_name;
      event.writer.qos = qos_of(endpoint.qos);
      event.writer.in_partition = in_partition(endpoint.qos);
      event.writer.is_merged = user_data.find(kMergedMark) != std::string::npos;
      events.push_back(std::move(event));
    }
    dds_return_loan(reader_.get(), samples.data(), count);
  }
}

}  // namespace gridmerge::internal
