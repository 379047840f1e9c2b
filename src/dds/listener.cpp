// SPDX-License-Identifier: Apache-2.0
#include "dds/listener.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>
#include <string_view>

#include "dds/loan.hpp"
#include "dds/names.hpp"
#include "dds/samples.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::string_view kUpdates = "_updates";
constexpr std::int32_t kPartsKept = 64;
// An update that comes so long after a map was not sent before it, whatever the publisher's clock says.
constexpr std::chrono::seconds kLatest{5};
// Of the writers that are not heard; beyond it they are forgotten.
constexpr std::size_t kMaxOverLimit = 4096;

bool is_type(const RemoteWriter& writer, const TopicType& type) {
  return writer.type == type.descriptor->m_typename;
}

TopicQos reader_qos(const RemoteWriter& writer, std::int32_t depth) {
  return {writer.qos.reliable, writer.qos.transient_local, depth};
}

}  // namespace

MapListener::MapListener(const Participant& participant, dds_entity_t waitset, RobotSelection selection,
                         Callbacks callbacks)
    : waitset_(waitset), selection_(std::move(selection)), callbacks_(std::move(callbacks)) {
  join(participant);
}

void MapListener::join(const Participant& participant) {
  participant_ = participant.get();
  if (!robots_.empty()) awaits_until_ = std::chrono::steady_clock::now() + kAwaited;
  discovery_.emplace(participant.get(), participant.guid());
  dds_set_status_mask(discovery_->reader(), DDS_DATA_AVAILABLE_STATUS);
  require_dds(dds_waitset_attach(waitset_, discovery_->reader(), 0), "waiting for publishers");
}

void MapListener::leave() {
  for (auto& [topic, robot] : robots_) {
    robot.followed.reset();
    robot.others.clear();
    robot.maps.clear();
    robot.parts.clear();
    robot.heard.publishers = robot.part_publishers = 0;
  }
  writers_.clear();
  over_limit_.clear();
  near_.clear();
  pending_.clear();
  discovery_.reset();
}

void MapListener::hear() {
  discover();
  // Discovery may go on in between, but nothing that is iterated over here goes then: see find().
  for (auto& [topic, robot] : robots_) {
    hear_maps(robot);
    hear_parts(robot);
  }
}

void MapListener::hear_age(const RobotAge& age) {
  const auto robot = robots_.find(age.topic);
  if (robot == robots_.end()) return;
  HeardRobot& heard = robot->second.heard;
  if (heard.maps == 0 || heard.publisher != age.publisher || heard.frame != age.frame) return;
  heard.heard_first = std::min(heard.heard_first, age.heard_first);
}

std::vector<HeardRobot> MapListener::robots() const {
  std::vector<HeardRobot> heard;
  for (const auto& [topic, robot] : robots_) {
    heard.push_back(robot.heard);
    heard.back().awaited = is_awaited(robot);
  }
  return heard;
}

std::vector<dds_guid_t> MapListener::readers() const {
  std::vector<dds_guid_t> guids;
  const auto add = [&](const Readers& readers) {
    for (const auto& [qos, reader] : readers) guids.push_back(guid_of(reader.get()));
  };
  for (const auto& [topic, robot] : robots_) {
    add(robot.maps);
    add(robot.parts);
  }
  return guids;
}

std::vector<std::string> MapListener::near_misses() const {
  std::set<std::string> lines;  // a line for each, however many publish there
  for (const auto& [handle, near] : near_) lines.insert(near.first + ": " + near.second);
  return {lines.begin(), lines.end()};
}

void MapListener::discover() {
  const std::vector<WriterEvent> events = take_events();
  for (const WriterEvent& event : events) {
    // A writer that is alive may be told of again, when its QoS changed.
    go(event.writer.handle);
    if (event.alive) come(event.writer);
  }
  for (auto& [topic, robot] : robots_) take_over(robot);
  // Robots that went without ever sending a map make room.
  std::erase_if(robots_, [](const auto& entry) {
    const Robot& robot = entry.second;
    return robot.heard.maps == 0 && robot.heard.publishers == 0 && robot.part_publishers == 0;
  });
  while (robots_.size() < kMaxRobots && !over_limit_.empty()) {
    const RemoteWriter writer = over_limit_.begin()->second;
    over_limit_.erase(over_limit_.begin());
    come(writer);
  }
}

