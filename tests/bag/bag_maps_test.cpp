// SPDX-License-Identifier: Apache-2.0
// Maps and their updates, in order of time, whichever file has them.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>

#include "bag/support.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using test::all_cells;
using test::cells_of;
using test::contains;
using test::Recorded;
using test::row_at;
using test::update_at;
using Rows = std::vector<std::vector<Cell>>;

class BagMapsTest : public testing::Test {
 protected:
  Bag bag_of(const std::vector<Recorded>& messages, const LoadOptions& options = {}) {
    return Bag(directory_.write("a.mcap", test::mcap_file(messages)), options);
  }

  static std::vector<MapWarningKind> kinds(const BagMap& map) {
    std::vector<MapWarningKind> kinds;
    for (const MapWarning& warning : map.warnings) kinds.push_back(warning.kind);
    return kinds;
  }

  const test::TemporaryDirectory directory_;
};

TEST_F(BagMapsTest, TellTopicsWithTypesAndCounts) {
  const Bag bag = bag_of({row_at(1, {0}),
                          row_at(2, {0}, "/b"),
                          row_at(3, {0}),
                          update_at(4, {}),
                          {"/chatter", 5, "hello", "std_msgs/msg/String", "cdr"}});
  ASSERT_EQ(bag.topics().size(), 4u);
  EXPECT_EQ(bag.topics()[0].name, "/b");
  EXPECT_EQ(bag.topics()[1].name, "/chatter");
  EXPECT_EQ(bag.topics()[1].type, "std_msgs/msg/String");
  EXPECT_EQ(bag.topics()[2].name, "/map");
  EXPECT_EQ(bag.topics()[2].encoding, "cdr");
  EXPECT_EQ(bag.topics()[2].messages, 2u);
  ASSERT_EQ(bag.map_topics().size(), 2u);
  EXPECT_EQ(bag.map_topics()[1].name, "/map");
  BagMaps maps(bag, "map");
  EXPECT_EQ(maps.topic(), "/map");
  EXPECT_EQ(maps.messages(), 3u);
  EXPECT_EQ(maps.updates(), 1u);
}

TEST_F(BagMapsTest, ComeInOrderOfTimeWithTheirPlace) {
  test::MapFields fields = test::row_of({0, 100, 100});
  fields.frame_id = "tb1/map";
  fields.x = 1.5;
  fields.y = -2.5;
  fields.qz = std::sin(0.35);
  fields.qw = std::cos(0.35);
  const Bag bag =
      bag_of({row_at(30, {0, 0, 0}), row_at(10, {100, 0}), {"/map", 20, test::map_message(fields)}});
  BagMaps maps(bag);
  EXPECT_EQ(maps.next()->time, 10);
  const BagMap second = maps.next().value();
  EXPECT_EQ(second.time, 20);
  EXPECT_EQ(second.frame_id, "tb1/map");
  EXPECT_EQ(second.grid.resolution, 0.05);
  EXPECT_EQ(second.grid.origin.x, 1.5);
  EXPECT_EQ(second.grid.origin.y, -2.5);
  EXPECT_NEAR(second.grid.origin.theta, 0.7, 1e-12);
  EXPECT_EQ(second.grid.cells, cells_of({0, 100, 100}));
  EXPECT_FALSE(second.is_update);
  EXPECT_EQ(maps.last().time, 30);
  EXPECT_EQ(maps.next()->time, 30) << "last() has moved the iterator";
  EXPECT_FALSE(maps.next());
}

TEST_F(BagMapsTest, UpdatesChangeTheMapBeforeThem) {
  test::MapFields square;
  square.width = square.height = 3;
  square.values.assign(9, 0);
  const Bag bag =
      bag_of({update_at(1, {}),
              {"/map", 2, test::map_message(square)},
              update_at(3, {.x = 1, .y = 0, .width = 2, .height = 2, .values = {100, -1, 100, 0}}),
              update_at(4, {.x = 0, .y = 2, .width = 1, .height = 1, .values = {100}})});
  BagMaps maps(bag);
  EXPECT_FALSE(maps.next()->is_update);
  EXPECT_EQ(maps.next()->grid.cells, cells_of({0, 100, -1, 0, 100, 0, 0, 0, 0}));
  const BagMap last = maps.next().value();
  EXPECT_EQ(last.grid.cells, cells_of({0, 100, -1, 0, 100, 0, 100, 0, 0}));
  EXPECT_TRUE(last.is_update);
  EXPECT_EQ(maps.last().grid.cells, last.grid.cells);
  EXPECT_EQ(maps.last().time, 4);
}

