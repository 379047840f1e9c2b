// SPDX-License-Identifier: Apache-2.0
// Parts of a file: which bytes, how many, and how many of them are read ahead.
#include "bag/random_access_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "bag/scratch_file.hpp"
#include "bag/support.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using namespace internal;

// Bytes that tell their place.
std::string bytes_of(std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<char>((i * 2654435761U) >> 13);
  return bytes;
}

class RandomAccessFileTest : public testing::Test {
 protected:
  const test::TemporaryDirectory directory_;
};

TEST_F(RandomAccessFileTest, GivesThePartsThatAreAskedFor) {
  const RandomAccessFile file(directory_.write("a", "0123456789"));
  EXPECT_EQ(file.size(), 10u);
  EXPECT_EQ(file.path(), directory_.file("a"));
  EXPECT_EQ(file.read(0, 0), "");
  EXPECT_EQ(file.read(0, 1), "0");
  EXPECT_EQ(file.read(3, 4), "3456");
  EXPECT_EQ(file.read(0, 10), "0123456789");
  EXPECT_EQ(file.read(0, 11), "0123456789");
  EXPECT_EQ(file.read(9, 1), "9");
  EXPECT_EQ(file.read(9, 2), "9");
  EXPECT_EQ(file.read(10, 1), "");
  EXPECT_EQ(file.read(11, 1), "");
  EXPECT_EQ(file.read(std::uint64_t{1} << 63, 1), "");
  std::string room = "........";
  EXPECT_EQ(file.read(8, room.data(), room.size()), 2u);
  EXPECT_EQ(room, "89......") << "nothing is written behind what is read";
  EXPECT_EQ(file.read(2, room.data(), 3), 3u);
  EXPECT_EQ(room, "234.....");
}

TEST_F(RandomAccessFileTest, LongPartsAreReadInWhole) {
  for (const std::size_t size : {(std::size_t{1} << 20) - 1, std::size_t{1} << 20, (std::size_t{1} << 20) + 1,
                                 std::size_t{2} << 20, (std::size_t{5} << 19) + 3}) {
    const std::string bytes = bytes_of(size + 7);
    const RandomAccessFile file(directory_.write("a", bytes));
    EXPECT_TRUE(file.read(7, size) == bytes.substr(7)) << size;
    EXPECT_TRUE(file.read(0, size) == bytes.substr(0, size)) << size;
  }
}

TEST_F(RandomAccessFileTest, AFileThatIsCutShortLaterEndsThere) {
  const std::string path = directory_.write("a", bytes_of(std::size_t{3} << 20));
  const RandomAccessFile file(path);
  const std::size_t kept = (std::size_t{1} << 20) + 5;
  std::filesystem::resize_file(path, kept);
  EXPECT_EQ(file.size(), std::size_t{3} << 20);
  EXPECT_TRUE(file.read(0, file.size()) == bytes_of(kept));
  EXPECT_EQ(file.read(kept - 1, 4).size(), 1u);
  EXPECT_EQ(file.read(kept, 4), "");
}

TEST_F(RandomAccessFileTest, WhatIsAppendedLaterIsNotRead) {
  const std::string path = directory_.write("a", "01234");
  const RandomAccessFile file(path);
  std::ofstream(path, std::ios::app) << "56789";
  EXPECT_EQ(file.read(0, 10), "01234");
  EXPECT_EQ(file.read(3, 10), "34");
  EXPECT_EQ(file.read(5, 10), "");
  std::string room = "..........";
  EXPECT_EQ(file.read(3, room.data(), room.size()), 2u);
  EXPECT_EQ(file.read(5, room.data(), room.size()), 0u);
  EXPECT_EQ(room, "34........");
}

TEST_F(RandomAccessFileTest, ErrorsNameTheFileAsItIsShown) {
  const auto error_of = [](const std::string& path, const std::string& shown) {
    return test::message_of<FileError>([&] { RandomAccessFile(path, shown); });
  };
  const std::string none = directory_.file("none"), folder = directory_.path().string();
  EXPECT_EQ(error_of(none, ""), none + ": No such file or directory");
  EXPECT_EQ(error_of(none, "b.zstd"), "b.zstd: No such file or directory");
  EXPECT_EQ(error_of(folder, ""), folder + ": is not a regular file, which a bag has to be");
  EXPECT_EQ(error_of(folder, "b.zstd"), "b.zstd: is not a regular file, which a bag has to be");
  EXPECT_EQ(RandomAccessFile(directory_.write("a", "x"), "b.zstd").path(), "b.zstd");
}

