// SPDX-License-Identifier: Apache-2.0
// Rosbag2 files of SQLite, whole and damaged.
#include "bag/sqlite_bag.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bag/sqlite_reading.hpp"
#include "bag/support.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using internal::looks_like_sqlite;
using internal::SqliteBag;
using internal::StoredMessage;
using test::all_cells;
using test::cells_of;
using test::contains;
using test::Recorded;
using test::row_at;
using test::run_sql;
using test::update_at;
using test::write_db3;
using Rows = std::vector<std::vector<Cell>>;

class SqliteBagTest : public testing::Test {
 protected:
  std::string error_of(const std::string& path, const LoadOptions& options = {}) {
    const std::string message = test::message_of<FileError>([&] {
      const Bag bag(path, options);
      BagMaps(bag).last();
    });
    EXPECT_TRUE(message.starts_with(path + ": ")) << message;
    return message;
  }

  const test::TemporaryDirectory directory_;
  const std::string path_ = directory_.file("a.db3");
};

TEST_F(SqliteBagTest, TellsTopicsAndReadsTheirMapsInOrderOfTime) {
  write_db3(path_, {row_at(30, {0, 100}, "/tb1/map"),
                    row_at(10, {100, 0}, "/tb1/map"),
                    {"/chatter", 11, "hi", "std_msgs/msg/String", "cdr"},
                    row_at(20, {100, 100}, "/tb2/map"),
                    update_at(40, {.x = 1, .values = {0}}, "/tb1/map_updates")});
  const Bag bag(path_);
  ASSERT_EQ(bag.topics().size(), 4u);
  EXPECT_EQ(bag.topics()[1].name, "/tb1/map");
  EXPECT_EQ(bag.topics()[1].messages, 2u);
  EXPECT_EQ(bag.topics()[2].type, test::kUpdateType);
  EXPECT_EQ(all_cells(bag, "/tb1/map"), (Rows{cells_of({100, 0}), cells_of({0, 100}), cells_of({0, 0})}));
  EXPECT_EQ(all_cells(bag, "/tb2/map"), (Rows{cells_of({100, 100})}));
  EXPECT_EQ(directory_.names(), std::vector<std::string>{"a.db3"}) << "nothing is made beside it";
}

RC_GTEST_PROP(SqliteBag, WhatIsWrittenIsRead, ()) {
  const auto rows =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<std::vector<std::int8_t>>>(rc::gen::nonEmpty(
          rc::gen::container<std::vector<std::int8_t>>(rc::gen::inRange<std::int8_t>(-1, 101)))));
  std::vector<Recorded> messages;
  Rows expected;
  for (const auto& row : rows) {
    messages.push_back(row_at(static_cast<std::int64_t>(messages.size()), row));
    expected.push_back(cells_of(row));
  }
  const test::TemporaryDirectory directory;
  write_db3(directory.file("a.db3"), messages);
  const Bag bag(directory.file("a.db3"));
  RC_ASSERT(all_cells(bag) == expected);
  RC_ASSERT(BagMaps(bag).last().grid.cells == expected.back());
}

TEST_F(SqliteBagTest, WhatARecorderLeftInItsLogIsRead) {
  write_db3(path_, {row_at(1, {0, 100})});
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path_.c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, "PRAGMA journal_mode = WAL; UPDATE messages SET timestamp = 5;", nullptr,
                         nullptr, nullptr),
            SQLITE_OK);
  // As if it were killed now.
  const std::string copy = directory_.write("copy.db3", test::read_file(path_));
  directory_.write("copy.db3-wal", test::read_file(path_ + "-wal"));
  sqlite3_close(database);
  EXPECT_EQ(BagMaps(Bag(copy)).last().time, 5);
  // By a link as well: the log lies beside the file that it leads to.
  std::filesystem::create_directory(directory_.path() / "links");
  std::filesystem::create_symlink("../copy.db3", directory_.path() / "links" / "a.db3");
  EXPECT_EQ(BagMaps(Bag(directory_.file("links/a.db3"))).last().time, 5);
}

