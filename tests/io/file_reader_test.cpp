// SPDX-License-Identifier: Apache-2.0
#include "io/file_reader.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <limits>
#include <string>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/support.hpp"
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

TEST_F(FileReaderTest, WhatItHoldsAndNothingAtAllNeedNoFile) {
  const std::string folder = directory.file("folder");
  std::filesystem::create_directory(folder);
  EXPECT_EQ(FileReader(folder).read_up_to(0), "");
  FileReader reader(written("abc"));
  reader.read_up_to(2);
  const std::atomic<bool> cancelled = true;
  with_cancellation(cancelled, [&] { EXPECT_EQ(reader.read_up_to(2), "ab"); });
  EXPECT_THROW(with_cancellation(cancelled, [&] { reader.read_up_to(3); }), Cancelled);
}

TEST_F(FileReaderTest, LeavesNoDescriptorOpen) {
  const std::string path = written("abc"), pipe = directory.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto before = test::count_open_files();
  FileReader(path).read_all(3);
  EXPECT_THROW(FileReader(path).read_all(2), FileError);
  EXPECT_THROW(FileReader(pipe, NamedBy::file), FileError);
  EXPECT_EQ(test::count_open_files(), before);
}

TEST_F(FileReaderTest, ReadsInAProgramWithoutStandardInput) {
  const std::string path = written("abc");
  const int input = ::dup(STDIN_FILENO);
  ::close(STDIN_FILENO);  // the next file that is opened is descriptor 0
  std::string bytes;
  EXPECT_NO_THROW(bytes = FileReader(path).read_all(3));
  ::dup2(input, STDIN_FILENO);
  ::close(input);
  EXPECT_EQ(bytes, "abc");
}

int end_of_pipe = -1;
volatile std::sig_atomic_t signals = 0;

// Each signal ends the call that waits; the third one brings what it waits for.
extern "C" void write_at_last(int) {
  signals = signals + 1;
  if (signals == 3 && ::write(end_of_pipe, "abc", 3) != 3) ::_exit(1);
}

TEST_F(FileReaderTest, WaitsOnAfterASignal) {
  const std::string path = directory.file("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  end_of_pipe = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(end_of_pipe, 0);
  FileReader reader(path);
  struct sigaction action {
  }, before{};
  action.sa_handler = write_at_last;
  signals = 0;
  ::sigaction(SIGALRM, &action, &before);
  const itimerval every{{0, 10'000}, {0, 10'000}}, never{};
  ::setitimer(ITIMER_REAL, &every, nullptr);
  std::string bytes;
  EXPECT_NO_THROW(bytes = reader.read_up_to(3));
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ::sigaction(SIGALRM, &before, nullptr);
  ::close(end_of_pipe);
  EXPECT_EQ(bytes, "abc");
}

}  // namespace
}  // namespace gridmerge::internal
