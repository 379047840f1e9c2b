// SPDX-License-Identifier: Apache-2.0
#include "bag/sqlite_bag.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <limits>
#include <map>
#include <new>
#include <set>
#include <system_error>
#include <utility>

#include "bag/sqlite_reading.hpp"
#include "gridmerge/grid/execution.hpp"
#include "io/blaming.hpp"

namespace gridmerge::internal {

namespace {

constexpr int kStepsBetweenLooks = 10'000;  // of SQLite's machine: well below a millisecond

// Ends a query when the work is cancelled. SQLite's own frames must not see an exception.
int ends_query(void*) {
  try {
    throw_if_cancelled();
    return 0;
  } catch (const Cancelled&) {
    return 1;
  }
}

// As a URI, in which these characters mean something.
std::string uri_of(const std::filesystem::path& path, bool is_at_rest) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#') {
      uri += fmt::format("%{:02x}", static_cast<unsigned>(c));
    } else {
      uri += c;
    }
  }
  return uri + (is_at_rest ? "?mode=ro&immutable=1" : "?mode=ro");
}

// What a recorder that still writes, or was killed, has left beside the database; nothing after one that
// ended well. Then it can be read without any of the files that SQLite makes beside one.
std::filesystem::path log_of(const std::filesystem::path& path) {
  std::error_code error;
  for (const char* const ending : {"-wal", "-journal"}) {
    std::filesystem::path log = path;
    log += ending;
    if (std::filesystem::exists(log, error)) return log;
  }
  return {};
}

// The file itself, where links lead to it: its log lies beside that.
std::filesystem::path without_links(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::path file = std::filesystem::canonical(path, error);
  return error ? path : file;
}

std::string text_of(sqlite3_stmt* statement, int column) {
  const unsigned char* text = sqlite3_column_text(statement, column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text),
          static_cast<std::size_t>(sqlite3_column_bytes(statement, column))};
}

}  // namespace

bool looks_like_sqlite(std::string_view bytes) {
  return bytes.starts_with(std::string_view("SQLite format 3\0", 16));
}

void SqliteBag::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

void SqliteBag::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

template <typename Work>
auto SqliteBag::working(const Work& work) {
  return blaming(shown_, work);
}

SqliteBag::SqliteBag(const std::filesystem::path& path, std::filesystem::path shown,
                     std::size_t max_message_bytes)
    : shown_(std::move(shown)), max_message_bytes_(max_message_bytes) {
  working([&] {
    open(path);
    check_tables();
    read_topics();
  });
}

SqliteBag::~SqliteBag() = default;

void SqliteBag::open(const std::filesystem::path& path) {
  sqlite3* database = nullptr;
  const std::filesystem::path file = without_links(path);
  log_ = log_of(file);
  const bool is_at_rest = log_.empty();
  const int code = sqlite3_open_v2(uri_of(file, is_at_rest).c_str(), &database,
                                   SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX,
                                   is_at_rest ? sqlite_reading() : nullptr);
  database_.reset(database);
  if (!database_) throw std::bad_alloc();
  if (code != SQLITE_OK) throw_error();
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  const std::size_t most = std::min<std::size_t>(max_message_bytes_, std::numeric_limits<int>::max());
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(most));
  sqlite3_progress_handler(database, kStepsBetweenLooks, &ends_query, nullptr);
}

void SqliteBag::throw_error() const {
  throw_if_cancelled();  // which is what interrupted the query
  const int code = sqlite3_errcode(database_.get());
  if (code == SQLITE_NOMEM) throw std::bad_alloc();
  if (code == SQLITE_TOOBIG)
    throw ParseError(fmt::format("a message exceeds the limit of {} bytes", max_message_bytes_));
  if (!log_.empty() && (code == SQLITE_CANTOPEN || (code & 0xFF) == SQLITE_READONLY))
    throw ParseError(fmt::format(
        "{} beside it holds what a recorder wrote last, and reading that takes writing beside it: copy "
        "both files to a folder of yours",
        log_.filename().string()));
  throw ParseError(fmt::format("SQLite cannot read it: {}", sqlite3_errmsg(database_.get())));
}

SqliteBag::Statement SqliteBag::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  const int code =
      sqlite3_prepare_v2(database_.get(), sql.c_str(), static_cast<int>(sql.size()), &statement, nullptr);
  Statement prepared(statement);
  if (code != SQLITE_OK) throw_error();
  return prepared;
}

