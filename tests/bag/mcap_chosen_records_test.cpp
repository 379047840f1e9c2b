// SPDX-License-Identifier: Apache-2.0
// MCAP files of which each record is chosen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bag/map_messages.hpp"
#include "bag/mcap.hpp"
#include "bag/support.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using internal::StoredMessage;
using test::all_cells;
using test::cells_of;
using test::kMcapMagic;
using test::mcap_file;
using test::mcap_number;
using test::mcap_record;
using test::mcap_with_chunk;
using test::row_at;
using Rows = std::vector<std::vector<Cell>>;

std::string schema(std::uint64_t id, const std::string& name = test::kMapType) {
  return mcap_record(3,
                     mcap_number(id, 2) + test::mcap_text(name) + test::mcap_text("") + test::mcap_text(""));
}

std::string channel(std::uint64_t id, std::uint64_t schema, const std::string& topic) {
  return mcap_record(4, mcap_number(id, 2) + mcap_number(schema, 2) + test::mcap_text(topic) +
                            test::mcap_text("cdr") + test::mcap_text(""));
}

std::string message(std::uint64_t id, std::uint64_t time, const std::string& bytes) {
  return mcap_record(
      5, mcap_number(id, 2) + mcap_number(0, 4) + mcap_number(time, 8) + mcap_number(0, 8) + bytes);
}

std::string index(std::uint64_t id, std::size_t bytes = 16) {
  return mcap_record(7, mcap_number(id, 2) + test::mcap_text(std::string(bytes, '\0')));
}

using Counts = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

std::string statistics(std::uint64_t messages, std::uint64_t channels, const Counts& counts) {
  std::string text;
  for (const auto& [id, count] : counts) text += mcap_number(id, 2) + mcap_number(count, 8);
  return mcap_record(11, mcap_number(messages, 8) + mcap_number(1, 2) + mcap_number(channels, 4) +
                             std::string(28, '\0') + test::mcap_text(text));
}

// Records between the magic and a footer that says where the summary begins.
std::string ended(const std::string& records, std::uint64_t summary_begin, std::uint8_t kind = 2,
                  std::size_t more = 0) {
  return std::string(kMcapMagic) + records +
         mcap_record(kind, mcap_number(summary_begin, 8) + mcap_number(0, 12) + std::string(more, '\0')) +
         std::string(kMcapMagic);
}

// Data of two messages, the end of the data, and then this summary.
std::string with_summary(const std::string& summary) {
  const std::string data = schema(1) + channel(1, 1, "/map") + message(1, 5, row_at(0, {0}).bytes) +
                           message(1, 6, row_at(0, {100}).bytes) + mcap_record(15, mcap_number(0, 4));
  return ended(data + summary, kMcapMagic.size() + data.size());
}

class McapRecordsOfFile : public testing::Test {
 protected:
  Bag bag_of(const std::string& file) { return Bag(directory_.write("a.mcap", file)); }

  // The only topic, how many messages it is said to have, and its type.
  std::string topic_of(const std::string& file) {
    const Bag bag = bag_of(file);
    EXPECT_EQ(bag.topics().size(), 1u);
    if (bag.topics().empty()) return {};
    const BagTopic& topic = bag.topics().front();
    return topic.name + " " + std::to_string(topic.messages) + " " + topic.type;
  }

  std::string opening_error(const std::string& file) {
    const std::string path = directory_.write("a.mcap", file);
    const std::string text = test::message_of<FileError>([&] { Bag{path}; });
    EXPECT_TRUE(text.starts_with(path + ": ")) << text;
    return text.substr(std::min(text.size(), path.size() + 2));
  }

  const test::TemporaryDirectory directory_;
};

