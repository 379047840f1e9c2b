// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bag/bag_storage.hpp"
#include "bag/scratch_file.hpp"

namespace gridmerge::internal {

/// Chunks whose messages are read in another order than they stand in. A chunk is unpacked from its beginning
/// on, so each step back would unpack it anew: the square of its length. So their messages are kept once
/// unpacked, in a file without a name.
class ScatteredChunks {
 public:
  /// More than that is not kept: whoever sent the bag might want the disk full.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30;

  /// Of a file that messages name `shown`.
  explicit ScatteredChunks(std::filesystem::path shown, std::uint64_t max_bytes = kMaxBytes)
      : shown_(std::move(shown)), max_bytes_(max_bytes) {}

  /// Tells in which order messages are going to be read. Those of more than `max_message_bytes` never are.
  /// O(n log(n)).
  void expect(const std::vector<StoredMessage>& order, std::size_t max_message_bytes);

  /// A message, if its chunk is such a one. Of a chunk that was not unpacked yet, `unpack` gives the bytes of
  /// each message that it is called for, in the order in which they stand. Throws what it throws, ParseError
  /// where too much would be kept, and FileError.
  using Unpack = std::function<std::string(const StoredMessage&)>;
  std::optional<std::string> read(const StoredMessage& message, const Unpack& unpack);

 private:
  struct Chunk {
    std::vector<StoredMessage> wanted;              // which were not unpacked yet
    std::map<std::uint64_t, std::uint64_t> places;  // of the others in the file, by their offsets
  };

  void keep(Chunk& chunk, const Unpack& unpack);

  std::filesystem::path shown_;
  std::uint64_t max_bytes_;
  std::map<std::uint64_t, Chunk> chunks_;  // by their places
  std::optional<ScratchFile> file_;
};

}  // namespace gridmerge::internal