TEST_F(RandomAccessFileTest, WhatStopsReadingIsTold) {
  char byte = 'x';
  const BytesRead failed = try_read_at(-1, 0, &byte, 1);
  EXPECT_EQ(failed.count, 0u);
  EXPECT_EQ(failed.error, EBADF);
  EXPECT_EQ(test::message_of<FileError>([&] { read_at(-1, 0, &byte, 1, "a.mcap"); }),
            "a.mcap: Bad file descriptor");
  EXPECT_EQ(byte, 'x');

  const int descriptor = ::open(directory_.write("a", "0123").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_GE(descriptor, 0);
  std::string room = "......";
  const BytesRead all = try_read_at(descriptor, 1, room.data(), 6);
  EXPECT_EQ(all.count, 3u);
  EXPECT_EQ(all.error, 0);
  EXPECT_EQ(room, "123...");
  EXPECT_EQ(try_read_at(descriptor, 4, room.data(), 6).count, 0u);
  ::close(descriptor);
}

// The system gives some of its own files in pieces, as it may any.
TEST_F(RandomAccessFileTest, APartThatComesInPiecesIsReadInWhole) {
  const char* const path = "/proc/kallsyms";
  constexpr std::size_t kCount = 30'000, kBegin = 100;
  std::string expected(kBegin + kCount, '\0'), found(kCount, '\0');
  std::ifstream(path).read(expected.data(), static_cast<std::streamsize>(expected.size()));
  const int descriptor = ::open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) GTEST_SKIP() << "there is no such file";
  const ssize_t once = ::pread(descriptor, found.data(), kCount, kBegin);
  const BytesRead read = try_read_at(descriptor, kBegin, found.data(), kCount);
  ::close(descriptor);
  if (once <= 0 || expected.back() == '\0') GTEST_SKIP() << "it cannot be read";
  EXPECT_EQ(read.count, kCount);
  EXPECT_EQ(read.error, 0);
  EXPECT_TRUE(found == expected.substr(kBegin));
}

TEST_F(RandomAccessFileTest, APartTakesOneCallOfTheSystem) {
  const auto calls = [] {  // 0 where the system does not count them
    std::ifstream file("/proc/self/io");
    std::string name;
    for (std::uint64_t value = 0; file >> name >> value;) {
      if (name == "syscr:") return value;
    }
    return std::uint64_t{0};
  };
  const RandomAccessFile file(directory_.write("a", bytes_of(2000)));
  const std::uint64_t before = calls();
  for (std::uint64_t i = 0; i < 1000; ++i) EXPECT_EQ(file.read(i, 1000).size(), 1000u);
  EXPECT_LT(calls() - before, 1100u);
}

std::size_t open_descriptors() {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                                                std::filesystem::directory_iterator()));
}

TEST_F(RandomAccessFileTest, NoFileStaysOpen) {
  const std::string mcap = directory_.write("a.mcap", test::mcap_file({test::row_at(1, {0, 100})}));
  const std::string db3 = directory_.file("a.db3");
  test::write_db3(db3, {test::row_at(1, {0, 100})});
  const std::string packed = directory_.write("a.zstd", test::pack_zstd(test::read_file(db3)));
  const std::string bad = directory_.write("b.db3", test::read_file(db3).substr(0, 600));
  load_any_map(db3);  // SQLite may keep what it opens once
  const std::size_t before = open_descriptors();
  for (const std::string& path : {mcap, db3, packed}) {
    { const Bag bag(path); }
    EXPECT_EQ(load_any_map(path).grid.cells, test::cells_of({0, 100}));
    EXPECT_EQ(open_descriptors(), before) << path;
  }
  EXPECT_THROW(RandomAccessFile{directory_.path()}, FileError);
  EXPECT_THROW(Bag{bad}, FileError);
  { const ScratchFile scratch("a"); }
  EXPECT_EQ(open_descriptors(), before);
}

// Then a file that is opened has the number 0.
TEST_F(RandomAccessFileTest, AProgramWithoutStandardInputReadsBags) {
  const std::string mcap = directory_.write("a.mcap", test::mcap_file({test::row_at(1, {0, 100})}));
  const std::string db3 = directory_.file("a.db3");
  test::write_db3(db3, {test::row_at(1, {100, 0})});
  const std::string packed = directory_.write("b.zstd", test::pack_zstd(test::read_file(mcap)));
  const int input = ::fcntl(0, F_DUPFD_CLOEXEC, 3);
  ::close(0);
  std::vector<std::vector<Cell>> cells;
  std::string error;
  try {
    for (const std::string& path : {mcap, db3, packed}) cells.push_back(load_any_map(path).grid.cells);
    const ScratchFile scratch("a");
  } catch (const FileError& caught) {
    error = caught.what();
  }
  if (input >= 0) {
    ::dup2(input, 0);
    ::close(input);
  }
  EXPECT_EQ(error, "");
  EXPECT_EQ(cells, (std::vector<std::vector<Cell>>{test::cells_of({0, 100}), test::cells_of({100, 0}),
                                                   test::cells_of({0, 100})}));
}

