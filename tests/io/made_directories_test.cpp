// SPDX-License-Identifier: Apache-2.0
#include "io/made_directories.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "gridmerge/io/file_error.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

TEST(MadeDirectories, AreGoneWithItUnlessSomethingIsInThem) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path outer = directory.file("a"), inner = directory.file("a/b");
  {
    const MadeDirectories made(inner);
    EXPECT_TRUE(std::filesystem::is_directory(inner));
  }
  EXPECT_FALSE(std::filesystem::exists(outer));
  {
    const MadeDirectories made(inner);
    directory.write("a/b/c", "");
  }
  EXPECT_TRUE(std::filesystem::exists(inner));
}

TEST(CheckDirectory, LeavesNothingAndNamesWhatIsInTheWay) {
  const test::TemporaryDirectory directory;
  check_directory(directory.file("a/b"));
  EXPECT_FALSE(std::filesystem::exists(directory.file("a")));
  directory.write("file", "");
  EXPECT_THROW(check_directory(directory.file("file/b")), FileError);
}

TEST(CheckDirectory, TwoThatLookAtTheSameTimeBothFindThatItCanBeMade) {
  const test::TemporaryDirectory directory;
  for (const char* const name : {"o", "p/q/r"}) {
    const std::filesystem::path path = directory.file(name);
    std::atomic<bool> is_over{false};
    std::thread other([&] {
      while (!is_over) check_directory(path);
    });
    for (int i = 0; i < 300; ++i) EXPECT_NO_THROW(check_directory(path));
    is_over = true;
    other.join();
  }
}

}  // namespace
}  // namespace gridmerge
