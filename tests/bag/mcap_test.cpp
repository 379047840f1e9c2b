// SPDX-License-Identifier: Apache-2.0
// MCAP files, whole and damaged.
#include "bag/mcap.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "bag/map_messages.hpp"
#include "bag/support.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/parse_error.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using internal::StoredMessage;
using test::all_cells;
using test::cells_of;
using test::contains;
using test::kMcapMagic;
using test::mcap_file;
using test::mcap_number;
using test::mcap_record;
using test::mcap_with_chunk;
using test::McapStyle;
using test::Recorded;
using test::row_at;
using Rows = std::vector<std::vector<Cell>>;

rc::Gen<std::vector<std::int8_t>> any_row() {
  return rc::gen::suchThat(
      rc::gen::container<std::vector<std::int8_t>>(rc::gen::inRange<std::int8_t>(-1, 101)),
      [](const std::vector<std::int8_t>& row) { return !row.empty(); });
}

rc::Gen<std::vector<Recorded>> any_recording() {
  return rc::gen::container<std::vector<Recorded>>(rc::gen::exec([] {
    const std::string topic = *rc::gen::element<std::string>("/map", "/tb2/map", "/chatter");
    const std::int64_t time = *rc::gen::inRange(0, 20);
    if (topic == "/chatter")
      return Recorded{topic, time, *rc::gen::arbitrary<std::string>(), "std_msgs/msg/String", "cdr"};
    return row_at(time, *any_row(), topic);
  }));
}

rc::Gen<McapStyle> any_style() {
  return rc::gen::exec([] {
    McapStyle style;
    style.compression = *rc::gen::element<std::string>("", "lz4", "zstd");
    style.messages_a_chunk = *rc::gen::inRange<std::size_t>(0, 4);
    style.has_index = *rc::gen::arbitrary<bool>();
    style.has_summary = *rc::gen::arbitrary<bool>();
    style.has_crc = *rc::gen::arbitrary<bool>();
    style.has_end = *rc::gen::arbitrary<bool>();
    style.has_extras = *rc::gen::arbitrary<bool>();
    return style;
  });
}

// What a reader has to make of a recording.
Rows rows_of(std::vector<Recorded> messages, const std::string& topic) {
  std::ranges::stable_sort(messages, {}, &Recorded::time);
  Rows rows;
  for (const Recorded& message : messages) {
    if (message.topic != topic) continue;
    const std::vector<std::int8_t> values = internal::parse_map_message(message.bytes, 1000).values;
    rows.push_back(cells_of(values));
  }
  return rows;
}

RC_GTEST_PROP(Mcap, WhatIsWrittenIsRead, ()) {
  const std::vector<Recorded> messages = *any_recording();
  const McapStyle style = *any_style();
  const test::TemporaryDirectory directory;
  const Bag bag(directory.write("a.mcap", mcap_file(messages, style)));
  for (const char* topic : {"/map", "/tb2/map"}) {
    const Rows expected = rows_of(messages, topic);
    const auto found = std::ranges::find(bag.topics(), topic, &BagTopic::name);
    RC_ASSERT((found == bag.topics().end()) == expected.empty());
    if (expected.empty()) continue;
    RC_ASSERT(found->messages == expected.size());
    RC_ASSERT(all_cells(bag, topic) == expected);
    RC_ASSERT(BagMaps(bag, topic).last().grid.cells == expected.back());
  }
}

// A recorder that is killed leaves such a file. What is read of it was written.
RC_GTEST_PROP(Mcap, OfAFileCutShortTheBeginningIsRead, ()) {
  std::vector<Recorded> messages;
  for (int i = 0; i < 6; ++i) messages.push_back(row_at(i, *any_row()));
  McapStyle style = *any_style();
  const std::string whole = mcap_file(messages, style);
  const auto length = *rc::gen::inRange<std::size_t>(kMcapMagic.size(), whole.size());
  const test::TemporaryDirectory directory;
  const Bag bag(directory.write("a.mcap", whole.substr(0, length)));
  if (bag.map_topics().empty()) return;
  const Rows expected = rows_of(messages, "/map");
  BagMaps maps(bag);
  std::size_t count = 0;
  while (const auto map = maps.next()) {
    RC_ASSERT(count < expected.size() && map->grid.cells == expected[count]);
    RC_ASSERT(map->warnings.front().kind == MapWarningKind::cut_off);
    ++count;
  }
}