TEST_F(BagMapsTest, UpdatesOfAnotherTopicOrTypeAreNone) {
  Recorded wrong_type = update_at(3, {});
  wrong_type.type = "std_msgs/msg/String";
  const Bag bag = bag_of({row_at(1, {0, 0}), update_at(2, {}, "/other_updates"), wrong_type});
  EXPECT_EQ(all_cells(bag), (Rows{cells_of({0, 0})}));
}

TEST_F(BagMapsTest, UpdatesBeyondTheirMapArePassedOverWithAWarning) {
  const Bag bag =
      bag_of({row_at(1, {0, 0}), update_at(2, {.x = 2}), update_at(3, {.x = -1}), update_at(4, {.y = 1}),
              update_at(5, {.width = 3, .values = {100, 100, 100}}), update_at(6, {.x = 1})});
  const BagMap last = BagMaps(bag).last();
  EXPECT_EQ(last.grid.cells, cells_of({0, 100}));
  EXPECT_EQ(last.time, 6);
  ASSERT_EQ(kinds(last), std::vector<MapWarningKind>{MapWarningKind::useless_update});
  EXPECT_TRUE(contains(last.warnings[0].text, "4 updates"));
}

TEST_F(BagMapsTest, MapsWithoutCellsArePassedOverWithAWarning) {
  const Recorded empty{"/map", 5, test::map_message({.width = 0, .height = 0, .values = {}})};
  const Bag bag = bag_of({empty, row_at(6, {0, 100}), empty});
  EXPECT_EQ(all_cells(bag), (Rows{cells_of({0, 100})}));
  Recorded late = empty;
  late.time = 7;
  const BagMap last = BagMaps(bag_of({row_at(6, {0, 100}), late})).last();
  EXPECT_EQ(last.time, 6);
  EXPECT_EQ(kinds(last), std::vector<MapWarningKind>{MapWarningKind::no_cells});
  const Bag blank = bag_of({empty});
  EXPECT_TRUE(
      contains(test::message_of<FileError>([&] { BagMaps(blank).last(); }), "has no map with cells on /map"));
}

TEST_F(BagMapsTest, TellWhatIsOddAboutValues) {
  test::MapFields fields = test::row_of({0, 100, 101, -2, 127});
  fields.qw = 0.0;
  const BagMap map = BagMaps(bag_of({{"/map", 1, test::map_message(fields)}})).last();
  EXPECT_EQ(kinds(map),
            (std::vector<MapWarningKind>{MapWarningKind::not_a_percentage, MapWarningKind::no_rotation}));
  EXPECT_TRUE(contains(map.warnings[0].text, "3 values"));
  const BagMap free = BagMaps(bag_of({row_at(1, {0, 0})})).last();
  EXPECT_EQ(kinds(free), std::vector<MapWarningKind>{MapWarningKind::no_occupied_cell});
}

TEST_F(BagMapsTest, ADamagedMessageIsNamedAndTheNextOneRead) {
  const Bag bag = bag_of({row_at(1, {0, 100}), {"/map", 2, "\x01"}, row_at(3, {100, 0})});
  BagMaps maps(bag);
  EXPECT_TRUE(maps.next());
  const std::string message = test::message_of<FileError>([&] { maps.next(); });
  EXPECT_TRUE(contains(message, directory_.file("a.mcap") + ": a message of /map is damaged: "));
  EXPECT_EQ(maps.next()->grid.cells, cells_of({100, 0}));
  EXPECT_EQ(maps.last().grid.cells, cells_of({100, 0})) << "which does not need the damaged one";
}

