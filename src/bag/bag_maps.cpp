// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "bag/bag_content.hpp"
#include "bag/growing_map.hpp"
#include "bag/map_messages.hpp"
#include "gridmerge/bag/bag.hpp"
#include "io/parse_error.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::size_t kMap = 0;  // of the topics that are asked for: the map's, then that of its updates

// What there is instead, as far as a line may hold it.
std::string list_topics(const std::vector<BagTopic>& topics, bool with_types) {
  constexpr std::size_t kMax = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(topics.size(), kMax); ++i) {
    text += (i == 0 ? "" : ", ") + topics[i].name;
    if (with_types) text += fmt::format(" ({})", topics[i].type);
  }
  if (topics.size() > kMax) text += fmt::format(" and {} more", topics.size() - kMax);
  return text;
}

BagTopic choose_topic(const Bag& bag, const std::string& name, const std::vector<MapWarning>& warnings) {
  const std::vector<BagTopic> maps = bag.map_topics();
  if (!name.empty()) {
    for (const BagTopic& topic : bag.topics()) {
      if (is_map_type(topic.type) && (topic.name == name || topic.name == "/" + name)) return topic;
    }
  }
  if (maps.empty()) {
    if (bag.topics().empty())
      throw FileError(bag.path(), "has no topics, and so no maps" +
                                      (warnings.empty() ? std::string() : ": " + warnings.front().text));
    throw FileError(bag.path(), "has no maps (messages of nav_msgs/msg/OccupancyGrid); its topics are " +
                                    list_topics(bag.topics(), true));
  }
  if (name.empty()) {
    if (maps.size() == 1) return maps.front();
    throw FileError(bag.path(),
                    fmt::format("has {} topics of maps: add #TOPIC to its name to choose one of {}",
                                maps.size(), list_topics(maps, false)));
  }
  throw FileError(bag.path(), fmt::format("has no maps on the topic '{}'; its topics of maps are {}", name,
                                          list_topics(maps, false)));
}

// The topic, and the one on which parts of its maps are sent, if there is one.
std::vector<BagTopic> with_updates(const Bag& bag, const BagTopic& map) {
  std::vector<BagTopic> topics{map};
  for (const BagTopic& topic : bag.topics()) {
    if (topic.name == map.name + "_updates" && is_update_type(topic.type)) topics.push_back(topic);
  }
  return topics;
}

}  // namespace

struct BagMaps::State {
  std::shared_ptr<BagContent> content;
  std::string topic;
  std::vector<BagContent::Message> messages;
  std::size_t next = 0;
  GrowingMap growing;

  bool take(GrowingMap& into, const BagContent::Message& message) const {
    const std::string bytes = content->read(message);
    try {
      return message.stored.topic == kMap ? into.take_map(bytes) : into.take_update(bytes);
    } catch (const ParseError& error) {
      throw FileError(content->path(),
                      fmt::format("a message of {}{} is damaged: {}", topic,
                                  message.stored.topic == kMap ? "" : "_updates", error.what()));
    } catch (const std::bad_alloc&) {
      throw FileError(content->path(), "the map needs more memory than there is");
    }
  }

  // The place of the last whole map that has cells; `map` is that one then. Messages are read forwards, as
  // chunks are unpacked, in blocks of 1, 2, 4 whole maps and so on from the end.
  std::optional<std::size_t> find_last_whole(GrowingMap& map) const {
    std::vector<std::size_t> whole;
    for (std::size_t i = 0; i < messages.size(); ++i) {
      if (messages[i].stored.topic == kMap) whole.push_back(i);
    }
    std::size_t end = whole.size();
    for (std::size_t size = 1; end > 0; size *= 2) {
      const std::size_t begin = end - std::min(size, end);
      std::optional<std::size_t> last;
      std::exception_ptr damage;  // of what may be the last one
      for (std::size_t i = begin; i < end; ++i) {
        try {
          if (!take(map, messages[whole[i]])) continue;
          last = whole[i];
          damage = nullptr;
        } catch (const FileError&) {
          damage = std::current_exception();
        }
      }
      if (damage) std::rethrow_exception(damage);
      if (last) return last;
      end = begin;
    }
    return std::nullopt;
  }

  BagMap describe(const GrowingMap& grown, const BagContent::Message& message) const {
    BagMap map{grown.grid(), grown.frame_id(), message.stored.time, message.stored.topic != kMap,
               content->warnings()};
    for (MapWarning& warning : grown.warnings(map.grid)) map.warnings.push_back(std::move(warning));
    return map;
  }
};

BagMaps::BagMaps(const Bag& bag, const std::string& topic) {
  const BagTopic chosen = choose_topic(bag, topic, bag.content_->warnings());
  const std::vector<BagTopic> topics = with_updates(bag, chosen);
  for (const BagTopic& one : topics) {
    if (one.encoding != "cdr")
      throw FileError(bag.path(), fmt::format("{} has messages in the encoding '{}'; those in 'cdr' are read",
                                              one.name, one.encoding));
  }
  state_ = std::make_unique<State>(
      State{bag.content_, chosen.name, bag.content_->find(topics), 0, GrowingMap(bag.content_->max_cells())});
}

BagMaps::~BagMaps() = default;
BagMaps::BagMaps(BagMaps&&) noexcept = default;
BagMaps& BagMaps::operator=(BagMaps&&) noexcept = default;

const std::string& BagMaps::topic() const {
  static const std::string none;
  return state_ ? state_->topic : none;
}

std::size_t BagMaps::messages() const {
  return state_ ? state_->messages.size() : 0;
}

std::size_t BagMaps::updates() const {
  if (!state_) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(
      state_->messages, [](const BagContent::Message& message) { return message.stored.topic != kMap; }));
}

std::optional<BagMap> BagMaps::next() {
  if (!state_) return std::nullopt;
  State& state = *state_;
  while (state.next < state.messages.size()) {
    const BagContent::Message& message = state.messages[state.next++];
    if (state.take(state.growing, message)) return state.describe(state.growing, message);
  }
  return std::nullopt;
}

BagMap BagMaps::last() {
  if (!state_) throw EmptyTopic("the maps of the topic were moved elsewhere");
  const State& state = *state_;
  GrowingMap map(state.content->max_cells());
  const std::optional<std::size_t> begin = state.find_last_whole(map);
  if (!begin)
    throw EmptyTopic(state.content->path(), state.messages.empty()
                                                ? fmt::format("has no message on {}", state.topic)
                                                : fmt::format("has no map with cells on {}", state.topic));
  std::size_t newest = *begin;
  for (std::size_t i = *begin + 1; i < state.messages.size(); ++i) {
    if (state.messages[i].stored.topic != kMap && state.take(map, state.messages[i])) newest = i;
  }
  return state.describe(map, state.messages[newest]);
}

}  // namespace gridmerge