TEST_F(RandomAccessFileTest, AScratchFileGivesBackWhatItTook) {
  ScratchFile scratch("shown.zstd");
  EXPECT_EQ(scratch.size(), 0u);
  EXPECT_EQ(scratch.read(0, 0), "");
  scratch.append("0123");
  scratch.append("");
  scratch.append("45");
  EXPECT_EQ(scratch.size(), 6u);
  EXPECT_EQ(scratch.read(0, 6), "012345");
  EXPECT_EQ(scratch.read(3, 2), "34");
  EXPECT_EQ(test::read_file(scratch.path()), "012345");
  EXPECT_EQ(test::message_of<FileError>([&] { scratch.read(3, 4); }),
            "shown.zstd: what it unpacked to is gone from the folder of temporary files");
}

class BufferedReaderTest : public testing::Test {
 protected:
  static constexpr std::size_t kBytes = std::size_t{1} << 20;
  using Part = std::pair<std::uint64_t, std::size_t>;  // where, and how many bytes

  // Whether these reads leave the bytes from `begin` to `end` in memory, and none behind them: what is held
  // is as the file was, all else as it is now.
  void expect_held(const std::vector<Part>& parts, std::uint64_t begin, std::uint64_t end) {
    const std::string path = directory_.write("a", std::string(kBytes, 'o'));
    const RandomAccessFile file(path);
    BufferedReader reader(file);
    for (const auto& [offset, count] : parts) EXPECT_EQ(reader.read(offset, count), std::string(count, 'o'));
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary) << std::string(kBytes, 'n');
    EXPECT_EQ(reader.read(begin, 1), "o");
    EXPECT_EQ(reader.read(end - 1, 1), "o") << begin << " to " << end;
    EXPECT_TRUE(reader.read(begin, static_cast<std::size_t>(end - begin)) ==
                std::string(static_cast<std::size_t>(end - begin), 'o'));
    EXPECT_EQ(reader.read(end, 1), "n") << begin << " to " << end;
  }

  const test::TemporaryDirectory directory_;
};

TEST_F(BufferedReaderTest, GivesThePartsThatAreAskedFor) {
  const std::string bytes = bytes_of(300'000);
  const RandomAccessFile file(directory_.write("a", bytes));
  BufferedReader reader(file);
  std::uint64_t place = 1;
  for (int i = 0; i < 2000; ++i) {
    place = place * 6364136223846793005U + 1442695040888963407U;
    // Most steps are short ones forwards, some lead anywhere.
    const std::size_t offset = i % 5 == 0 ? (place >> 33) % 310'000 : (std::size_t{37} * i * i) % 310'000;
    const std::size_t count = i % 50 == 0 ? 70'000 : (place >> 20) % 40;
    const std::string expected = offset < bytes.size() ? bytes.substr(offset, count) : std::string();
    ASSERT_TRUE(reader.read(offset, count) == expected) << offset << " " << count;
  }
}

TEST_F(BufferedReaderTest, EndsWhereTheFileDoes) {
  const RandomAccessFile file(directory_.write("a", "0123456789"));
  BufferedReader reader(file);
  EXPECT_EQ(reader.read(10, 1), "");
  EXPECT_EQ(reader.read(200'000, 1), "");
  EXPECT_EQ(reader.read(9, 1), "9");
  EXPECT_EQ(reader.read(9, 5), "9");
  EXPECT_EQ(reader.read(10, 0), "");
  EXPECT_EQ(reader.read(0, 20), "0123456789");
  EXPECT_EQ(reader.read(4, 3), "456");
  EXPECT_EQ(reader.read(10, 3), "");
}

TEST_F(BufferedReaderTest, ReadsAheadOfSmallSteps) {
  expect_held({{0, 1}}, 0, 65'536);
  expect_held({{65'535, 1}}, 65'535, 131'071);
  expect_held({{0, 1}, {70'000, 1}}, 70'000, 135'536);
  expect_held({{0, 1}, {131'071, 1}}, 131'071, 196'607);
  expect_held({{200'000, 1}, {201'023, 2}}, 201'023, 266'559);
}

TEST_F(BufferedReaderTest, ReadsLittleBehindALongStep) {
  expect_held({{65'536, 1}}, 65'536, 66'560);
  expect_held({{0, 1}, {131'072, 1}}, 131'072, 132'096);
  expect_held({{200'000, 1}, {199'999, 1}}, 199'999, 201'023);
  expect_held({{200'000, 1}, {0, 1}}, 0, 1024);
}

TEST_F(BufferedReaderTest, ReadsAllThatIsAskedFor) {
  expect_held({{0, 100'000}}, 0, 100'000);
  expect_held({{300'000, 2000}}, 300'000, 302'000);
  expect_held({{300'000, 1024}}, 300'000, 301'024);
}

TEST_F(BufferedReaderTest, ReadsNothingAgainThatIsHeld) {
  expect_held({{100'000, 5}, {100'000, 5}, {100'900, 124}, {101'023, 1}}, 100'000, 101'024);
}

}  // namespace
}  // namespace gridmerge
