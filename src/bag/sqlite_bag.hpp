// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bag/bag_storage.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace gridmerge::internal {

/// Whether a file's first bytes are those of an SQLite database.
bool looks_like_sqlite(std::string_view bytes);

/// A rosbag2 file of the plugin sqlite3: a table of topics and one of messages. The database is opened for
/// reading, and nothing in it is run: views, triggers and functions of its schema are not trusted.
class SqliteBag : public BagStorage {
 public:
  /// Messages of more than `max_message_bytes` are refused before memory is taken for them. Errors name the
  /// file `shown`. O(messages).
  SqliteBag(const std::filesystem::path& path, std::filesystem::path shown, std::size_t max_message_bytes);
  ~SqliteBag() override;

  const std::vector<BagTopic>& topics() const override { return topics_; }
  std::vector<StoredMessage> find(const std::vector<BagTopic>& topics) override;
  std::string read(const StoredMessage& message) override;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

  void open(const std::filesystem::path& path);
  void check_tables();
  void read_topics();
  Statement prepare(const std::string& sql);
  bool step(sqlite3_stmt* statement);
  [[noreturn]] void throw_error() const;
  template <typename Work>
  auto working(const Work& work);

  std::filesystem::path shown_;
  std::filesystem::path log_;  // that a recorder has left; empty if none
  std::size_t max_message_bytes_;
  std::unique_ptr<sqlite3, Close> database_;
  std::vector<BagTopic> topics_;
};

}  // namespace gridmerge::internal