// The last chunk is whole, and some of its indexes are not there: of which topics it holds nothing can be
// told.
RC_GTEST_PROP(Mcap, OfAFileCutShortAmongIndexesTheLastChunkIsRead, ()) {
  std::vector<Recorded> messages;
  for (int i = 0; i < 6; ++i)
    messages.push_back(row_at(i, *any_row(), i % 3 == 0 ? "/map" : i % 3 == 1 ? "/tb2/map" : "/tb3/map"));
  McapStyle style = *any_style();
  style.messages_a_chunk = *rc::gen::element<std::size_t>(3, 6);
  style.has_index = true;
  style.has_end = false;
  const std::string whole = mcap_file(messages, style);
  constexpr std::size_t kIndexes = 3 * (9 + 2 + 4 + 16);
  const auto lost = *rc::gen::inRange<std::size_t>(0, kIndexes + 1);
  const test::TemporaryDirectory directory;
  const Bag bag(directory.write("a.mcap", whole.substr(0, whole.size() - lost)));
  for (const char* topic : {"/map", "/tb2/map", "/tb3/map"})
    RC_ASSERT(all_cells(bag, topic) == rows_of(messages, topic));
}

RC_GTEST_PROP(Mcap, DamageIsAnErrorOrHarmless, ()) {
  std::vector<Recorded> messages;
  for (int i = 0; i < 4; ++i) messages.push_back(row_at(i, *any_row()));
  std::string file = mcap_file(messages, *any_style());
  for (int changes = *rc::gen::inRange(1, 4); changes > 0; --changes)
    file[*rc::gen::inRange<std::size_t>(0, file.size())] = *rc::gen::arbitrary<char>();
  const test::TemporaryDirectory directory;
  const std::string path = directory.write("a.mcap", file);
  try {
    const Bag bag(path, {.max_cells = 10'000});
    for (const BagTopic& topic : bag.map_topics()) all_cells(bag, topic.name);
  } catch (const FileError& error) {
    RC_ASSERT(std::string(error.what()).starts_with(path));
  }
}

class McapFileTest : public testing::Test {
 protected:
  std::string error_of(const std::string& file) {
    const std::string path = directory_.write("a.mcap", file);
    const std::string message = test::message_of<FileError>([&] {
      const Bag bag(path);
      BagMaps(bag).last();
    });
    EXPECT_TRUE(message.starts_with(path + ": ")) << message;
    return message;
  }

  const std::vector<Recorded> messages_{row_at(1, {0, 100, 100}), row_at(2, {100, 0, 0})};
  const test::TemporaryDirectory directory_;
};

TEST_F(McapFileTest, AWrongChecksumIsRefused) {
  for (const char* compression : {"", "lz4", "zstd"}) {
    std::string file = mcap_file(messages_, {.compression = compression, .has_end = false});
    const std::size_t begin = file.find('\x06', kMcapMagic.size() + 9);  // the chunk, behind the header
    file[begin + 9 + 24] ^= 1;                                           // its checksum
    EXPECT_TRUE(contains(error_of(file), "a chunk's checksum is wrong")) << compression;
  }
  std::string plain = mcap_file(messages_);
  const std::size_t cells = plain.find(std::string("\x00\x64\x64", 3));
  ASSERT_NE(cells, std::string::npos);
  plain[cells] = 100;
  EXPECT_TRUE(contains(error_of(plain), "a chunk's checksum is wrong"));
}

TEST_F(McapFileTest, ASummaryWithAWrongChecksumIsRefused) {
  std::string file = mcap_file(messages_);
  const std::size_t name = file.rfind("/map");
  ASSERT_NE(name, std::string::npos);
  file[name + 1] = 'M';
  EXPECT_TRUE(contains(error_of(file), "the summary's checksum is wrong"));
}

TEST_F(McapFileTest, ASummaryThatTellsTooLittleIsNotRelyedOn) {
  // Its counts do not add up: then the records are counted.
  std::string file = mcap_file(messages_, {.has_crc = false});
  const std::string count_of_channel = mcap_number(1, 2) + mcap_number(2, 8);
  const std::size_t place = file.rfind(count_of_channel);
  ASSERT_NE(place, std::string::npos);
  file.replace(place + 2, 8, mcap_number(7, 8));
  const Bag bag(directory_.write("a.mcap", file));
  EXPECT_EQ(bag.topics().at(0).messages, 2u);
}

TEST_F(McapFileTest, AChunkIsHeldToWhatItSays) {
  const std::string records = mcap_record(0x99, "some bytes");
  EXPECT_TRUE(contains(error_of(mcap_with_chunk(test::mcap_chunk(records, "lz4", false, records.size() - 1))),
                       "reaches beyond its chunk"));
  EXPECT_TRUE(
      contains(error_of(mcap_with_chunk(test::mcap_chunk(records + records, "zstd", false, records.size()))),
               "unpacks to more than it says"));
  EXPECT_TRUE(
      contains(error_of(mcap_with_chunk(test::mcap_chunk(records, "zstd", false, records.size() + 9))),
               "unpacks to less than it says"));
  EXPECT_TRUE(contains(error_of(mcap_with_chunk(test::mcap_chunk(records, "gzip"))), "packed by 'gzip'"));
  std::string reaching = test::mcap_chunk(records, "");
  reaching.pop_back();
  EXPECT_TRUE(contains(error_of(mcap_with_chunk(reaching)), "reach beyond the chunk"));
}

TEST_F(McapFileTest, AChunkBombIsReadInAStream) {
  // An unknown record of 64 MiB: nobody keeps it.
  const std::size_t bytes = std::size_t{1} << 26;
  std::string packed;
  {
    std::string records = mcap_number(0x99, 1) + mcap_number(bytes, 8);
    records.resize(records.size() + bytes);
    packed = test::mcap_chunk(records, "zstd", false);
  }
  EXPECT_LT(packed.size(), 100'000u);
  EXPECT_TRUE(contains(error_of(mcap_with_chunk(packed)), "has no topics"));
  std::string claims = test::mcap_chunk("", "zstd", false, std::uint64_t{1} << 60);
  EXPECT_TRUE(contains(error_of(mcap_with_chunk(claims)), "claims to unpack to 1152921504606846976 bytes"));
}

TEST_F(McapFileTest, RecordsReachNotBeyondTheFile) {
  std::string file = mcap_file(messages_, {.has_summary = false, .has_crc = false});
  const std::size_t begin = file.find('\x06', kMcapMagic.size() + 9);
  file.replace(begin + 1, 8, mcap_number(std::uint64_t{1} << 63, 8));
  EXPECT_TRUE(contains(error_of(file), "reaches beyond the file"));
}

TEST_F(McapFileTest, AFooterNamesAPlaceOfTheFile) {
  std::string file = mcap_file(messages_, {.has_crc = false});
  file.replace(file.size() - 8 - 20, 8, mcap_number(std::uint64_t{1} << 62, 8));
  EXPECT_TRUE(contains(error_of(file), "the footer names no place of the file"));
}

TEST_F(McapFileTest, ShortMessagesAreNone) {
  const std::string file = std::string(kMcapMagic) + mcap_record(5, "short");
  EXPECT_TRUE(contains(error_of(file), "a record ends early"));
}

TEST_F(McapFileTest, PublishersOfOneTopicAreOneTopic) {
  std::string file = std::string(kMcapMagic);
  file += mcap_record(
      3, mcap_number(1, 2) + test::mcap_text(test::kMapType) + test::mcap_text("") + test::mcap_text(""));
  for (const std::uint64_t id : {1, 2})
    file += mcap_record(4, mcap_number(id, 2) + mcap_number(1, 2) + test::mcap_text("/map") +
                               test::mcap_text("cdr") + test::mcap_text(""));
  for (const std::uint64_t id : {2, 1, 2})
    file += mcap_record(5, mcap_number(id, 2) + mcap_number(0, 4) + mcap_number(4 - id, 8) +
                               mcap_number(0, 8) + row_at(0, {static_cast<std::int8_t>(id), 0}).bytes);
  const Bag bag(directory_.write("a.mcap", file));
  ASSERT_EQ(bag.topics().size(), 1u);
  EXPECT_EQ(bag.topics()[0].messages, 3u);
  EXPECT_EQ(BagMaps(bag).messages(), 3u);
}

// What this process has read by calls of the system: bytes and calls.
struct Reads {
  std::uint64_t bytes = 0, calls = 0;
};

Reads reads_by_now() {
  std::ifstream file("/proc/self/io");
  Reads reads;
  std::string name;
  for (std::uint64_t value = 0; file >> name >> value;) {
    if (name == "rchar:") reads.bytes = value;
    if (name == "syscr:") reads.calls = value;
  }
  return reads;
}

TEST_F(McapFileTest, MessagesOutOfTheOrderOfTheirTimesAreUnpackedOnce) {
  constexpr std::int64_t kCount = 2000;
  std::vector<Recorded> messages{row_at(0, {0, 0, 0})};
  for (std::int64_t i = kCount; i > 0; --i)
    messages.push_back(test::update_at(
        i, {.x = static_cast<std::int32_t>(i % 3), .values = {static_cast<std::int8_t>(i % 101)}}));
  const std::string file = mcap_file(messages, {.messages_a_chunk = messages.size()});
  const Bag bag(directory_.write("a.mcap", file));
  const Reads before = reads_by_now();
  BagMaps maps(bag);
  const std::vector<Cell> last = maps.last().grid.cells;
  std::size_t count = 0;
  while (const auto map = maps.next()) ++count;
  EXPECT_LT(reads_by_now().bytes - before.bytes, 10 * file.size());
  EXPECT_EQ(last, cells_of({1998 % 101, 1999 % 101, 2000 % 101}));
  EXPECT_EQ(count, static_cast<std::size_t>(kCount) + 1);
}

TEST_F(McapFileTest, ChunksWhoseTimesAlternateAreUnpackedOnce) {
  std::vector<Recorded> messages;
  for (const int chunk : {0, 1}) {
    for (int i = 0; i < 500; ++i)
      messages.push_back(row_at(2 * i + chunk, {static_cast<std::int8_t>(i % 101)}));
  }
  const std::string file = mcap_file(messages, {.messages_a_chunk = 500});
  const Bag bag(directory_.write("a.mcap", file));
  const Reads before = reads_by_now();
  const Rows rows = all_cells(bag);
  EXPECT_LT(reads_by_now().bytes - before.bytes, 10 * file.size());
  EXPECT_EQ(rows, rows_of(messages, "/map"));
}

TEST_F(McapFileTest, MapsWithoutCellsBehindTheLastMapAreUnpackedAFewTimes) {
  std::vector<Recorded> messages{row_at(0, {0, 100, 100})};
  for (int i = 1; i <= 2000; ++i) messages.push_back(row_at(i, {}));
  const std::string file = mcap_file(messages, {.messages_a_chunk = messages.size()});
  const Bag bag(directory_.write("a.mcap", file));
  const Reads before = reads_by_now();
  EXPECT_EQ(BagMaps(bag).last().grid.cells, cells_of({0, 100, 100}));
  EXPECT_LT(reads_by_now().bytes - before.bytes, 20 * file.size());
}

TEST_F(McapFileTest, OnlySoMuchIsKeptOfWhatIsOutOfOrder) {
  std::vector<StoredMessage> order;
  for (std::uint64_t i = 20; i > 0; --i) order.push_back({0, 0, 8, i * 100, 100});
  internal::ScatteredChunks few("a.mcap", 1999), enough("a.mcap", 2000);
  const auto unpack = [](const StoredMessage& message) {
    return std::string(message.bytes, static_cast<char>(message.offset / 100));
  };
  few.expect(order, 100);
  enough.expect(order, 100);
  EXPECT_TRUE(contains(test::message_of<internal::ParseError>([&] { few.read(order[0], unpack); }),
                       "more than 1999 bytes of them would have to be kept"));
  EXPECT_EQ(enough.read(order[3], unpack), std::string(100, '\x11'));
}

TEST_F(McapFileTest, ShortRecordsAreReadByFewCalls) {
  std::string file(kMcapMagic);
  for (int i = 0; i < 50'000; ++i) file += mcap_record(0x99, "");
  const std::string path = directory_.write("a.mcap", file);
  const Reads before = reads_by_now();
  const Bag bag(path);
  EXPECT_LT(reads_by_now().calls - before.calls, 500u);
}

}  // namespace
}  // namespace gridmerge