TEST_F(SqliteBagTest, ALogThatCannotBeUsedIsNamed) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  write_db3(path_, {row_at(1, {0, 100})});
  run_sql(path_, "PRAGMA journal_mode = WAL");
  directory_.write("a.db3-wal", "");
  std::filesystem::permissions(directory_.path(),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_TRUE(contains(error_of(path_), "a.db3-wal beside it holds what a recorder wrote last"));
  std::filesystem::permissions(directory_.path(), std::filesystem::perms::owner_all);
}

TEST_F(SqliteBagTest, WhatIsNoBagIsRefused) {
  run_sql(path_, "CREATE TABLE topics(id INTEGER)");
  EXPECT_EQ(error_of(path_),
            path_ + ": is an SQLite database, and no rosbag2 file: it has no table 'messages'");
  const std::string other = directory_.file("b.db3");
  run_sql(other, "CREATE TABLE messages(id INTEGER)");
  EXPECT_EQ(error_of(other),
            other + ": is an SQLite database, and no rosbag2 file: it has no table 'topics'");
  run_sql(path_, "CREATE TABLE messages(id INTEGER)");
  EXPECT_TRUE(contains(error_of(path_), "SQLite cannot read it: no such column"));
}

TEST_F(SqliteBagTest, ColumnsThatAreComputedAreNotRead) {
  const std::string topics =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
      "INSERT INTO topics VALUES (1, '/map', 'nav_msgs/msg/OccupancyGrid', 'cdr');";
  int file = 0;
  for (const char* kind : {"", " STORED"}) {
    const std::string path = directory_.file(std::to_string(file++) + ".db3");
    run_sql(path, topics +
                      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
                      "data AS (printf('%.*c', 100, 'x'))" +
                      kind + "); INSERT INTO messages(topic_id, timestamp) VALUES (1, 2);");
    EXPECT_TRUE(contains(error_of(path), "its table 'messages' computes a column"));
  }
  run_sql(
      path_,
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name AS ('/map'), type TEXT, serialization_format TEXT);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);");
  EXPECT_TRUE(contains(error_of(path_), "its table 'topics' computes a column"));
}

TEST_F(SqliteBagTest, AViewThatNeverEndsIsNotRun) {
  run_sql(path_,
          "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT);"
          "CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
          "SELECT i AS id, 1 AS topic_id, i AS timestamp, 'x' AS data FROM n;");
  EXPECT_TRUE(contains(error_of(path_), "has no table 'messages'"));
}

TEST_F(SqliteBagTest, LargeMessagesAreRefusedBeforeTheyAreRead) {
  write_db3(path_, {row_at(1, {0, 100})});
  run_sql(path_, "UPDATE messages SET data = zeroblob(3000000)");
  EXPECT_EQ(error_of(path_, {.max_cells = 100}),
            path_ + ": a message of 3000000 bytes exceeds the limit of 1048676");
}

TEST_F(SqliteBagTest, AMessageOfExactlyTheLimitIsRead) {
  write_db3(path_, {row_at(1, {0, 100})});
  run_sql(path_, "UPDATE messages SET data = zeroblob(5000)");
  SqliteBag enough(path_, "shown", 5000), few(path_, "shown", 4999);
  const StoredMessage message = enough.find(enough.topics()).at(0);
  EXPECT_EQ(message.bytes, 5000u);
  EXPECT_TRUE(enough.read(message) == std::string(5000, '\0'));
  EXPECT_EQ(test::message_of<FileError>([&] { few.read(message); }),
            "shown: a message of 5000 bytes exceeds the limit of 4999");
}

TEST_F(SqliteBagTest, NamesAreNoLongerThanMessages) {
  write_db3(path_, {row_at(1, {0, 100})});
  run_sql(path_, "UPDATE topics SET name = printf('%.*c', 3000000, 'x')");
  EXPECT_EQ(error_of(path_, {.max_cells = 100}), path_ + ": a message exceeds the limit of 1048676 bytes");
}