TEST_F(BagMapsTest, TopicsAreChosenByName) {
  const Bag two = bag_of({row_at(1, {0, 0}, "/tb1/map"), row_at(1, {100, 0}, "/tb2/map")});
  EXPECT_EQ(all_cells(two, "/tb2/map"), (Rows{cells_of({100, 0})}));
  EXPECT_EQ(all_cells(two, "tb2/map"), (Rows{cells_of({100, 0})}));
  const auto error = [&](const Bag& bag, const std::string& topic) {
    return test::message_of<FileError>([&] { BagMaps(bag, topic); });
  };
  EXPECT_TRUE(contains(error(two, ""), "has 2 topics of maps: add #TOPIC"));
  EXPECT_TRUE(contains(error(two, ""), "/tb1/map, /tb2/map"));
  EXPECT_TRUE(contains(error(two, "/map"), "has no maps on the topic '/map'"));
  EXPECT_TRUE(contains(error(two, "/map"), "/tb1/map, /tb2/map"));
  const Bag none = bag_of({{"/chatter", 1, "", "std_msgs/msg/String", "cdr"}});
  EXPECT_TRUE(contains(error(none, ""), "has no maps"));
  EXPECT_TRUE(contains(error(none, ""), "/chatter (std_msgs/msg/String)"));
  EXPECT_TRUE(contains(error(bag_of({}), ""), "has no topics"));
}

TEST_F(BagMapsTest, AListOfTopicsEndsWithTheTwentieth) {
  std::vector<Recorded> messages;
  std::string names;
  const auto error = [&] { return test::message_of<FileError>([&] { BagMaps{bag_of(messages)}; }); };
  const std::string begin = directory_.file("a.mcap") + ": has ";
  for (char c = 'a'; c < 'a' + 20; ++c) {
    messages.push_back(row_at(1, {0}, std::string("/") + c));
    names += (c == 'a' ? "/" : ", /") + std::string(1, c);
    if (c == 'b') {
      EXPECT_EQ(error(), begin + "2 topics of maps: add #TOPIC to its name to choose one of /a, /b");
    }
  }
  EXPECT_EQ(error(), begin + "20 topics of maps: add #TOPIC to its name to choose one of " + names);
  messages.push_back(row_at(1, {0}, "/z"));
  EXPECT_EQ(error(),
            begin + "21 topics of maps: add #TOPIC to its name to choose one of " + names + " and 1 more");
}

TEST_F(BagMapsTest, WhatIsNoMapIsListedWithItsType) {
  const Bag bag = bag_of({{"/a", 1, "", "t/msg/A", "cdr"}, {"/b", 1, "", "t/msg/B", "cdr"}});
  const std::string expected = directory_.file("a.mcap") +
                               ": has no maps (messages of nav_msgs/msg/OccupancyGrid); its topics are /a "
                               "(t/msg/A), /b (t/msg/B)";
  EXPECT_EQ(test::message_of<FileError>([&] { BagMaps{bag}; }), expected);
  EXPECT_EQ(test::message_of<FileError>([&] { BagMaps(bag, "/a"); }), expected);
  EXPECT_EQ(test::message_of<FileError>([&] { BagMaps{bag_of({})}; }),
            directory_.file("a.mcap") + ": has no topics, and so no maps");
}

// Whole maps are looked for from the end, in blocks of 1, 2, 4 and so on.
TEST_F(BagMapsTest, TheLastMapWithCellsIsFoundWhereverItIs) {
  for (int count = 1; count <= 9; ++count) {
    for (int last = 0; last < count; ++last) {
      std::vector<Recorded> messages;
      for (int i = 0; i < count; ++i)
        messages.push_back(row_at(i, i <= last
                                         ? std::vector<std::int8_t>{static_cast<std::int8_t>(i * 11), 100}
                                         : std::vector<std::int8_t>{}));
      const BagMap map = BagMaps(bag_of(messages)).last();
      EXPECT_EQ(map.time, last) << count;
      EXPECT_EQ(map.grid.cells, cells_of({static_cast<std::int8_t>(last * 11), 100})) << count;
    }
  }
}

TEST_F(BagMapsTest, DamageBehindTheLastMapIsNotPassedOver) {
  const Recorded damaged{"/map", 5, "\x01"};
  const auto at = [](Recorded message, std::int64_t time) {
    message.time = time;
    return message;
  };
  for (int empty = 0; empty <= 5; ++empty) {
    std::vector<Recorded> messages{row_at(1, {0, 100}), at(damaged, 2)};
    for (int i = 0; i < empty; ++i) messages.push_back(row_at(3 + i, {}));
    const Bag bag = bag_of(messages);
    EXPECT_TRUE(contains(test::message_of<FileError>([&] { BagMaps(bag).last(); }),
                         ": a message of /map is damaged: the message ends early"))
        << empty;
    messages.push_back(row_at(20, {100, 0}));
    for (int i = 0; i < empty; ++i) messages.push_back(row_at(30 + i, {}));
    EXPECT_EQ(BagMaps(bag_of(messages)).last().time, 20) << empty;
  }
  const Bag before = bag_of({row_at(1, {0, 0}), at(damaged, 2), row_at(3, {0, 100}), row_at(4, {})});
  EXPECT_EQ(BagMaps(before).last().time, 3) << "in one block with the damaged one";
  const Bag behind = bag_of({row_at(1, {0, 0}), row_at(2, {0, 100}), at(damaged, 3), row_at(4, {})});
  EXPECT_THROW(BagMaps(behind).last(), FileError);
  const Bag update = bag_of({row_at(1, {0, 100}), at({"/map_updates", 2, "\x01", test::kUpdateType}, 2)});
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { BagMaps(update).last(); }),
                       ": a message of /map_updates is damaged: the message ends early"));
}

