// SPDX-License-Identifier: Apache-2.0
#include "io/directory_names.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "io/faulty_disk.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

namespace fs = std::filesystem;

TEST(DirectoryNames, AreThoseOfAllThatIsInIt) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"file", ".hidden", "folder/inside"}) directory.write(name, "");
  fs::create_symlink("nowhere", directory.file("link"));
  std::error_code error = std::make_error_code(std::errc::io_error);
  std::vector<std::string> names = names_in(directory.path(), error);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{".hidden", "file", "folder", "link"}));
  EXPECT_FALSE(error);
  names_in(directory.file("folder"), error);
  EXPECT_FALSE(error);
  EXPECT_TRUE(names_in(directory.file("missing"), error).empty());
  EXPECT_EQ(error, std::errc::no_such_file_or_directory);
  names_in(directory.file("file"), error);
  EXPECT_EQ(error, std::errc::not_a_directory);
  EXPECT_FALSE(names_in("", error).empty()) << "the working directory";
}

TEST(RemoveDirectory, TakesWhatIsInItButNotWhatLinksLeadTo) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"kept/file", "gone/file", "gone/deep/deeper/file"}) directory.write(name, "");
  fs::create_directory_symlink(directory.file("kept"), directory.file("gone/link"));
  remove_directory(directory.file("gone"));
  EXPECT_FALSE(fs::exists(directory.file("gone")));
  EXPECT_TRUE(fs::exists(directory.file("kept/file")));
  EXPECT_THROW(remove_directory(directory.file("gone")), fs::filesystem_error);
  EXPECT_THROW(remove_directory(directory.file("kept/file")), fs::filesystem_error);
  EXPECT_TRUE(fs::exists(directory.file("kept/file")));
}

TEST(RemoveDirectory, TakesItForRemovedWhatAnotherProgramRemovesMeanwhile) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"gone/a", "gone/b"}) directory.write(name, "");
  test::FaultyDisk disk;
  disk.at_unlink = [](const fs::path& path) { fs::remove(path); };
  EXPECT_NO_THROW(remove_directory(directory.file("gone")));
  EXPECT_EQ(directory.names(), std::vector<std::string>{});
}

TEST(RemoveDirectory, SaysWhichFileStays) {
  const test::TemporaryDirectory directory;
  const std::string file = directory.write("folder/file", "");
  test::FaultyDisk disk;
  disk.at_unlink = [](const fs::path& path) {  // just then another program puts a folder there
    fs::remove(path);
    fs::create_directory(path);
  };
  const std::string message =
      test::message_of<fs::filesystem_error>([&] { remove_directory(directory.file("folder")); });
  EXPECT_TRUE(test::contains(message, "cannot be removed: Is a directory [" + file + "]"));
}

TEST(RemoveDirectory, SaysSoWhereTheDirectoryItselfCannotGo) {
  const test::TemporaryDirectory directory;
  directory.write("stays/file", "");
  // The system removes no directory that is named by a dot.
  const std::string message =
      test::message_of<fs::filesystem_error>([&] { remove_directory(directory.file("stays/.")); });
  EXPECT_TRUE(test::contains(message, "cannot be removed: Invalid argument")) << message;
  EXPECT_TRUE(fs::is_empty(directory.file("stays")));
}

}  // namespace
}  // namespace gridmerge
