// SPDX-License-Identifier: Apache-2.0
#include "bag/sqlite_reading.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "bag/random_access_file.hpp"

namespace gridmerge::internal {

namespace {

constexpr const char* kName = "gridmerge-reading";

/// An open database, as SQLite keeps it: it makes the memory, and no constructor runs.
struct Database {
  sqlite3_file base;
  int descriptor;
};

int descriptor_of(sqlite3_file* file) {
  return reinterpret_cast<Database*>(file)->descriptor;
}

int close_database(sqlite3_file* file) {
  ::close(descriptor_of(file));
  return SQLITE_OK;
}

int read_database(sqlite3_file* file, void* to, int count, sqlite3_int64 offset) {
  char* const bytes = static_cast<char*>(to);
  const auto wanted = static_cast<std::size_t>(count);
  const BytesRead held = try_read_at(descriptor_of(file), static_cast<std::uint64_t>(offset), bytes, wanted);
  if (held.error != 0) return SQLITE_IOERR_READ;
  std::memset(bytes + held.count, 0, wanted - held.count);  // as SQLite asks
  return held.count == wanted ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
}

int tell_size(sqlite3_file* file, sqlite3_int64* size) {
  struct stat status {};
  if (::fstat(descriptor_of(file), &status) != 0) return SQLITE_IOERR_FSTAT;
  *size = status.st_size;
  return SQLITE_OK;
}

const sqlite3_io_methods* methods() {
  static const sqlite3_io_methods methods = [] {
    sqlite3_io_methods made{};
    made.iVersion = 1;
    made.xClose = close_database;
    made.xRead = read_database;
    made.xWrite = [](sqlite3_file*, const void*, int, sqlite3_int64) { return SQLITE_READONLY; };
    made.xTruncate = [](sqlite3_file*, sqlite3_int64) { return SQLITE_READONLY; };
    made.xSync = [](sqlite3_file*, int) { return SQLITE_OK; };
    made.xFileSize = tell_size;
    made.xLock = [](sqlite3_file*, int) { return SQLITE_OK; };
    made.xUnlock = [](sqlite3_file*, int) { return SQLITE_OK; };
    made.xCheckReservedLock = [](sqlite3_file*, int* is_reserved) {
      *is_reserved = 0;
      return SQLITE_OK;
    };
    made.xFileControl = [](sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; };
    made.xSectorSize = [](sqlite3_file*) { return 4096; };
    made.xDeviceCharacteristics = [](sqlite3_file*) { return SQLITE_IOCAP_IMMUTABLE; };
    return made;
  }();
  return &methods;
}

int open_file(sqlite3_vfs* /*reading*/, const char* name, sqlite3_file* file, int flags, int* used_flags) {
  if ((flags & SQLITE_OPEN_MAIN_DB) == 0 || name == nullptr) {  // where SQLite sorts
    sqlite3_vfs* const usual = sqlite3_vfs_find(nullptr);
    return usual->xOpen(usual, name, file, flags, used_flags);
  }
  auto* const database = reinterpret_cast<Database*>(file);
  database->base.pMethods = nullptr;
  database->descriptor = ::open(name, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (database->descriptor < 0) return SQLITE_CANTOPEN;
  database->base.pMethods = methods();
  if (used_flags != nullptr) *used_flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_MAIN_DB;
  return SQLITE_OK;
}

int take_as_named(sqlite3_vfs* /*reading*/, const char* name, int size, char* path) {
  sqlite3_snprintf(size, path, "%s", name);
  return SQLITE_OK;
}

}  // namespace

const char* sqlite_reading() {
  static const bool is_there = [] {
    const sqlite3_vfs* const usual = sqlite3_vfs_find(nullptr);
    if (usual == nullptr) return false;
    static sqlite3_vfs reading = *usual;  // SQLite keeps it
    reading.zName = kName;
    reading.szOsFile = std::max(usual->szOsFile, static_cast<int>(sizeof(Database)));
    reading.xOpen = open_file;
    reading.xFullPathname = take_as_named;
    return sqlite3_vfs_register(&reading, 0) == SQLITE_OK;
  }();
  return is_there ? kName : nullptr;
}

}  // namespace gridmerge::internal