TEST_F(SqliteBagTest, AMessageThatIsGoneIsNoMessage) {
  write_db3(path_, {row_at(1, {0, 100})});
  SqliteBag bag(path_, "shown", 5000);
  EXPECT_EQ(test::message_of<FileError>([&] { bag.read({.offset = 2, .bytes = 1}); }),
            "shown: a message is gone: does somebody write to the file?");
}

TEST_F(SqliteBagTest, ManyMessagesAreCountedAndFound) {
  write_db3(path_, {row_at(1, {0, 100})});
  run_sql(path_,
          "WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n WHERE i < 20000) "
          "INSERT INTO messages(topic_id, timestamp, data) SELECT 1, 20000 - i % 100, '' FROM n");
  SqliteBag bag(path_, "shown", 5000);
  ASSERT_EQ(bag.topics().size(), 1u);
  EXPECT_EQ(bag.topics()[0].messages, 20'000u);
  const std::vector<StoredMessage> messages = bag.find(bag.topics());
  ASSERT_EQ(messages.size(), 20'000u);
  EXPECT_TRUE(std::ranges::is_sorted(messages, {}, [](const StoredMessage& message) {
    return std::pair(message.time, message.offset);
  })) << "by time, those of one time as they were recorded";
}

TEST_F(SqliteBagTest, TellsWhereEachMessageOfEachTopicIs) {
  write_db3(path_, {row_at(30, {0}, "/b"), row_at(10, {100, 0}, "/b"), row_at(20, {0}, "/a"),
                    row_at(10, {0}, "/b")});
  SqliteBag bag(path_, "shown", 5000);
  std::vector<BagTopic> topics = bag.topics();
  ASSERT_EQ(topics.size(), 2u);
  std::ranges::reverse(topics);
  topics.push_back({"/b", "another/msg/Type", "cdr", 0});
  std::vector<std::tuple<std::int64_t, std::size_t, std::uint64_t, std::uint64_t>> found;
  for (const StoredMessage& message : bag.find(topics)) {
    found.emplace_back(message.time, message.topic, message.offset, message.bytes);
    EXPECT_EQ(message.place, 0u);
  }
  const std::uint64_t one = row_at(0, {0}).bytes.size();
  EXPECT_EQ(found, (decltype(found){{10, 0, 2, one + 1}, {10, 0, 4, one}, {30, 0, 1, one}, {20, 1, 3, one}}));
}

TEST_F(SqliteBagTest, ATopicWithoutMessagesIsATopicAndNoMap) {
  write_db3(path_, {row_at(1, {0}, "/a"), row_at(2, {0}, "/b")});
  run_sql(path_, "DELETE FROM messages WHERE timestamp = 2");
  const Bag bag(path_);
  ASSERT_EQ(bag.topics().size(), 2u);
  EXPECT_EQ(bag.topics()[1].messages, 0u);
  ASSERT_EQ(bag.map_topics().size(), 1u);
  EXPECT_EQ(bag.map_topics()[0].name, "/a");
  EXPECT_EQ(BagMaps(bag).topic(), "/a") << "the only one of which there is a map";
  EXPECT_EQ(test::message_of<EmptyTopic>([&] { BagMaps(bag, "b").last(); }),
            path_ + ": has no message on /b");
}

TEST_F(SqliteBagTest, TopicsOfOneNameAndTypeAreOne) {
  write_db3(path_, {row_at(1, {0}, "/a"), row_at(2, {0}, "/b"), row_at(3, {0}, "/b")});
  run_sql(path_, "UPDATE topics SET name = '/map'");
  const Bag bag(path_);
  ASSERT_EQ(bag.topics().size(), 1u);
  EXPECT_EQ(bag.topics()[0].messages, 3u);
  EXPECT_EQ(bag.topics()[0].encoding, "cdr");
  EXPECT_EQ(all_cells(bag).size(), 3u);
}

TEST_F(SqliteBagTest, TopicsAreNotEndless) {
  write_db3(path_, {row_at(1, {0, 100})});
  run_sql(path_,
          "WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n WHERE i < 65536) "
          "INSERT INTO topics SELECT i, 'n' || i, 't', 'cdr', '' FROM n");
  EXPECT_EQ(SqliteBag(path_, "shown", 5000).topics().size(), 65'536u);
  run_sql(path_, "INSERT INTO topics VALUES (65537, 'n', 't', 'cdr', '')");
  EXPECT_EQ(test::message_of<FileError>([&] { SqliteBag(path_, "shown", 5000); }),
            "shown: it has more than 65536 topics");
}

TEST_F(SqliteBagTest, AJournalThatWouldHaveToBePlayedBackIsNamed) {
  write_db3(path_, {row_at(1, {0, 100})});
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path_.c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, "PRAGMA synchronous = OFF; BEGIN; UPDATE messages SET timestamp = 5;",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  const std::string copy = directory_.write("copy.db3", test::read_file(path_));
  directory_.write("copy.db3-journal", test::read_file(path_ + "-journal"));
  sqlite3_close(database);
  EXPECT_EQ(error_of(copy),
            copy +
                ": copy.db3-journal beside it holds what a recorder wrote last, and reading that takes "
                "writing beside it: copy both files to a folder of yours");
}

// What SQLite asks of a file, as it asks.
TEST_F(SqliteBagTest, AFileAtRestIsReadAndNothingElse) {
  const char* const name = internal::sqlite_reading();
  ASSERT_NE(name, nullptr);
  EXPECT_EQ(internal::sqlite_reading(), name);
  sqlite3_vfs* const system = sqlite3_vfs_find(name);
  ASSERT_NE(system, nullptr);
  EXPECT_NE(system, sqlite3_vfs_find(nullptr)) << "other databases of the program are opened as ever";
  std::vector<std::max_align_t> memory(static_cast<std::size_t>(system->szOsFile) / sizeof(std::max_align_t) +
                                       1);
  auto* const file = reinterpret_cast<sqlite3_file*>(memory.data());
  constexpr int kFlags = SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_READONLY;
  EXPECT_EQ(system->xOpen(system, directory_.file("none").c_str(), file, kFlags, nullptr), SQLITE_CANTOPEN);
  EXPECT_EQ(file->pMethods, nullptr) << "so it is not closed";

  const std::string path = directory_.write("a", "0123456789");
  ASSERT_EQ(system->xOpen(system, path.c_str(), file, kFlags, nullptr), SQLITE_OK);
  EXPECT_EQ(file->pMethods->xClose(file), SQLITE_OK);
  int flags = 0;
  ASSERT_EQ(system->xOpen(system, path.c_str(), file, kFlags | SQLITE_OPEN_URI, &flags), SQLITE_OK);
  EXPECT_EQ(flags, kFlags);
  const sqlite3_io_methods& can = *file->pMethods;
  EXPECT_EQ(can.iVersion, 1) << "it can neither share nor map memory";
  std::string room = "......";
  EXPECT_EQ(can.xRead(file, room.data(), 4, 3), SQLITE_OK);
  EXPECT_EQ(room, "3456..");
  EXPECT_EQ(can.xRead(file, room.data(), 3, 7), SQLITE_OK);
  EXPECT_EQ(room, "7896..");
  EXPECT_EQ(can.xRead(file, room.data(), 5, 8), SQLITE_IOERR_SHORT_READ);
  EXPECT_EQ(room, std::string("89\0\0\0.", 6)) << "zeros behind its end, as SQLite wants them";
  EXPECT_EQ(can.xRead(file, room.data(), 1, 10), SQLITE_IOERR_SHORT_READ);
  EXPECT_EQ(room, std::string("\0\x39\0\0\0.", 6));
  sqlite3_int64 size = 0;
  EXPECT_EQ(can.xFileSize(file, &size), SQLITE_OK);
  EXPECT_EQ(size, 10);
  EXPECT_EQ(can.xWrite(file, "x", 1, 0), SQLITE_READONLY);
  EXPECT_EQ(can.xTruncate(file, 1), SQLITE_READONLY);
  EXPECT_EQ(can.xSync(file, SQLITE_SYNC_FULL), SQLITE_OK);
  EXPECT_EQ(can.xLock(file, SQLITE_LOCK_SHARED), SQLITE_OK);
  int is_reserved = 1;
  EXPECT_EQ(can.xCheckReservedLock(file, &is_reserved), SQLITE_OK);
  EXPECT_EQ(is_reserved, 0);
  EXPECT_EQ(can.xUnlock(file, SQLITE_LOCK_NONE), SQLITE_OK);
  EXPECT_EQ(can.xFileControl(file, SQLITE_FCNTL_PRAGMA, nullptr), SQLITE_NOTFOUND);
  EXPECT_EQ(can.xSectorSize(file), 4096);
  EXPECT_EQ(can.xDeviceCharacteristics(file), SQLITE_IOCAP_IMMUTABLE);
  EXPECT_EQ(can.xClose(file), SQLITE_OK);
  EXPECT_EQ(can.xRead(file, room.data(), 1, 0), SQLITE_IOERR_READ) << "it is closed";
  EXPECT_EQ(test::read_file(path), "0123456789");

  std::string full(20, '?');
  EXPECT_EQ(system->xFullPathname(system, "/proc/self/fd/7", 20, full.data()), SQLITE_OK);
  EXPECT_STREQ(full.c_str(), "/proc/self/fd/7") << "as it is named, wherever that leads";
}

TEST_F(SqliteBagTest, IsToldByItsFirstSixteenBytes) {
  const std::string begin("SQLite format 3\0", 16);
  EXPECT_TRUE(looks_like_sqlite(begin));
  EXPECT_TRUE(looks_like_sqlite(begin + "more"));
  EXPECT_FALSE(looks_like_sqlite(begin.substr(0, 15)));
  EXPECT_FALSE(looks_like_sqlite("SQLite format 3 and more"));
  EXPECT_FALSE(looks_like_sqlite(""));
}

TEST_F(SqliteBagTest, ValuesOfOtherTypesAreNoMaps) {
  write_db3(path_, {row_at(1, {0, 100})});
  run_sql(path_, "UPDATE messages SET data = 17");
  EXPECT_TRUE(contains(error_of(path_), "is damaged"));
  run_sql(path_, "UPDATE messages SET data = ''");
  EXPECT_TRUE(contains(error_of(path_), "is damaged"));
  run_sql(path_, "UPDATE topics SET name = x'ff00'");
  EXPECT_TRUE(contains(error_of(path_), "has no message"));
}

TEST_F(SqliteBagTest, ANameOfOddCharactersIsAName) {
  const std::string odd = directory_.file("50% ?of #1.db3");
  write_db3(odd, {row_at(1, {0, 100})});
  EXPECT_EQ(all_cells(Bag(odd)), (Rows{cells_of({0, 100})}));
}

TEST_F(SqliteBagTest, AQueryEndsWhenTheWorkIsCancelled) {
  write_db3(path_, {row_at(1, {0, 100})});
  const std::atomic<bool> cancelled = true;
  EXPECT_THROW(with_cancellation(cancelled, [&] { const Bag bag(path_); }), Cancelled);
}

TEST_F(SqliteBagTest, DamageIsAnErrorOrHarmless) {
  std::vector<Recorded> messages;
  for (std::int8_t i = 0; i < 20; ++i) messages.push_back(row_at(i, {0, 100, i, 50}));
  write_db3(path_, messages);
  const std::string whole = test::read_file(path_);
  std::mt19937 random(7);
  std::size_t refused = 0;
  for (int run = 0; run < 2000; ++run) {
    std::string file = whole;
    if (run % 10 == 0) file.resize(random() % file.size());
    for (unsigned changes = 1 + random() % 8; changes > 0 && !file.empty(); --changes)
      file[random() % file.size()] = static_cast<char>(random());
    const std::string path = directory_.write("damaged.db3", file);
    try {
      const Bag bag(path, {.max_cells = 10'000});
      for (const BagTopic& topic : bag.map_topics()) all_cells(bag, topic.name);
    } catch (const FileError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path)) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 100u);
  EXPECT_LT(refused, 2000u);
}

}  // namespace
}  // namespace gridmerge