TEST_F(BagMapsTest, UpdatesBeforeTheLastMapAreNotDrawnOnIt) {
  const Bag bag = bag_of({update_at(1, {}), row_at(2, {0, 0}), update_at(3, {}), row_at(4, {0, 100}),
                          update_at(5, {.x = -1}), update_at(6, {.x = 5})});
  const BagMap last = BagMaps(bag).last();
  EXPECT_EQ(last.time, 4) << "an update that is passed over is no news";
  EXPECT_FALSE(last.is_update);
  EXPECT_EQ(last.grid.cells, cells_of({0, 100}));
  ASSERT_EQ(last.warnings.size(), 1u);
  EXPECT_EQ(last.warnings[0].text, "2 updates reach beyond their map: they are passed over");
}

TEST_F(BagMapsTest, OtherEncodingsAreNotGuessed) {
  Recorded ros1 = row_at(1, {0, 0});
  ros1.encoding = "ros1";
  const Bag bag = bag_of({ros1});
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { BagMaps{bag}; }), "encoding 'ros1'"));
}

TEST_F(BagMapsTest, LargeMapsAreRefusedBeforeTheyAreRead) {
  const std::vector<std::int8_t> values(2000, 0);
  const Bag bag = bag_of({row_at(1, values)}, {.max_cells = 1999});
  EXPECT_TRUE(
      contains(test::message_of<FileError>([&] { BagMaps(bag).last(); }), "exceed the limit of 1999"));
  EXPECT_EQ(BagMaps(bag_of({row_at(1, values)}, {.max_cells = 2000})).last().grid.width, 2000);
  const std::string huge(std::size_t{3} << 20, 'x');
  const Bag beyond = bag_of({{"/map", 1, huge}}, {.max_cells = 1999});
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { BagMaps(beyond).last(); }),
                       "a message of 3145728 bytes exceeds the limit"));
}

TEST_F(BagMapsTest, AMessagePackedByItselfIsUnpacked) {
  Recorded packed = row_at(1, {0, 100});
  packed.bytes = test::pack_zstd(packed.bytes);
  EXPECT_EQ(all_cells(bag_of({packed})), (Rows{cells_of({0, 100})}));
  packed.bytes = test::pack_zstd(std::string(std::size_t{1} << 24, '\0'));
  EXPECT_TRUE(
      contains(test::message_of<FileError>([&] { BagMaps(bag_of({packed}, {.max_cells = 100})).last(); }),
               "unpacks to more than"));
}

TEST_F(BagMapsTest, WhatWasMovedElsewhereHasNothingLeft) {
  BagMaps maps(bag_of({row_at(1, {0, 100}), row_at(2, {100, 0})}));
  BagMaps other(std::move(maps));
  EXPECT_EQ(other.next()->time, 1);
  EXPECT_EQ(maps.topic(), "");
  EXPECT_EQ(maps.messages(), 0u);
  EXPECT_EQ(maps.updates(), 0u);
  EXPECT_FALSE(maps.next());
  EXPECT_THROW(maps.last(), EmptyTopic);
  maps = std::move(other);
  EXPECT_EQ(maps.next()->time, 2);
  EXPECT_FALSE(other.next());
}

TEST_F(BagMapsTest, ABagCanBeCopiedAndReadTwice) {
  const Bag bag = bag_of({row_at(1, {0, 100}), row_at(2, {100, 0}), row_at(3, {100, 100})});
  const Bag copy = bag;
  BagMaps one(bag), other(copy);
  for (std::int64_t time = 1; time <= 3; ++time) {
    EXPECT_EQ(one.next()->time, time);
    EXPECT_EQ(other.next()->time, time);
  }
}

}  // namespace
}  // namespace gridmerge