bool SqliteBag::step(sqlite3_stmt* statement) {
  throw_if_cancelled();
  const int code = sqlite3_step(statement);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) throw_error();
  return false;
}

// What else has these names may compute without end.
void SqliteBag::check_tables() {
  const Statement statement = prepare(
      "SELECT name FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages') "
      "AND sql NOT LIKE '%VIRTUAL%'");
  std::set<std::string> tables;
  while (step(statement.get())) tables.insert(text_of(statement.get(), 0));
  for (const char* needed : {"topics", "messages"}) {
    if (!tables.contains(needed))
      throw ParseError(
          fmt::format("is an SQLite database, and no rosbag2 file: it has no table '{}'", needed));
    constexpr int kHidden = 6;  // not 0 of a column that is computed, with the word VIRTUAL or without
    const Statement columns = prepare(fmt::format("PRAGMA table_xinfo({})", needed));
    while (step(columns.get())) {
      if (sqlite3_column_int(columns.get(), kHidden) != 0)
        throw ParseError(fmt::format("is no rosbag2 file: its table '{}' computes a column", needed));
    }
  }
}

void SqliteBag::read_topics() {
  constexpr std::size_t kMaxTopics = std::size_t{1} << 16;
  std::map<std::int64_t, std::uint64_t> counts;
  const Statement counting = prepare("SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id");
  while (step(counting.get()) && counts.size() < kMaxTopics)
    counts[sqlite3_column_int64(counting.get(), 0)] =
        static_cast<std::uint64_t>(sqlite3_column_int64(counting.get(), 1));
  std::map<std::pair<std::string, std::string>, BagTopic> topics;
  const Statement naming = prepare("SELECT id, name, type, serialization_format FROM topics");
  while (step(naming.get())) {
    if (topics.size() == kMaxTopics) throw ParseError(fmt::format("it has more than {} topics", kMaxTopics));
    const std::string name = text_of(naming.get(), 1), type = text_of(naming.get(), 2);
    BagTopic& topic = topics[{name, type}];
    topic.name = name;
    topic.type = type;
    topic.encoding = text_of(naming.get(), 3);
    topic.messages += counts[sqlite3_column_int64(naming.get(), 0)];
  }
  for (auto& [key, topic] : topics) topics_.push_back(std::move(topic));
}

std::vector<StoredMessage> SqliteBag::find(const std::vector<BagTopic>& topics) {
  return working([&] {
    std::vector<StoredMessage> messages;
    for (std::size_t topic = 0; topic < topics.size(); ++topic) {
      const Statement statement = prepare(
          "SELECT messages.rowid, messages.timestamp, LENGTH(messages.data) FROM messages "
          "JOIN topics ON topics.id = messages.topic_id WHERE topics.name = ?1 AND topics.type = ?2 "
          "ORDER BY messages.timestamp, messages.rowid");
      const auto bind = [&](int place, const std::string& text) {
        if (sqlite3_bind_text(statement.get(), place, text.data(), static_cast<int>(text.size()),
                              SQLITE_STATIC) != SQLITE_OK)
          throw_error();
      };
      bind(1, topics[topic].name);
      bind(2, topics[topic].type);
      while (step(statement.get())) {
        if (messages.size() == kMaxMessages)
          throw ParseError(fmt::format("a topic has more than {} messages", kMaxMessages));
        messages.push_back({sqlite3_column_int64(statement.get(), 1), topic, 0,
                            static_cast<std::uint64_t>(sqlite3_column_int64(statement.get(), 0)),
                            static_cast<std::uint64_t>(sqlite3_column_int64(statement.get(), 2))});
      }
    }
    return messages;
  });
}

std::string SqliteBag::read(const StoredMessage& message) {
  return working([&] {
    if (message.bytes > max_message_bytes_)
      throw ParseError(
          fmt::format("a message of {} bytes exceeds the limit of {}", message.bytes, max_message_bytes_));
    const Statement statement = prepare("SELECT data FROM messages WHERE rowid = ?1");
    if (sqlite3_bind_int64(statement.get(), 1, static_cast<std::int64_t>(message.offset)) != SQLITE_OK)
      throw_error();
    if (!step(statement.get())) throw ParseError("a message is gone: does somebody write to the file?");
    const void* bytes = sqlite3_column_blob(statement.get(), 0);
    const auto count = static_cast<std::size_t>(sqlite3_column_bytes(statement.get(), 0));
    return bytes == nullptr ? std::string() : std::string(static_cast<const char*>(bytes), count);
  });
}

}  // namespace gridmerge::internal