void MapListener::come(const RemoteWriter& writer) {
  if (writer.is_merged || offer(writer)) return;
  const bool is_robots = selection_.robot_of(writer.topic).has_value();
  if (is_robots && !is_type(writer, kMapType)) {
    add_near(writer, fmt::format("is of the type {}", ros_type(writer.type)));
  } else if (is_robots && writer.in_partition) {
    add_near(writer, "is in a partition of DDS, which ROS 2 does not use");
  } else if (is_type(writer, kMapType) && !is_robots) {
    add_near(writer, "is a map, but its name is not one of those");
  }
}

/// Whether the writer is one that is heard, now or when there is room.
bool MapListener::offer(const RemoteWriter& writer) {
  if (writer.in_partition) return false;
  const bool is_parts = is_type(writer, kUpdateType) && writer.topic.ends_with(kUpdates);
  if (!is_parts && !is_type(writer, kMapType)) return false;
  const std::string topic =
      is_parts ? writer.topic.substr(0, writer.topic.size() - kUpdates.size()) : writer.topic;
  const std::optional<std::string> name = selection_.robot_of(topic);
  if (!name) return false;
  auto robot = robots_.find(topic);
  if (robot == robots_.end()) {
    if (robots_.size() >= kMaxRobots) {
      if (over_limit_.size() < kMaxOverLimit) over_limit_.emplace(writer.handle, writer);
      if (!warned_of_limit_)
        callbacks_.warn(
            "too many robots",
            fmt::format("{} and perhaps others are not heard: there are {} robots", topic, kMaxRobots));
      warned_of_limit_ = true;
      return true;
    }
    robot = robots_.emplace(topic, Robot{}).first;
    robot->second.heard.name = *name;
    robot->second.heard.topic = topic;
    ++news_;
  }
  writers_[writer.handle] = Known{writer, topic, is_parts};
  ++(is_parts ? robot->second.part_publishers : robot->second.heard.publishers);
  if (!is_parts && !robot->second.followed && is_publisher(robot->second, writer))
    robot->second.followed = writer.handle;  // it was away
  const TopicQos qos = reader_qos(writer, is_parts ? kPartsKept : 1);
  Readers& readers = is_parts ? robot->second.parts : robot->second.maps;
  if (!readers.contains(qos)) {
    DdsEntity reader =
        make_reader(participant_, is_parts ? kUpdateType : kMapType, dds_topic(writer.topic), qos);
    require_dds(dds_set_status_mask(reader.get(), DDS_DATA_AVAILABLE_STATUS), "waiting for maps");
    require_dds(dds_waitset_attach(waitset_, reader.get(), 0), "waiting for maps");
    readers.emplace(qos, std::move(reader));
  }
  return true;
}

void MapListener::go(dds_instance_handle_t handle) {
  near_.erase(handle);
  over_limit_.erase(handle);
  const auto found = writers_.find(handle);
  if (found == writers_.end()) return;
  const auto robot = robots_.find(found->second.topic);
  if (robot != robots_.end()) {
    --(found->second.is_parts ? robot->second.part_publishers : robot->second.heard.publishers);
    if (robot->second.followed == handle) robot->second.followed.reset();
  }
  writers_.erase(found);
}

void MapListener::add_near(const RemoteWriter& writer, std::string why) {
  if (near_.size() < kMaxNear) near_.emplace(writer.handle, std::pair(writer.topic, std::move(why)));
}

std::vector<WriterEvent> MapListener::take_events() {
  std::vector<WriterEvent> events = std::exchange(pending_, {});
  std::vector<WriterEvent> more = discovery_->take();
  std::move(more.begin(), more.end(), std::back_inserter(events));
  return events;
}