TEST_F(McapRecordsOfFile, ASummaryStandsBetweenTheMagicAndTheFooter) {
  const std::string summary = schema(1) + channel(1, 1, "/map") + statistics(7, 1, {{1, 7}});
  const std::string topic = "/map 7 nav_msgs/msg/OccupancyGrid";
  EXPECT_EQ(topic_of(ended(summary, 8)), topic) << "right behind the magic";
  EXPECT_EQ(opening_error(ended(summary, 7)), "the footer names no place of the file");
  EXPECT_EQ(opening_error(ended(summary, 1)), "the footer names no place of the file");
  const std::string counted = "/map 0 nav_msgs/msg/OccupancyGrid";
  EXPECT_EQ(topic_of(ended(summary, 0)), counted) << "there is none: the records are counted";
  EXPECT_EQ(topic_of(ended(summary, 8 + summary.size())), counted) << "it is empty";
  EXPECT_EQ(opening_error(ended(summary, 8 + summary.size() + 1)), "the footer names no place of the file");
}

TEST_F(McapRecordsOfFile, ASummaryThatTellsAllIsReliedOn) {
  const std::string names = schema(1) + channel(1, 1, "/map");
  const std::string relied = "/map 7 nav_msgs/msg/OccupancyGrid",
                    counted = "/map 2 nav_msgs/msg/OccupancyGrid";
  EXPECT_EQ(topic_of(with_summary(names + statistics(7, 1, {{1, 7}}))), relied);
  EXPECT_EQ(topic_of(with_summary(statistics(7, 1, {{1, 7}}) + names)), relied);
  EXPECT_EQ(topic_of(with_summary(names + mcap_record(0x99, "?") + statistics(7, 1, {{1, 7}}))), relied);
  EXPECT_EQ(topic_of(with_summary(channel(1, 0, "/map") + statistics(7, 1, {{1, 7}}))), "/map 7 ")
      << "a channel may have no schema";
  EXPECT_EQ(topic_of(with_summary(names + statistics(0, 1, {}))), "/map 0 nav_msgs/msg/OccupancyGrid");

  EXPECT_EQ(topic_of(with_summary("")), counted);
  EXPECT_EQ(topic_of(with_summary(names)), counted);
  EXPECT_EQ(topic_of(with_summary(names + statistics(7, 0, {{1, 7}}))), counted);
  EXPECT_EQ(topic_of(with_summary(names + statistics(7, 2, {{1, 7}}))), counted);
  EXPECT_EQ(topic_of(with_summary(names + statistics(8, 1, {{1, 7}}))), counted);
  EXPECT_EQ(topic_of(with_summary(names + statistics(7, 1, {{1, 3}, {2, 4}}))), counted);
  EXPECT_EQ(topic_of(with_summary(statistics(7, 0, {{1, 7}}))), counted);
  EXPECT_EQ(topic_of(with_summary(channel(1, 1, "/map") + statistics(7, 1, {{1, 7}}))), counted);
  EXPECT_EQ(topic_of(with_summary(schema(2) + channel(1, 1, "/map") + statistics(7, 1, {{1, 7}}))), counted);
  EXPECT_EQ(topic_of(with_summary(schema(1) + channel(1, 1, "/other") + statistics(9, 1, {{1, 7}}))), counted)
      << "and what it says is forgotten";
  EXPECT_EQ(topic_of(with_summary(names + channel(2, 1, "/other"))), counted)
      << "which stands behind the data";
}

