// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "io/faulty_disk.hpp"
#include "io/file_size_limit.hpp"
#include "io/spool_file.hpp"
#include "io/support.hpp"
#include "io/temporary_file.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;
using test::read_file;
using test::TemporaryDirectory;
using Names = std::vector<std::string>;

std::string error_of(const std::filesystem::path& path) {
  return test::message_of<FileError>([&] { write_file_atomically(path, "new"); });
}

TEST(AtomicFile, WritesAllBytes) {
  const TemporaryDirectory directory;
  const std::string binary("a\0b\r\n\xff", 6);
  write_file_atomically(directory.file("a"), binary);
  EXPECT_EQ(read_file(directory.file("a")), binary);
  write_file_atomically(directory.file("empty"), "");
  EXPECT_EQ(read_file(directory.file("empty")), "");
  EXPECT_EQ(directory.names(), (Names{"a", "empty"}));
}

TEST(AtomicFile, ReplacesAFile) {
  const TemporaryDirectory directory;
  directory.write("a", "a long old content");
  write_file_atomically(directory.file("a"), "new");
  EXPECT_EQ(read_file(directory.file("a")), "new");
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(AtomicFile, ShowsNothingBeforeCommit) {
  const TemporaryDirectory directory;
  directory.write("a", "old");
  StagedFile staged(directory.file("a"), "new");
  EXPECT_EQ(read_file(directory.file("a")), "old");
  staged.commit();
  EXPECT_EQ(read_file(directory.file("a")), "new");
}

TEST(AtomicFile, MayBeWrittenInPieces) {
  const TemporaryDirectory directory;
  directory.write("a", "old");
  StagedFile staged(directory.file("a"));
  staged.append("ne");
  staged.append("w, in pieces");
  EXPECT_EQ(read_file(directory.file("a")), "old");
  staged.commit();
  EXPECT_EQ(read_file(directory.file("a")), "new, in pieces");
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(SpoolFile, HoldsWhatIsWrittenLaterAndHasNoName) {
  const TemporaryDirectory directory;
  std::string all;
  StagedFile staged(directory.file("a"));
  {
    SpoolFile spool(directory.file("a")), other(directory.file("a"));
    for (int i = 0; i < 300; ++i) {
      const std::string piece(static_cast<std::size_t>(7919 * i % 10007), static_cast<char>('a' + i % 26));
      spool.append(piece);
      all += piece;
    }
    other.append("other");
    EXPECT_EQ(spool.size(), all.size());
    EXPECT_EQ(directory.names().size(), 1u) << "the staged one alone";
    other.copy_to(staged);
    spool.copy_to(staged);
  }
  staged.commit();
  EXPECT_EQ(read_file(directory.file("a")), "other" + all);
  EXPECT_EQ(directory.names(), Names{"a"});
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { SpoolFile(directory.file("no/such/a")); }),
                       "a: cannot be written: No such file"));
}

// What an errno says counts only after a call that failed. In a child, as it might go on for ever.
TEST(SpoolFile, IsCopiedAfterACallThatASignalHadEnded) {
  const TemporaryDirectory directory;
  SpoolFile spool(directory.file("a"));
  spool.append("all of it");
  StagedFile staged(directory.file("a"));
  EXPECT_EXIT(
      {
        ::alarm(10);
        errno = EINTR;
        spool.copy_to(staged);
        ::_exit(0);
      },
      testing::ExitedWithCode(0), "");
}

