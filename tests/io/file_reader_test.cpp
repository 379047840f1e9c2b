// SPDX-License-Identifier: Apache-2.0
#include "io/file_reader.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <limits>
#include <string>

#include "gridmerge/io/file_error.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge::internal {
namespace {

class FileReaderTest : public testing::Test {
 protected:
  std::string written(const std::string& bytes) const { return directory.write("file", bytes); }

  test::TemporaryDirectory directory;
};

TEST_F(FileReaderTest, TakesFilesUpToTheLimitAndNoByteMore) {
  const std::string bytes(1000, 'x'), path = written(bytes);
  for (const std::size_t limit :
       {std::size_t{1000}, std::size_t{1001}, std::numeric_limits<std::size_t>::max()})
    EXPECT_EQ(FileReader(path).read_all(limit), bytes) << limit;
  for (const std::size_t limit : {0U, 1U, 999U}) {
    try {
      FileReader(path).read_all(limit);
      FAIL() << limit;
    } catch (const FileError& error) {
      EXPECT_EQ(std::string(error.what()),
                path + ": the file is larger than " + std::to_string(limit) + " bytes");
    }
  }
  EXPECT_EQ(FileReader(written("")).read_all(0), "");
}

TEST_F(FileReaderTest, ReadsOnFromWhereItIs) {
  // Longer than a step, so that it takes several.
  std::string bytes;
  for (int i = 0; bytes.size() < 3000000; ++i) bytes += std::to_string(i);
  FileReader reader(written(bytes));
  EXPECT_EQ(reader.read_up_to(0), "");
  EXPECT_EQ(reader.read_up_to(4), bytes.substr(0, 4));
  EXPECT_EQ(reader.read_up_to(2), bytes.substr(0, 4));  // what it holds, it holds
  EXPECT_EQ(reader.read_up_to(1500000), bytes.substr(0, 1500000));
  EXPECT_EQ(reader.read_up_to(bytes.size() + 10), bytes);
  EXPECT_EQ(reader.read_all(bytes.size()), bytes);
}

TEST_F(FileReaderTest, SaysWhatIsNoFile) {
  EXPECT_THROW(FileReader(directory.file("missing")), FileError);
  const std::string folder = directory.file("folder"), pipe = directory.file("pipe");
  std::filesystem::create_directory(folder);
  EXPECT_THROW(FileReader(folder).read_all(10), FileError);
  EXPECT_THROW(FileReader(folder, NamedBy::file).read_all(10), FileError);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  // A user may name a pipe; another file may not, and is not waited for.
  EXPECT_THROW(FileReader(pipe, NamedBy::file), FileError);
  EXPECT_EQ(FileReader(written("abc"), NamedBy::file).read_all(3), "abc");
}

}  // namespace
}  // namespace gridmerge::internal