/// Whether the writer is the one whose maps were heard last. What this program plays has another number after
/// join(), and is no robot that starts anew.
bool MapListener::is_publisher(const Robot& robot, const RemoteWriter& writer) {
  return writer.is_own ? robot.is_own : robot.heard.publisher == writer.guid;
}

/// Whether the robot's publisher may be there, and is only not discovered yet.
bool MapListener::is_awaited(const Robot& robot) const {
  return !robot.followed && robot.heard.maps > 0 && std::chrono::steady_clock::now() < awaits_until_;
}

/// The writer of a sample. Its first one may be here before discover() saw the writer: only what came is
/// dealt with then. What went waits for the next discover(), since robots are erased with it.
const MapListener::Known* MapListener::find(dds_instance_handle_t handle) {
  auto found = writers_.find(handle);
  if (found == writers_.end()) {
    pending_ = take_events();
    const auto last = std::find_if(pending_.rbegin(), pending_.rend(),
                                   [&](const WriterEvent& event) { return event.writer.handle == handle; });
    if (last == pending_.rend() || !last->alive) return nullptr;
    const RemoteWriter writer = last->writer;
    std::erase_if(pending_, [&](const WriterEvent& event) { return event.writer.handle == handle; });
    come(writer);
    found = writers_.find(handle);
  }
  return found == writers_.end() ? nullptr : &found->second;
}

void MapListener::hear_maps(Robot& robot) {
  for (auto& [qos, reader] : robot.maps) {
    for (;;) {
      const Loan loan(reader.get());
      if (!loan.is_there()) break;
      if (!loan.info().valid_data) continue;
      const Known* known = find(loan.info().publication_handle);
      if (known == nullptr || reader_qos(known->writer, 1) != qos) continue;
      take_map(robot, known->writer, view_of(loan.as<nav_msgs_msg_dds__OccupancyGrid_>()),
               loan.info().source_timestamp);
    }
  }
}

void MapListener::hear_parts(Robot& robot) {
  for (auto& [qos, reader] : robot.parts) {
    for (;;) {
      const Loan loan(reader.get());
      if (!loan.is_there()) break;
      if (!loan.info().valid_data) continue;
      const Known* known = find(loan.info().publication_handle);
      if (known == nullptr || reader_qos(known->writer, kPartsKept) != qos) continue;
      take_part(robot, known->writer, view_of(loan.as<map_msgs_msg_dds__OccupancyGridUpdate_>()),
                loan.info().source_timestamp);
    }
  }
}

void MapListener::take_map(Robot& robot, const RemoteWriter& writer, const MapSample& message,
                           dds_time_t written) {
  HeardRobot& heard = robot.heard;
  if (robot.followed && *robot.followed != writer.handle) {
    if (heard.unheard++ == 0)
      callbacks_.warn("several " + heard.topic,
                      fmt::format("{}: has several publishers, and the first one is heard", heard.topic));
    keep_aside(robot, writer, message, written);
    return;
  }
  if (is_awaited(robot) && !is_publisher(robot, writer)) return keep_aside(robot, writer, message, written);
  // After an outage a publisher sends again what it keeps. The updates since then are not to be undone. A
  // publisher that does not say when it wrote a map may send another one at the same time, 0.
  const bool is_known = written > 0 && robot.map_written == written;
  if (heard.maps > 0 && heard.publisher == writer.guid && is_known) return;
  try {
    use_map(robot, writer, read_map(message), written);
  } catch (const RefusedMessage& error) {
    refuse(robot, error.what());
  }
}

