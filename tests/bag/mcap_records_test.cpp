// SPDX-License-Identifier: Apache-2.0
// The contents of records, byte by byte.
#include "bag/mcap_records.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "bag/bag_builder.hpp"
#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {
namespace {

using namespace internal;
using test::mcap_number;
using test::mcap_text;

// Numbers whose bytes all differ.
constexpr std::uint64_t kTwo = 0x8102, kFour = 0x91A2B3C4, kEight = 0xF1E2D3C4B5A69788;

// All of a content is needed, and what comes behind it is not looked at.
template <typename Parse>
void expect_all_needed(const std::string& content, const Parse& parse) {
  EXPECT_NO_THROW(parse(content + "more"));
  for (std::size_t length = 0; length < content.size(); ++length)
    EXPECT_EQ(test::message_of<ParseError>([&] { parse(std::string_view(content).substr(0, length)); }),
              "a record ends early")
        << length;
}

TEST(McapRecords, AHeadIsAKindAndALength) {
  const std::string bytes("\x05\x88\x97\xa6\xb5\xc4\xd3\xe2\xf1", 9);
  EXPECT_EQ(bytes.size(), kRecordHeadBytes);
  const RecordHead head = parse_record_head(bytes);
  EXPECT_EQ(head.kind, McapRecord::message);
  EXPECT_EQ(head.bytes, kEight);
  expect_all_needed(bytes, parse_record_head);
}

TEST(McapRecords, SchemasAndChannelsHaveTheirFields) {
  const std::string schema = mcap_number(kTwo, 2) + mcap_text("a/msg/B");
  EXPECT_EQ(parse_schema(schema).id, kTwo);
  EXPECT_EQ(parse_schema(schema).name, "a/msg/B");
  EXPECT_EQ(parse_schema(mcap_number(1, 2) + mcap_text("")).name, "");
  expect_all_needed(schema, parse_schema);
  const std::string channel =
      mcap_number(kTwo, 2) + mcap_number(0x0304, 2) + mcap_text("/map") + mcap_text("cdr");
  EXPECT_EQ(parse_channel(channel).id, kTwo);
  EXPECT_EQ(parse_channel(channel).schema, 0x0304);
  EXPECT_EQ(parse_channel(channel).topic, "/map");
  EXPECT_EQ(parse_channel(channel).encoding, "cdr");
  expect_all_needed(channel, parse_channel);
}

TEST(McapRecords, AMessageHasTheTimeAtWhichItWasRecorded) {
  const std::string content = mcap_number(kTwo, 2) + mcap_number(kFour, 4) +
                              mcap_number(0x0102030405060708, 8) + mcap_number(kEight, 8);
  EXPECT_EQ(content.size(), kMessageHeadBytes);
  EXPECT_EQ(parse_message_head(content).channel, kTwo);
  EXPECT_EQ(parse_message_head(content).time, 0x0102030405060708);
  EXPECT_EQ(parse_message_head(std::string(22, '\xff')).time, -1);
  expect_all_needed(content, parse_message_head);
}

TEST(McapRecords, AChunkTellsItsSizesAndHowItIsPacked) {
  const std::string content = mcap_number(1, 8) + mcap_number(2, 8) + mcap_number(kEight, 8) +
                              mcap_number(kFour, 4) + mcap_text("zstd") + mcap_number(0x1112131415161718, 8);
  const McapChunkHead head = parse_chunk_head(content + "records");
  EXPECT_EQ(head.unpacked_bytes, kEight);
  EXPECT_EQ(head.crc, kFour);
  EXPECT_EQ(head.compression, "zstd");
  EXPECT_EQ(head.packed_bytes, 0x1112131415161718U);
  EXPECT_EQ(head.head_bytes, content.size());
  expect_all_needed(content, parse_chunk_head);
}

TEST(McapRecords, StatisticsCountTheMessagesOfEachChannel) {
  const std::string begin = mcap_number(kEight, 8) + mcap_number(kTwo, 2) + mcap_number(kFour, 4) +
                            mcap_number(5, 4) + mcap_number(6, 4) + mcap_number(7, 4) + mcap_number(8, 8) +
                            mcap_number(9, 8);
  const std::string counts =
      mcap_number(kTwo, 2) + mcap_number(kEight, 8) + mcap_number(3, 2) + mcap_number(4, 8);
  const McapStatistics statistics = parse_statistics(begin + mcap_text(counts));
  EXPECT_EQ(statistics.messages, kEight);
  EXPECT_EQ(statistics.channels, kFour);
  EXPECT_EQ(statistics.channel_messages, (std::map<std::uint16_t, std::uint64_t>{{3, 4}, {kTwo, kEight}}));
  expect_all_needed(begin + mcap_text(counts), parse_statistics);
  EXPECT_TRUE(parse_statistics(begin + mcap_text("")).channel_messages.empty());
  for (const std::size_t length : {1U, 2U, 9U, 11U, 19U})
    EXPECT_EQ(test::message_of<ParseError>([&] {
                parse_statistics(begin + mcap_text(counts.substr(0, length)) + std::string(20, 'x'));
              }),
              "a record ends early");
}

TEST(McapRecords, AFooterTellsWhereTheSummaryIs) {
  const std::string content = mcap_number(kEight, 8) + mcap_number(1, 8) + mcap_number(kFour, 4);
  EXPECT_EQ(content.size(), kFooterBytes);
  EXPECT_EQ(parse_footer(content).summary_begin, kEight);
  EXPECT_EQ(parse_footer(content).crc, kFour);
  expect_all_needed(content, parse_footer);
}

TEST(McapRecords, AnIndexTellsWhetherItListsMessages) {
  const std::string content = mcap_number(kTwo, 2) + mcap_number(1, 4);
  EXPECT_EQ(parse_index_head(content).channel, kTwo);
  EXPECT_TRUE(parse_index_head(content).lists_messages);
  EXPECT_TRUE(parse_index_head(mcap_number(kTwo, 2) + mcap_number(0x80000000, 4)).lists_messages);
  EXPECT_FALSE(parse_index_head(mcap_number(kTwo, 2) + mcap_number(0, 4)).lists_messages);
  expect_all_needed(content, parse_index_head);
}

}  // namespace
}  // namespace gridmerge