// Where nothing failed, an errno that a signal has left says nothing. In a child, as it might go on for ever.
TEST(SpoolFile, ThatADiskHasLostPartOfIsAnError) {
  const TemporaryDirectory directory;
  const int next = ::dup(STDOUT_FILENO);
  ::close(next);
  SpoolFile spool(directory.file("a"));  // takes the number that was free
  spool.append("all of it");
  ASSERT_EQ(::ftruncate(next, 3), 0);
  StagedFile staged(directory.file("a"));
  EXPECT_EXIT(
      {
        ::alarm(10);
        errno = EINTR;
        const std::string error = test::message_of<FileError>([&] { spool.copy_to(staged); });
        ::_exit(error == directory.file("a") + ": cannot be written: Input/output error" ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

TEST(AtomicFile, DisappearsWithoutCommit) {
  const TemporaryDirectory directory;
  {
    const StagedFile staged(directory.file("a"), "new");
    EXPECT_EQ(directory.names().size(), 1u);
  }
  EXPECT_EQ(directory.names(), Names{});
}

TEST(AtomicFile, ManyAreStagedAtOnce) {
  const TemporaryDirectory directory;
  {
    StagedFile a(directory.file("a"), "a");
    StagedFile b(directory.file("b"), "b");
    const StagedFile c(directory.file("c"), "c");
    a.commit();
    b.commit();
  }
  EXPECT_EQ(directory.names(), (Names{"a", "b"}));
  EXPECT_EQ(read_file(directory.file("a")), "a");
  EXPECT_EQ(read_file(directory.file("b")), "b");
}

TEST(AtomicFile, HasThePermissionsOfAnyNewFile) {
  const TemporaryDirectory directory;
  const mode_t before = umask(027);
  write_file_atomically(directory.file("a"), "x");
  umask(before);
  EXPECT_EQ(std::filesystem::status(directory.file("a")).permissions(),
            static_cast<std::filesystem::perms>(0640));
}

TEST(AtomicFile, TakesNamesOfTheGreatestLength) {
  const TemporaryDirectory directory;
  const std::string name(255, 'x');
  write_file_atomically(directory.file(name), "x");
  EXPECT_EQ(directory.names(), Names{name});
}

TEST(AtomicFile, WorksWithoutADirectoryInThePath) {
  const TemporaryDirectory directory;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(directory.path());
  write_file_atomically("a", "x");
  std::filesystem::current_path(before);
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(AtomicFile, RefusesDirectories) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(contains(error_of(directory.path()), "it names a directory"));
  EXPECT_TRUE(contains(error_of(directory.file("a/")), "it names a directory"));
  EXPECT_TRUE(contains(error_of(""), "it names a directory"));
  EXPECT_EQ(directory.names(), Names{});
}

TEST(AtomicFile, ReplacesWhatALinkLeadsTo) {
  const TemporaryDirectory directory;
  directory.write("elsewhere/a", "old");
  std::filesystem::create_symlink("elsewhere/a", directory.file("link"));
  write_file_atomically(directory.file("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(directory.file("link")));
  EXPECT_EQ(read_file(directory.file("elsewhere/a")), "new");
}

TEST(AtomicFile, ReplacesALinkThatLeadsToNothing) {
  const TemporaryDirectory directory;
  std::filesystem::create_symlink("elsewhere", directory.file("link"));
  write_file_atomically(directory.file("link"), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(directory.file("link")));
  EXPECT_EQ(read_file(directory.file("link")), "new");
  EXPECT_EQ(directory.names(), Names{"link"});
}

TEST(AtomicFile, RefusesWhatIsNoRegularFile) {
  const TemporaryDirectory directory;
  ASSERT_EQ(mkfifo(directory.file("pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/null", directory.file("link"));
  EXPECT_TRUE(contains(error_of(directory.file("pipe")), "it is not a regular file"));
  EXPECT_TRUE(contains(error_of(directory.file("link")), "it is not a regular file"));
  EXPECT_TRUE(std::filesystem::is_fifo(directory.file("pipe")));
}

TEST(AtomicFile, NeedsADirectoryThatItCanWriteTo) {
  const TemporaryDirectory directory;
  EXPECT_EQ(error_of(directory.file("missing/a")),
            directory.file("missing/a") + ": cannot be written: No such file or directory");
  directory.write("file", "x");
  EXPECT_EQ(error_of(directory.file("file/a")),
            directory.file("file/a") + ": cannot be written: Not a directory");
}

TEST(AtomicFile, LeavesAllAsItWasWhenItCannotTakeItsPlace) {
  const TemporaryDirectory directory;
  {
    StagedFile staged(directory.file("a"), "new");
    directory.write("a/b", "in the way");
    EXPECT_TRUE(contains(test::message_of<FileError>([&] { staged.commit(); }), "a: cannot be written: "));
  }
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(AtomicFile, RemovesWhatAKilledProgramHasLeft) {
  const TemporaryDirectory directory;
  const Names others{".gridmerge-1-2.tmp.txt", ".gridmerge-x-1.tmp", ".gridmerge-12.tmp", ".gridmerge.tmp"};
  for (const std::string& name : others) directory.write(name, "mine");
  directory.write(".gridmerge-999999-0.tmp", "left");
  directory.write(".gridmerge-1-12.tmp", "left");
  {
    const StagedFile unfinished(directory.file("a"), "new");  // of a program that still runs
    write_file_atomically(directory.file("b"), "new");
    EXPECT_EQ(directory.names().size(), others.size() + 2);
  }
  Names expected = others;
  expected.emplace_back("b");
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(directory.names(), expected);
}

// One writer's file gets its final name while another looks at it; the name may be a third one's by then.
TEST(AtomicFile, LeavesTheFilesOfThoseWhoWriteAtTheSameTime) {
  const TemporaryDirectory directory;
  std::atomic<bool> is_over = false;
  std::vector<std::thread> cleaners;
  for (int i = 0; i < 4; ++i)
    cleaners.emplace_back([&] {
      while (!is_over) remove_abandoned(directory.path());
    });
  const std::filesystem::path final = directory.file("final");
  int gone = 0;
  for (int i = 0; i < 5000; ++i) {
    const TemporaryFile created = create_beside(final);
    gone += std::rename(created.path.c_str(), final.c_str()) != 0;
    ::close(created.descriptor);
  }
  is_over = true;
  for (std::thread& cleaner : cleaners) cleaner.join();
  EXPECT_EQ(gone, 0);
  EXPECT_EQ(directory.names(), Names{"final"});
}

TEST(AtomicFile, RemovesWhatAKilledProgramHasLeftWithoutStandardInputToo) {
  const TemporaryDirectory directory;
  directory.write(".gridmerge-999999-0.tmp", "left");
  const int input = ::dup(STDIN_FILENO);
  ::close(STDIN_FILENO);  // the next file that is opened is descriptor 0
  remove_abandoned(directory.path());
  ::dup2(input, STDIN_FILENO);
  ::close(input);
  EXPECT_EQ(directory.names(), Names{});
}

TEST(AtomicFile, LeavesNoDescriptorOpen) {
  const TemporaryDirectory directory;
  const auto before = test::count_open_files();
  write_file_atomically(directory.file("a"), "new");
  {
    SpoolFile spool(directory.file("b"));
    spool.append("new");
  }
  EXPECT_EQ(test::count_open_files(), before);
}

TEST(AtomicFile, WhatIsAppendedToAFlushedFileIsFlushedAsWell) {
  const TemporaryDirectory directory;
  test::FaultyDisk disk;
  StagedFile staged(directory.file("a"), "new");
  staged.append(" and newer");
  staged.commit();
  EXPECT_EQ(disk.flushed, (std::vector<std::uintmax_t>{3, 13}));
}

TEST(AtomicFile, IsFlushedAgainAfterASignal) {
  const TemporaryDirectory directory;
  test::FaultyDisk disk;
  disk.flush_errors = {EINTR, EINTR};
  EXPECT_NO_THROW(write_file_atomically(directory.file("a"), "new"));
  EXPECT_EQ(disk.flushed, std::vector<std::uintmax_t>{3});
}

TEST(AtomicFile, ADiskThatCannotBeFlushedIsAnErrorAndOneThatNeverIsIsNone) {
  const TemporaryDirectory directory;
  directory.write("a", "old");
  test::FaultyDisk disk;
  disk.flush_errors = {EIO};
  EXPECT_EQ(error_of(directory.file("a")), directory.file("a") + ": cannot be written: Input/output error");
  EXPECT_EQ(read_file(directory.file("a")), "old");
  disk.flush_errors = {EINVAL, ENOTSUP};  // of the file, and of its directory
  EXPECT_NO_THROW(write_file_atomically(directory.file("a"), "new"));
  EXPECT_EQ(read_file(directory.file("a")), "new");
}

TEST(AtomicFile, LeavesAllAsItWasOnAFullDisk) {
  const TemporaryDirectory directory;
  directory.write("a", "old");
  const std::string message = test::with_file_size_limit(
      1000, [&] { write_file_atomically(directory.file("a"), std::string(100000, 'x')); });
  EXPECT_EQ(message, directory.file("a") + ": cannot be written: File too large");
  EXPECT_EQ(read_file(directory.file("a")), "old");
  EXPECT_EQ(directory.names(), Names{"a"});
}

}  // namespace
}  // namespace gridmerge
