// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

#include "gridmerge/io/file_error.hpp"
#include "io/file_set.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

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
      while (!is_over) EXPECT_NO_THROW(check_directory(path));
    });
    for (int i = 0; i < 300; ++i) EXPECT_NO_THROW(check_directory(path));
    is_over = true;
    other.join();
  }
}

TEST(CheckDirectory, OneInWhichNoFileCanBeMadeIsAnErrorAtOnce) {
  if (!std::filesystem::exists("/proc/self")) GTEST_SKIP() << "/proc takes no files, and is not here";
  const std::string error = test::message_of<FileError>([] { check_directory("/proc"); });
  EXPECT_EQ(error.find("/proc: cannot be written to: "), 0U) << error;
  EXPECT_EQ(error.find("another program"), std::string::npos) << error;
}

TEST(CheckDirectory, AWorkingDirectoryThatIsGoneIsAnErrorAtOnce) {
  const test::TemporaryDirectory directory;
  EXPECT_EXIT(
      {
        std::filesystem::create_directory(directory.file("gone"));
        std::filesystem::current_path(directory.file("gone"));
        std::filesystem::remove(directory.file("gone"));
        const std::string error = test::message_of<FileError>([] { check_directory("."); });
        ::_exit(error == ".: cannot be written to: No such file or directory" ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace gridmerge
