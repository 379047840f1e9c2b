// SPDX-License-Identifier: Apache-2.0
#include "dds/player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "dds/names.hpp"
#include "dds/samples.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

// Longer than robots are silent that map; a clock that is set when a robot is online jumps by decades.
constexpr double kLongestGap = 600.0;  // [s of the recording]
constexpr double kInsteadOfIt = 1.0;

/// The topic's namespace and the frame: "tb1/map" of "/tb1/map" and "map".
std::string own_frame(const std::string& topic, const std::string& frame) {
  const std::size_t last = topic.rfind('/');
  return last == 0 ? topic.substr(1) + "/" + frame : topic.substr(1, last) + frame;
}

}  // namespace

Player::Player(const Participant& participant, std::vector<PlayedTopic> topics, double rate,
               std::function<void(const std::string&)> warn)
    : rate_(rate), warn_(std::move(warn)) {
  std::map<std::string, int> frames;
  std::map<std::string, std::size_t> recordings;
  for (PlayedTopic& played : topics) {
    Topic& topic = topics_.emplace_back();
    topic.played = std::move(played);
    topic.next = topic.played.next();
    if (!topic.next) throw std::runtime_error(fmt::format("{}: has no map", topic.played.source));
    ++frames[topic.next->frame];
    const std::string& name = topic.played.recording;
    const auto [known, is_new] = recordings.emplace(name, recordings_.size());
    if (is_new || name.empty()) {
      known->second = recordings_.size();
      recordings_.push_back({{}, topic.next->seconds, 0.0});
    }
    Recording& recording = recordings_[known->second];
    recording.topics.push_back(topics_.size() - 1);
    recording.begin = std::min(recording.begin, topic.next->seconds);
  }
  for (Topic& topic : topics_) topic.has_own_frames = frames[topic.next->frame] > 1;
  join(participant);
}

void Player::leave() {
  for (Topic& topic : topics_) topic.writer = {};
}

void Player::join(const Participant& participant) {
  for (Topic& topic : topics_) {
    topic.writer =
        make_writer(participant.get(), kMapType, dds_topic(topic.played.topic), {true, true, 1}, kPlayedMark);
    if (!topic.due) topic.due = std::exchange(topic.sent, std::nullopt);
  }
}

Player::Topic* Player::next_of(const Recording& recording) {
  Topic* first = nullptr;
  for (const std::size_t index : recording.topics) {
    Topic& topic = topics_[index];
    if (topic.next && (first == nullptr || topic.next->seconds < first->next->seconds)) first = &topic;
  }
  return first;
}

void Player::advance(Recording& recording, double seconds) {
  while (Topic* const topic = next_of(recording)) {
    throw_if_cancelled();
    const double gap = topic->next->seconds - recording.begin - recording.last;
    if (gap > kLongestGap) {
      warn_(
          fmt::format("{}: there is no map for {:.0f} s, which are passed over", topic->played.source, gap));
      recording.begin += gap - kInsteadOfIt;
    }
    const double due = topic->next->seconds - recording.begin;
    if (due > seconds * rate_) return;
    recording.last = std::max(recording.last, due);
    topic->due = std::move(topic->next);
    topic->next = topic->played.next();
  }
}

void Player::play(double seconds) {
  for (Recording& recording : recordings_) advance(recording, seconds);
  for (Topic& topic : topics_) {
    if (!topic.due) continue;
    const std::string& frame = topic.due->frame;
    const std::string written = topic.has_own_frames ? own_frame(topic.played.topic, frame) : frame;
    if (write_map(topic.writer, topic.due->grid, written, now()))
      topic.sent = std::exchange(topic.due, std::nullopt);
  }
}

bool Player::is_over() const {
  return std::all_of(topics_.begin(), topics_.end(),
                     [](const Topic& topic) { return !topic.due && !topic.next; });
}

std::vector<dds_guid_t> Player::writers() const {
  std::vector<dds_guid_t> guids;
  for (const Topic& topic : topics_) guids.push_back(guid_of(topic.writer.get()));
  return guids;
}

}  // namespace gridmerge::internal