TEST_F(McapRecordsOfFile, ALongSummaryHasAChecksumToo) {
  const std::string topic = "/" + std::string(150'000, 'a');
  std::string file = mcap_file({row_at(1, {0, 100}, topic)});
  EXPECT_EQ(bag_of(file).topics().at(0).name, topic);
  file[file.rfind("aaaa") - 100'000] = 'b';
  EXPECT_EQ(opening_error(file), "the summary's checksum is wrong: the file is damaged");
}

TEST_F(McapRecordsOfFile, OnlyAFooterEndsAFile) {
  const std::string data = schema(1) + channel(1, 1, "/map") + message(1, 5, row_at(0, {0, 100}).bytes);
  const auto warnings = [&](const std::string& file) { return BagMaps(bag_of(file)).last().warnings.size(); };
  EXPECT_EQ(warnings(ended(data, 0)), 0u);
  EXPECT_EQ(warnings(ended(data, 0, 0x99)), 1u) << "a record of another kind";
  EXPECT_EQ(warnings(ended(data, 0, 2, 1)), 1u) << "a record that is longer";
  EXPECT_EQ(warnings(std::string(kMcapMagic) + data), 1u);
  const std::vector<MapWarning> told = BagMaps(bag_of(std::string(kMcapMagic) + data)).last().warnings;
  EXPECT_EQ(told.at(0).kind, MapWarningKind::cut_off);
  EXPECT_EQ(told.at(0).text, "the file has no end: recording was cut off, and what came last may be missing");
  EXPECT_TRUE(bag_of(std::string(kMcapMagic)).topics().empty());
  EXPECT_TRUE(bag_of(ended("", 0)).topics().empty());
}

TEST_F(McapRecordsOfFile, ARecordReachesToTheLastByte) {
  const std::string data = schema(1) + channel(1, 1, "/map");
  const std::string at = "the record at byte " + std::to_string(8 + data.size()) + " reaches beyond the file";
  const std::string long_head = mcap_number(0x99, 1) + mcap_number(6, 8);
  EXPECT_EQ(topic_of(ended(data + long_head + "012345", 0)), "/map 0 nav_msgs/msg/OccupancyGrid");
  EXPECT_EQ(opening_error(ended(data + long_head + "01234", 0)), at);
  EXPECT_EQ(opening_error(ended(data + long_head, 0)), at);
  EXPECT_EQ(opening_error(ended(data + long_head.substr(0, 8), 0)), at);
  EXPECT_EQ(opening_error(ended(data + "x", 0)), at);
  EXPECT_EQ(topic_of(ended(data + mcap_record(0x99, ""), 0)), "/map 0 nav_msgs/msg/OccupancyGrid");
  // Without an end, what is not whole is left out.
  const std::string cell = message(1, 5, row_at(0, {0}).bytes), begin = std::string(kMcapMagic) + data;
  EXPECT_EQ(topic_of(begin + cell), "/map 1 nav_msgs/msg/OccupancyGrid");
  EXPECT_EQ(topic_of(begin + cell + cell.substr(0, cell.size() - 1)), "/map 1 nav_msgs/msg/OccupancyGrid");
  EXPECT_EQ(topic_of(begin + cell + cell.substr(0, 8)), "/map 1 nav_msgs/msg/OccupancyGrid");
}

TEST_F(McapRecordsOfFile, ARecordReachesToTheLastByteOfItsChunk) {
  const std::string inner = mcap_record(0x99, "012345");
  const auto chunk = [](const std::string& records, std::uint64_t claimed, bool has_crc = false) {
    return mcap_with_chunk(test::mcap_chunk(records, "", has_crc, claimed));
  };
  EXPECT_TRUE(bag_of(chunk(inner, inner.size())).topics().empty());
  EXPECT_TRUE(bag_of(chunk("", 0)).topics().empty());
  const std::string beyond = "a record reaches beyond its chunk";
  EXPECT_EQ(opening_error(chunk(inner.substr(0, 14), 14)), beyond);
  EXPECT_EQ(opening_error(chunk(inner + inner.substr(0, 8), inner.size() + 8)), beyond);
  EXPECT_EQ(opening_error(chunk(inner + "x", inner.size())), "a chunk unpacks to more than it says");
  EXPECT_EQ(opening_error(chunk(inner, inner.size() + 9)), "a chunk unpacks to less than it says");
  EXPECT_EQ(opening_error(chunk("", 4'294'967'296)), "a chunk unpacks to less than it says");
  EXPECT_EQ(opening_error(chunk("", 4'294'967'297)), "a chunk claims to unpack to 4294967297 bytes");
  std::string reaching = test::mcap_chunk(inner, "");
  reaching.pop_back();
  EXPECT_EQ(opening_error(mcap_with_chunk(reaching)), "a chunk's records reach beyond the chunk");
  EXPECT_EQ(opening_error(mcap_with_chunk(test::mcap_chunk(inner, "gzip"))),
            "a chunk is packed by 'gzip', which is neither zstd nor lz4");
}

TEST_F(McapRecordsOfFile, AChunkWhoseIndexesListOtherMessagesIsNotUnpacked) {
  const std::string names =
      std::string(kMcapMagic) + schema(1) + channel(1, 1, "/map") + channel(2, 1, "/tb2/map");
  const std::string good =
      mcap_record(6, test::mcap_chunk(message(1, 5, row_at(0, {0, 100}).bytes), "")) + index(1);
  const std::string bad = mcap_record(6, test::mcap_chunk("no record", "gzip"));
  const std::string end = mcap_record(15, mcap_number(0, 4));
  const std::string summary =
      schema(1) + channel(1, 1, "/map") + channel(2, 1, "/tb2/map") + statistics(2, 2, {{1, 1}, {2, 1}});
  const auto rows = [&](const std::string& chunks) {
    const std::string data = names.substr(kMcapMagic.size()) + chunks + end;
    return all_cells(bag_of(ended(data + summary, kMcapMagic.size() + data.size())), "/map");
  };
  const Rows expected{cells_of({0, 100})};
  EXPECT_EQ(rows(good), expected);
  EXPECT_EQ(rows(good + bad + index(2)), expected);
  EXPECT_EQ(rows(bad + index(2) + good), expected);
  EXPECT_EQ(rows(good + bad + index(2) + index(1, 0)), expected) << "an index that lists none";
  for (const std::string& indexes : {std::string(), index(1), index(2) + index(1), index(1) + index(2)}) {
    EXPECT_THROW(rows(good + bad + indexes), FileError);
    EXPECT_THROW(rows(bad + indexes + good), FileError);
  }
}

TEST_F(McapRecordsOfFile, TellsWhereEachMessageOfEachTopicIs) {
  const std::string names = std::string(kMcapMagic) + schema(1) + schema(2, "other/msg/Type") +
                            channel(1, 1, "/map") + channel(2, 1, "/b") + channel(3, 2, "/map");
  const std::string one = message(1, 30, "one"), two = message(2, 10, "second"),
                    three = message(3, 20, "none");
  const std::string before = names + one + three;
  const std::string path =
      directory_.write("a.mcap", before + mcap_record(6, test::mcap_chunk(two + three + one, "lz4")) + two);
  internal::McapFile file(path, "shown", 6);
  ASSERT_EQ(file.topics().size(), 3u);
  const std::vector<StoredMessage> found =
      file.find({{"/b", test::kMapType, "cdr", 0}, {"/map", test::kMapType, "cdr", 0}});
  ASSERT_EQ(found.size(), 4u);
  const auto expect_at = [&](std::size_t i, std::int64_t time, std::size_t topic, std::uint64_t place,
                             std::uint64_t offset, const std::string& bytes) {
    EXPECT_EQ(found[i].time, time) << i;
    EXPECT_EQ(found[i].topic, topic) << i;
    EXPECT_EQ(found[i].place, place) << i;
    EXPECT_EQ(found[i].offset, offset) << i;
    EXPECT_EQ(found[i].bytes, bytes.size()) << i;
    EXPECT_EQ(file.read(found[i]), bytes) << i;
  };
  const std::uint64_t chunk = before.size() + 9;
  expect_at(0, 30, 1, 0, names.size() + 31, "one");
  expect_at(1, 10, 0, chunk, 31, "second");
  expect_at(2, 30, 1, chunk, two.size() + three.size() + 31, "one");
  expect_at(3, 10, 0, 0, std::filesystem::file_size(path) - 6, "second");
  EXPECT_EQ(file.read(found[1]), "second") << "before what was read last";
  EXPECT_EQ(file.read(found[1]), "second") << "which is behind that";
  EXPECT_EQ(file.read(found[2]), "one");
  internal::McapFile narrow(path, "shown", 5);
  EXPECT_EQ(narrow.read(found[2]), "one");
  for (const std::size_t i : {1U, 3U})
    EXPECT_EQ(test::message_of<FileError>([&] { narrow.read(found[i]); }),
              "shown: a message of 6 bytes exceeds the limit of 5");
}

}  // namespace
}  // namespace gridmerge
