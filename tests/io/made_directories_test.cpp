// SPDX-License-Identifier: Apache-2.0
#include "io/made_directories.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "gridmerge/io/file_error.hpp"
#include "io/faulty_disk.hpp"
#include "io/support.hpp"
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

std::string error_of(const std::filesystem::path& directory) {
  return test::message_of<FileError>([&] { const MadeDirectories made(directory); });
}

TEST(MadeDirectories, ThatCannotBeMadeAreAnError) {
  const test::TemporaryDirectory directory;
  directory.write("file", "");
  EXPECT_EQ(error_of(directory.file("file/a")),
            directory.file("file/a") + ": cannot be created: Not a directory");
}

TEST(MadeDirectories, AreNotMadeBehindALinkToNothing) {
  const test::TemporaryDirectory directory;
  const std::string link = directory.file("link");
  std::filesystem::create_symlink("nowhere", link);
  for (const std::string& path : {link, link + "/", link + "/a/b"})
    EXPECT_EQ(error_of(path), path + ": cannot be created: " + link + " is a link to what is not there");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST(MadeDirectories, ThatMayNotLastAreAnErrorAndAreGone) {
  const test::TemporaryDirectory directory;
  const std::string inner = directory.file("a/b");
  test::FaultyDisk disk;
  for (const std::deque<int>& errors : {std::deque<int>{EIO}, {EINVAL, EIO}}) {  // of either's parent
    disk.flush_errors = errors;
    EXPECT_EQ(error_of(inner), inner + ": cannot be created: Input/output error");
    EXPECT_EQ(directory.names(), std::vector<std::string>{});
  }
  // What another program has removed again need not last; what was there before is not flushed anew.
  disk.flush_errors = {ENOENT, ENOENT, EIO};
  const MadeDirectories made(inner), there(inner);
  EXPECT_EQ(disk.flush_errors.size(), 1U);
}

TEST(MadeDirectories, LastFromTheOutermostOn) {
  const test::TemporaryDirectory directory;
  std::vector<std::filesystem::path> flushed;
  test::FaultyDisk disk;
  disk.at_flush = [&](const std::filesystem::path& path) { flushed.push_back(path); };
  const MadeDirectories made(directory.file("a/b"));
  const std::filesystem::path outer = std::filesystem::canonical(directory.path());
  EXPECT_EQ(flushed, (std::vector<std::filesystem::path>{outer, outer / "a"}));
}

}  // namespace
}  // namespace gridmerge