void MapListener::use_map(Robot& robot, const RemoteWriter& writer, HeardMap map, dds_time_t written) {
  HeardRobot& heard = robot.heard;
  const std::size_t cells = map.grid.cells.size();
  if (!has_room_for(robot, cells)) {
    for (auto& [topic, other] : robots_) other.others.clear();
    if (!has_room_for(robot, cells)) throw RefusedMessage("all maps together have above 2^30 cells");
  }
  const TeamTime now = std::chrono::system_clock::now();
  const bool restarted = heard.maps > 0 && (!is_publisher(robot, writer) || heard.frame != map.frame);
  const std::string frame = map.frame;
  callbacks_.map(heard.name, std::move(map), restarted);  // may refuse it
  robot.followed = writer.handle;
  robot.map_written = written;
  robot.map_taken = std::chrono::steady_clock::now();
  if (heard.maps == 0 || restarted) heard.heard_first = now;
  heard.publisher = writer.guid;
  robot.is_own = writer.is_own;
  heard.frame = frame;
  heard.cells = cells;
  if (heard.maps++ == 0) ++news_;
}

bool MapListener::has_room_for(const Robot& robot, std::size_t cells) const {
  std::size_t together = cells;
  for (const auto& [topic, other] : robots_)
    together += other.others.cells() + (&other == &robot ? 0 : other.heard.cells);
  return together <= kMaxCellsTogether;
}

/// What is wrong or too much is not kept; it is counted as all that this publisher sends.
void MapListener::keep_aside(Robot& robot, const RemoteWriter& writer, const MapSample& message,
                             dds_time_t written) {
  try {
    HeardMap map = read_map(message);
    if (has_room_for(robot, robot.heard.cells + map.grid.cells.size()))
      robot.others.keep({writer, std::move(map), written, {}});
  } catch (const RefusedMessage&) {
  }
}

/// Where the publisher that was heard is gone, one of the others is heard from now on.
void MapListener::take_over(Robot& robot) {
  robot.others.keep_only([&](const RemoteWriter& writer) { return writers_.contains(writer.handle); });
  while (!robot.followed && !is_awaited(robot)) {
    std::optional<Reserve::Kept> kept = robot.others.take_newest();
    if (!kept) return;
    try {
      use_map(robot, kept->writer, std::move(kept->map), kept->written);
      for (const HeardPart& part : kept->parts) use_part(robot, part);
    } catch (const RefusedMessage& error) {
      refuse(robot, error.what());
    }
  }
}

void MapListener::take_part(Robot& robot, const RemoteWriter& writer, const UpdateSample& message,
                            dds_time_t written) {
  const Known* map = robot.followed ? find(*robot.followed) : nullptr;
  try {
    HeardPart part = read_update(message);
    if (map == nullptr || map->writer.participant != writer.participant) {
      const bool has_room = has_room_for(robot, robot.heard.cells + part.grid.cells.size());
      if (!has_room || !robot.others.keep(writer.participant, std::move(part), written))
        throw RefusedMessage(map == nullptr
                                 ? "an update without a map before it"
                                 : "an update by another program than the one that publishes the map");
      ++robot.heard.unheard;
      return;
    }
    // Both are written by one clock. The times in the messages are the user's, and may be 0, or go back.
    const bool is_late = std::chrono::steady_clock::now() - robot.map_taken > kLatest;
    if (written > 0 && written < robot.map_written && !is_late) {
      ++robot.heard.outdated;  // the map has it already
      return;
    }
    use_part(robot, part);
  } catch (const RefusedMessage& error) {
    refuse(robot, error.what());
  }
}

void MapListener::use_part(Robot& robot, const HeardPart& part) const {
  HeardRobot& heard = robot.heard;
  if (part.frame != heard.frame)
    return refuse(robot, fmt::format("an update in the frame {}, of a map in {}", part.frame, heard.frame));
  if (!callbacks_.part(heard.name, part)) return refuse(robot, "an update that reaches beyond its map");
  ++heard.parts;
}

void MapListener::refuse(Robot& robot, const std::string& why) const {
  HeardRobot& heard = robot.heard;
  if (heard.refused++ == 0)
    callbacks_.warn("refused " + heard.topic, fmt::format("{}: a message is refused: {}", heard.topic, why));
  heard.last_refusal = why;
}

}  // namespace gridmerge::internal
