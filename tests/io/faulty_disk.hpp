// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <vector>

namespace gridmerge::test {

/// While it lives, calls of this test program fail as they do on a disk that is broken, or that has no links.
/// One at a time, for tests with one thread.
class FaultyDisk {
 public:
  FaultyDisk();
  ~FaultyDisk();
  FaultyDisk(const FaultyDisk&) = delete;
  FaultyDisk& operator=(const FaultyDisk&) = delete;

  int link_error = 0;       ///< the errno of every symbolic link; 0: they are made
  int hard_link_error = 0;  ///< of every second name of a file
  std::function<void(const std::filesystem::path&)> at_flush = {};   ///< called before each flush
  std::function<void(const std::filesystem::path&)> at_unlink = {};  ///< and before a name is removed
  std::deque<int> flush_errors;              ///< the errnos of the next flushes, after which all succeed
  std::vector<std::uintmax_t> flushed = {};  ///< the sizes that files had when they were flushed
};

}  // namespace gridmerge::test
