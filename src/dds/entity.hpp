// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

namespace gridmerge::internal {

/// Throws std::runtime_error that says what was tried and what Cyclone DDS answered, unless `code` is 0 or
/// more.
std::int32_t require_dds(std::int32_t code, std::string_view what);

/// A topic, reader, writer or the like, deleted with all that belongs to it when this goes.
class DdsEntity {
 public:
  DdsEntity() = default;
  /// Throws as require_dds().
  DdsEntity(dds_entity_t handle, std::string_view what) : handle_(require_dds(handle, what)) {}
  ~DdsEntity() { reset(); }
  DdsEntity(DdsEntity&& other) noexcept;
  DdsEntity& operator=(DdsEntity&& other) noexcept;
  DdsEntity(const DdsEntity&) = delete;
  DdsEntity& operator=(const DdsEntity&) = delete;

  dds_entity_t get() const { return handle_; }
  explicit operator bool() const { return handle_ > 0; }
  void reset();

 private:
  dds_entity_t handle_ = 0;
};

/// The entity's number in DDS. Throws as require_dds().
dds_guid_t guid_of(dds_entity_t entity);

/// A type of ROS's: how Cyclone DDS reads and writes it, and the hash by which ROS's tools know its
/// definition.
struct TopicType {
  const dds_topic_descriptor_t* descriptor = nullptr;
  const char* hash = "";  // "RIHS01_...", or empty
};

extern const TopicType kMapType;
extern const TopicType kUpdateType;
extern const TopicType kTransformType;
extern const TopicType kDiagnosticType;
extern const TopicType kGraphType;

/// What a reader asks for and a writer offers, as ROS names it. History keeps the last `depth` messages.
struct TopicQos {
  bool reliable = true;
  bool transient_local = false;
  std::int32_t depth = 1;

  // NOLINTNEXTLINE(modernize-use-nullptr): the 0 is one that the compiler puts there
  friend auto operator<=>(const TopicQos&, const TopicQos&) = default;
};

/// In the USER_DATA of this program's writers: maps that have it are merged ones.
inline constexpr std::string_view kMergedMark = "gridmerge=merged;";
/// Likewise, of recorded maps that this program publishes: it hears them as any robot's.
inline constexpr std::string_view kPlayedMark = "gridmerge=played;";

/// A reader of a topic, by its name in DDS. Throws as require_dds().
DdsEntity make_reader(dds_entity_t participant, const TopicType& type, const std::string& topic,
                      const TopicQos& qos);

/// A writer likewise, with `mark` in its USER_DATA. Readers of the same participant do not hear it, except
/// where the mark is kPlayedMark.
DdsEntity make_writer(dds_entity_t participant, const TopicType& type, const std::string& topic,
                      const TopicQos& qos, std::string_view mark = {});

}  // namespace gridmerge::internal
