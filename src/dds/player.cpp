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

/// The topic's namespace and the frame: "tb1/map" of "/tb1/map" and "map".
std::string own_frame(const std::string& topic, const std::string& frame) {
  const std::size_t last = topic.rfind('/');
  return last == 0 ? topic.substr(1) + "/" + frame : topic.substr(1, last) + frame;
}

}  // namespace

Player::Player(const Participant& participant, std::vector<PlayedTopic> topics, double rate) : rate_(rate) {
  std::map<std::string, int> frames;
  for (PlayedTopic& played : topics) {
    Topic& topic = topics_.emplace_back();
    topic.played = std::move(played);
    topic.next = topic.played.next();
    if (!topic.next) throw std::runtime_error(fmt::format("{}: has no map", topic.played.source));
    topic.begin = topic.next->seconds;
    topic.frame = topic.next->frame;
    ++frames[topic.frame];
  }
  for (Topic& topic : topics_) {
    if (frames[topic.frame] > 1) topic.frame = own_frame(topic.played.topic, topic.frame);
    topic.writer =
        make_writer(participant.get(), kMapType, dds_topic(topic.played.topic), {true, true, 1}, kPlayedMark);
  }
}

void Player::advance(Topic& topic, double seconds) const {
  while (topic.next && topic.next->seconds - topic.begin <= seconds * rate_) {
    throw_if_cancelled();
    topic.due = std::move(topic.next);
    topic.next = topic.played.next();
  }
}

void Player::play(double seconds) {
  for (Topic& topic : topics_) {
    advance(topic, seconds);
    if (topic.due && write_map(topic.writer, topic.due->grid, topic.frame, now())) topic.due.reset();
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
