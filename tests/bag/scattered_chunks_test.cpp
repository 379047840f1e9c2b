// SPDX-License-Identifier: Apache-2.0
// Which chunks' messages are kept, and what they are then.
#include "bag/scattered_chunks.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {
namespace {

using namespace internal;
using Offsets = std::vector<std::uint64_t>;

StoredMessage message_at(std::uint64_t place, std::uint64_t offset, std::uint64_t bytes = 3) {
  return {0, 0, place, offset, bytes};
}

// A message's bytes tell where it stands.
std::string bytes_of(const StoredMessage& message) {
  std::string bytes;
  while (bytes.size() < message.bytes) bytes += std::to_string(message.place * 1000 + message.offset) + " ";
  return bytes.substr(0, static_cast<std::size_t>(message.bytes));
}

// Which of the messages were unpacked, in their order.
struct Unpacked {
  Offsets offsets;

  ScatteredChunks::Unpack call() {
    return [this](const StoredMessage& message) {
      offsets.push_back(message.offset);
      return bytes_of(message);
    };
  }
};

bool is_kept(const std::vector<StoredMessage>& order, std::uint64_t place) {
  ScatteredChunks chunks("a.mcap");
  chunks.expect(order, 100);
  Unpacked unpacked;
  for (const StoredMessage& message : order) {
    if (message.place == place) return chunks.read(message, unpacked.call()).has_value();
  }
  ADD_FAILURE() << "no message there";
  return false;
}

// Reading them in this order comes back so often.
std::vector<StoredMessage> with_returns(std::uint64_t place, std::uint64_t returns) {
  std::vector<StoredMessage> order;
  for (std::uint64_t i = 0; i <= returns; ++i) order.push_back(message_at(place, 1000 - i));
  return order;
}

TEST(ScatteredChunks, AChunkIsKeptFromTheNinthReturnOn) {
  EXPECT_FALSE(is_kept(with_returns(5, 0), 5));
  EXPECT_FALSE(is_kept(with_returns(5, 8), 5));
  EXPECT_TRUE(is_kept(with_returns(5, 9), 5));
  EXPECT_TRUE(is_kept(with_returns(5, 30), 5));
}

TEST(ScatteredChunks, MessagesInTheirOrderAreNotKept) {
  std::vector<StoredMessage> order;
  for (std::uint64_t i = 0; i < 50; ++i) order.push_back(message_at(5, i));
  for (std::uint64_t i = 0; i < 50; ++i) order.push_back(message_at(6, i));
  EXPECT_FALSE(is_kept(order, 5));
  EXPECT_FALSE(is_kept(order, 6));
}

TEST(ScatteredChunks, MessagesInNoChunkAreNoStep) {
  std::vector<StoredMessage> order;
  for (std::uint64_t i = 0; i < 50; ++i) {
    order.push_back(message_at(5, i));
    order.push_back(message_at(0, 1000 - i));
  }
  EXPECT_FALSE(is_kept(order, 5));
  EXPECT_FALSE(is_kept(order, 0));
}

TEST(ScatteredChunks, ChunksThatAreReadInTurnsAreKept) {
  std::vector<StoredMessage> order;
  for (std::uint64_t i = 0; i < 9; ++i) {
    order.push_back(message_at(5, i));
    order.push_back(message_at(6, i));
  }
  EXPECT_FALSE(is_kept(order, 5));
  EXPECT_FALSE(is_kept(order, 6));
  order.push_back(message_at(5, 9));
  EXPECT_TRUE(is_kept(order, 5)) << "the tenth time, which is the ninth return";
  EXPECT_FALSE(is_kept(order, 6));
}

TEST(ScatteredChunks, TheSamePlaceAgainIsAReturn) {
  EXPECT_FALSE(is_kept(std::vector<StoredMessage>(9, message_at(5, 7)), 5));
  EXPECT_TRUE(is_kept(std::vector<StoredMessage>(10, message_at(5, 7)), 5));
}

TEST(ScatteredChunks, EachMessageIsUnpackedOnceInTheOrderInWhichTheyStand) {
  ScatteredChunks chunks("a.mcap");
  std::vector<StoredMessage> order;
  Offsets forwards;
  for (std::uint64_t i = 0; i < 12; ++i) {
    order.push_back(message_at(5, 20 - i, 1 + i % 4));
    forwards.push_back(9 + i);
  }
  order.push_back(order.front());
  chunks.expect(order, 100);
  Unpacked unpacked;
  EXPECT_TRUE(unpacked.offsets.empty());
  for (const StoredMessage& message : order)
    EXPECT_EQ(chunks.read(message, unpacked.call()), bytes_of(message));
  for (const StoredMessage& message : order)
    EXPECT_EQ(chunks.read(message, unpacked.call()), bytes_of(message));
  EXPECT_EQ(unpacked.offsets, forwards);
}

TEST(ScatteredChunks, OnlyTheChunkThatIsAskedForIsUnpacked) {
  ScatteredChunks chunks("a.mcap");
  std::vector<StoredMessage> order = with_returns(5, 9);
  for (const StoredMessage& message : with_returns(6, 10)) order.push_back(message);
  for (const StoredMessage& message : with_returns(7, 2)) order.push_back(message);
  chunks.expect(order, 100);
  Unpacked unpacked;
  EXPECT_FALSE(chunks.read(message_at(7, 1000), unpacked.call()));
  EXPECT_FALSE(chunks.read(message_at(8, 1000), unpacked.call()));
  EXPECT_TRUE(unpacked.offsets.empty());
  EXPECT_EQ(chunks.read(message_at(5, 1000), unpacked.call()), bytes_of(message_at(5, 1000)));
  EXPECT_EQ(unpacked.offsets.size(), 10u);
  EXPECT_EQ(chunks.read(message_at(6, 995), unpacked.call()), bytes_of(message_at(6, 995)));
  EXPECT_EQ(unpacked.offsets.size(), 21u);
  EXPECT_EQ(chunks.read(message_at(5, 991), unpacked.call()), bytes_of(message_at(5, 991)));
  EXPECT_EQ(unpacked.offsets.size(), 21u);
  EXPECT_FALSE(chunks.read(message_at(5, 500), unpacked.call())) << "which was not expected";
  EXPECT_EQ(unpacked.offsets.size(), 21u);
}

TEST(ScatteredChunks, MessagesThatAreNeverReadAreNotKept) {
  ScatteredChunks chunks("a.mcap");
  std::vector<StoredMessage> order = with_returns(5, 9);
  order[3].bytes = 100;
  order[4].bytes = 101;
  chunks.expect(order, 100);
  Unpacked unpacked;
  EXPECT_FALSE(chunks.read(order[4], unpacked.call()));
  EXPECT_EQ(unpacked.offsets.size(), 9u);
  EXPECT_EQ(chunks.read(order[3], unpacked.call()), bytes_of(order[3]));
}

TEST(ScatteredChunks, SoMuchIsKeptOfAllChunks) {
  std::vector<StoredMessage> order = with_returns(5, 9);
  for (const StoredMessage& message : with_returns(6, 9)) order.push_back(message);
  ScatteredChunks enough("a.mcap", 60), few("a.mcap", 59);
  enough.expect(order, 100);
  few.expect(order, 100);
  Unpacked unpacked;
  EXPECT_TRUE(enough.read(message_at(5, 1000), unpacked.call()));
  EXPECT_TRUE(enough.read(message_at(6, 1000), unpacked.call()));
  EXPECT_TRUE(few.read(message_at(5, 1000), unpacked.call()));
  EXPECT_EQ(
      test::message_of<ParseError>([&] { few.read(message_at(6, 1000), unpacked.call()); }),
      "its messages are out of the order of their times, and more than 59 bytes of them would have to be "
      "kept");
}

}  // namespace
}  // namespace gridmerge
