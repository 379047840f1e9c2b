// SPDX-License-Identifier: Apache-2.0
#include "bag/scattered_chunks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

// How often reading in this order comes back to an earlier place of a chunk, for each chunk by its place.
std::map<std::uint64_t, std::size_t> count_returns(const std::vector<StoredMessage>& order) {
  std::map<std::uint64_t, std::size_t> returns;
  const StoredMessage* before = nullptr;
  for (const StoredMessage& message : order) {
    if (message.place == 0) continue;  // is in no chunk
    const bool goes_on =
        before != nullptr && before->place == message.place && before->offset < message.offset;
    if (!goes_on) {
      const auto [chunk, is_new] = returns.emplace(message.place, 0);
      if (!is_new) ++chunk->second;
    }
    before = &message;
  }
  return returns;
}

}  // namespace

void ScatteredChunks::expect(const std::vector<StoredMessage>& order, std::size_t max_message_bytes) {
  // A few steps back cost less than what is kept: publishers' clocks differ a little.
  constexpr std::size_t kMaxReturns = 8;
  const std::map<std::uint64_t, std::size_t> returns = count_returns(order);
  const bool are_any =
      std::ranges::any_of(returns, [](const auto& chunk) { return chunk.second > kMaxReturns; });
  if (!are_any) return;
  for (const StoredMessage& message : order) {
    const auto found = returns.find(message.place);
    if (found != returns.end() && found->second > kMaxReturns && message.bytes <= max_message_bytes)
      chunks_[message.place].wanted.push_back(message);
  }
}

std::optional<std::string> ScatteredChunks::read(const StoredMessage& message, const Unpack& unpack) {
  const auto chunk = chunks_.find(message.place);
  if (chunk == chunks_.end()) return std::nullopt;
  if (!chunk->second.places.contains(message.offset)) keep(chunk->second, unpack);
  const auto kept = chunk->second.places.find(message.offset);
  if (kept == chunk->second.places.end()) return std::nullopt;
  return file_->read(kept->second, static_cast<std::size_t>(message.bytes));
}

void ScatteredChunks::keep(Chunk& chunk, const Unpack& unpack) {
  std::ranges::sort(chunk.wanted, {}, &StoredMessage::offset);
  for (const StoredMessage& message : chunk.wanted) {
    if (chunk.places.contains(message.offset)) continue;
    if (!file_) file_.emplace(shown_);
    if (message.bytes > max_bytes_ - file_->size())
      throw ParseError(
          fmt::format("its messages are out of the order of their times, and more than {} bytes of "
                      "them would have to be kept",
                      max_bytes_));
    const std::uint64_t place = file_->size();
    file_->append(unpack(message));
    chunk.places.emplace(message.offset, place);
  }
  chunk.wanted.clear();
}

}  // namespace gridmerge::internal
