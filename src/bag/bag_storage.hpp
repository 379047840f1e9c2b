// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gridmerge/bag/bag.hpp"

namespace gridmerge::internal {

/// Where a file has a message. What the places mean is the file's own.
struct StoredMessage {
  std::int64_t time = 0;     ///< when it was recorded [ns]
  std::size_t topic = 0;     ///< index of those that find() was asked for
  std::uint64_t place = 0;   ///< of what holds it
  std::uint64_t offset = 0;  ///< in there
  std::uint64_t bytes = 0;   ///< of the message
};

/// A file of recorded messages. What it throws names the file (FileError).
class BagStorage {
 public:
  BagStorage() = default;
  virtual ~BagStorage() = default;
  BagStorage(const BagStorage&) = delete;
  BagStorage& operator=(const BagStorage&) = delete;

  /// The topics in order of their names; a name that stands for several types has a topic of each.
  virtual const std::vector<BagTopic>& topics() const = 0;

  /// The messages of these topics, named by name and type, in the file's order. O(bytes of what may hold
  /// them).
  virtual std::vector<StoredMessage> find(const std::vector<BagTopic>& topics) = 0;

  /// Tells in which order messages that find() found are going to be read, so that none is costly.
  virtual void expect(const std::vector<StoredMessage>& /*order*/) {}

  /// The bytes of a message that find() found. Cheap in the order of find() and in one that is expected.
  virtual std::string read(const StoredMessage& message) = 0;

  /// What is odd about the file.
  virtual std::vector<MapWarning> warnings() const { return {}; }
};

/// More messages of one topic are no recording of maps: they would fill the memory with their places.
inline constexpr std::size_t kMaxMessages = std::size_t{1} << 22;

/// A message of a map has so many bytes beside those of its cells, at most: names of frames are short.
inline constexpr std::size_t kMaxMessageRest = std::size_t{1} << 20;

/// The message itself, which rosbag2 may have packed by itself. Throws ParseError for one that does not
/// unpack, or to more than `max_bytes`.
std::string unpacked_message(std::string message, std::size_t max_bytes);

}  // namespace gridmerge::internal
