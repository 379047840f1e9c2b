// SPDX-License-Identifier: Apache-2.0
#include "io/file_set.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/atomic_file.hpp"
#include "io/faulty_disk.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;
using test::read_file;
using test::TemporaryDirectory;
using Names = std::vector<std::string>;

TEST(FileSet, ReplacesTheOldFilesAndRemovesThoseWithoutSuccessor) {
  const TemporaryDirectory directory;
  for (const char* name : {"a", "b", "c", "other"}) directory.write(name, "old");
  FileSet files(directory.path());
  files.add("a", "new a");
  files.add("d", "new d");
  files.remove("b");
  EXPECT_EQ(read_file(directory.file("a")), "old");
  files.commit();
  EXPECT_EQ(read_file(directory.file("a")), "new a");
  EXPECT_EQ(read_file(directory.file("d")), "new d");
  EXPECT_EQ(read_file(directory.file("c")), "old");
  EXPECT_FALSE(std::filesystem::is_symlink(directory.file("a")));
  EXPECT_FALSE(std::filesystem::exists(directory.file("b")));
}

TEST(FileSet, TakesFilesThatWereStagedBefore) {
  const TemporaryDirectory directory;
  for (const char* name : {"a", "b"}) directory.write(name, "old");
  {
    StagedFile a(directory.file("a"), "new a"), b(directory.file("b"));
    b.append("new ");
    FileSet files(directory.path());
    b.append("b");
    files.add(a);
    files.add(b);
    files.add("c", "new c");
    EXPECT_EQ(read_file(directory.file("a")) + read_file(directory.file("b")), "oldold");
    files.commit();
  }
  EXPECT_EQ(read_file(directory.file("a")), "new a");
  EXPECT_EQ(read_file(directory.file("b")), "new b");
  EXPECT_EQ(directory.names(), (Names{"a", "b", "c"}));
  {
    StagedFile staged(directory.file("a"), "newer");
    FileSet files(directory.path());
    files.add(staged);
  }
  EXPECT_EQ(read_file(directory.file("a")), "new a");
  EXPECT_EQ(directory.names(), (Names{"a", "b", "c"}));
}

TEST(FileSet, WithoutCommitNothingHasHappened) {
  const TemporaryDirectory directory;
  directory.write("a", "old");
  {
    FileSet files(directory.path());
    files.add("a", "new");
    FileSet made(directory.path() / "new" / "newer", FileSet::IfMissing::make);
  }
  EXPECT_EQ(read_file(directory.file("a")), "old");
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(FileSet, RemovesStagedFilesOfKilledProgramsAlone) {
  const TemporaryDirectory directory;
  const StagedFile other(directory.file("other"), "of a program that still runs");
  directory.write(".gridmerge-1-0.tmp", "of a program that was killed: nobody has it locked");
  directory.write(".gridmerge-notes.tmp", "of the user");
  const std::size_t staged = 1;
  FileSet files(directory.path());
  files.add("a", "new");
  files.commit();
  EXPECT_FALSE(std::filesystem::exists(directory.file(".gridmerge-1-0.tmp")));
  EXPECT_TRUE(std::filesystem::exists(directory.file(".gridmerge-notes.tmp")));
  const Names names = directory.names();
  EXPECT_EQ(static_cast<std::size_t>(std::count_if(names.begin(), names.end(),
                                                   [](const std::string& name) {
                                                     return name.starts_with(".gridmerge-") &&
                                                            name.ends_with("-0.tmp");
                                                   })),
            staged);
}

TEST(FileSet, PutsInOrderWhatAKilledProgramHasLeft) {
  for (const std::string current : {"old", "new"}) {
    const TemporaryDirectory directory;
    directory.write(".gridmerge.lock", "");
    directory.write(".gridmerge.tmp/old/a", "old a");
    directory.write(".gridmerge.tmp/old/gone", "old gone");
    directory.write(".gridmerge.tmp/new/a", "new a");
    directory.write(".gridmerge.tmp/new/added", "new added");
    directory.write("a", current + " a");  // of which the program had made a file again
    std::filesystem::create_symlink(current, directory.file(".gridmerge.tmp/current"));
    for (const std::string name : {"gone", "added"})
      std::filesystem::create_symlink(".gridmerge.tmp/current/" + name, directory.file(name));
    { const FileSet files(directory.path()); }
    EXPECT_EQ(directory.names(), (Names{"a", current == "old" ? "gone" : "added"}));
    EXPECT_EQ(read_file(directory.file("a")), current + " a");
    EXPECT_FALSE(std::filesystem::is_symlink(directory.file(current == "old" ? "gone" : "added")));
  }
}

TEST(FileSet, ReplacesALinkAndNotWhatItLeadsTo) {
  const TemporaryDirectory directory;
  directory.write("elsewhere/a", "mine");
  std::filesystem::create_symlink("elsewhere/a", directory.file("a"));
  FileSet files(directory.path());
  files.add("a", "new");
  files.commit();
  EXPECT_EQ(read_file(directory.file("a")), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(directory.file("a")));
  EXPECT_EQ(read_file(directory.file("elsewhere/a")), "mine");
}

TEST(FileSet, RefusesWhatIsNoRegularFile) {
  const TemporaryDirectory directory;
  directory.write("folder/file", "mine");
  ASSERT_EQ(mkfifo(directory.file("pipe").c_str(), 0600), 0);
  FileSet files(directory.path());
  const auto error_of = [&](const char* name) {
    return test::message_of<FileError>([&] { files.add(name, "new"); });
  };
  EXPECT_TRUE(contains(error_of("folder"), "it names a directory"));
  EXPECT_TRUE(contains(error_of("pipe"), "it is not a regular file"));
  files.remove("folder");
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { files.commit(); }), "it names a directory"));
  EXPECT_EQ(read_file(directory.file("folder/file")), "mine");
}

TEST(FileSet, RefusesWhatIsInTheWayOfItsFolder) {
  const TemporaryDirectory directory;
  std::filesystem::create_symlink("/tmp", directory.file(".gridmerge.tmp"));
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { const FileSet files(directory.path()); }),
                       ".gridmerge.tmp: is in the way"));
  EXPECT_EQ(directory.names(), Names{".gridmerge.tmp"});
}

TEST(FileSet, NeedsADirectory) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(
      contains(test::message_of<FileError>([&] { const FileSet files(directory.path() / "missing"); }),
               "No such file"));
}

TEST(FileSet, WhereThereAreNoLinksFilesAreReplacedOneByOne) {
  // FAT, and folders that virtual machines share with their hosts.
  for (const int error : {EPERM, ENOSYS, ENOTSUP, EROFS, EPROTO, EINVAL}) {
    const TemporaryDirectory directory;
    for (const char* name : {"a", "b"}) directory.write(name, "old");
    test::FaultyDisk disk;
    disk.link_error = error;
    {
      FileSet files(directory.path());
      files.add("a", "new a");
      files.add("c", "new c");
      files.remove("b");
      EXPECT_NO_THROW(files.commit()) << error;
    }
    EXPECT_EQ(directory.names(), (Names{"a", "c"})) << error;
    EXPECT_EQ(read_file(directory.file("a")) + read_file(directory.file("c")), "new anew c") << error;
  }
}

TEST(FileSet, WhereALinkFailsOtherwiseNothingHasHappened) {
  const TemporaryDirectory directory;
  directory.write("a", "old");
  test::FaultyDisk disk;
  disk.link_error = ENOSPC;
  {
    FileSet files(directory.path());
    files.add("a", "new");
    EXPECT_TRUE(contains(test::message_of<FileError>([&] { files.commit(); }),
                         directory.path().string() + ": cannot be written: No space left on device"));
  }
  EXPECT_EQ(directory.names(), Names{"a"});
  EXPECT_EQ(read_file(directory.file("a")), "old");
}

// Whoever looks while files are replaced, and whoever finds that it failed, sees all old or all new ones. Old
// ones that cannot have a second name for so long are copied.
TEST(FileSet, ShowsAllOldOrAllNewFilesWhicheverFlushFails) {
  for (const int hard_link_error : {0, EPERM, EMLINK}) {
    std::size_t old_ones = 0, new_ones = 0;
    for (bool is_written = false; !is_written;) {
      const TemporaryDirectory directory;
      for (const char* name : {"a", "b"}) directory.write(name, "old");
      const auto shown = [&] {
        std::string files;
        for (const std::string name : {"a", "b", "c"}) {
          if (std::filesystem::exists(directory.file(name)))
            files += name + ": " + read_file(directory.file(name)) + " ";
        }
        return files;
      };
      const std::string all_old = "a: old b: old ", all_new = "a: new c: new ";
      test::FaultyDisk disk;
      disk.hard_link_error = hard_link_error;
      disk.at_flush = [&](const std::filesystem::path&) {
        EXPECT_TRUE(shown() == all_old || shown() == all_new) << shown();
      };
      try {
        FileSet files(directory.path());
        files.add("a", "new");
        files.add("c", "new");
        files.remove("b");
        // Flushes that a disk does not have go well. The one after them fails, if there is one.
        disk.flush_errors.assign(old_ones + new_ones, EINVAL);
        disk.flush_errors.push_back(EIO);
        files.commit();
        is_written = true;
      } catch (const FileError& error) {
        EXPECT_TRUE(contains(error.what(), "Input/output error"));
      }
      const bool is_old = shown() == all_old;
      EXPECT_EQ(shown(), is_old ? all_old : all_new);
      EXPECT_EQ(directory.names(), is_old ? (Names{"a", "b"}) : (Names{"a", "c"}));
      ASSERT_FALSE(is_old && (is_written || new_ones > 0));
      ++(is_old ? old_ones : new_ones);
      ASSERT_LT(old_ones + new_ones, 100U) << "that many flushes are never needed";
    }
    EXPECT_GE(old_ones, hard_link_error == 0 ? 4U : 6U) << "before the turn";
    EXPECT_GE(new_ones, 3U) << "after it, and without a failure";
  }
}

TEST(FileSet, LeavesNoDescriptorOpen) {
  const TemporaryDirectory directory;
  const auto before = test::count_open_files();
  {
    FileSet files(directory.path());
    files.add("a", "new");
    files.commit();
  }
  EXPECT_EQ(test::count_open_files(), before);
}

// The first file that such a program opens is descriptor 0. In a child, as it might wait for its own lock.
TEST(FileSet, ReplacesFilesInAProgramWithoutStandardInput) {
  const TemporaryDirectory directory;
  const auto replace = [&] {
    FileSet files(directory.path());
    files.add("a", "new");
    files.commit();
  };
  EXPECT_EXIT(
      {
        ::alarm(10);
        ::close(STDIN_FILENO);
        replace();
        ::_exit(0);
      },
      testing::ExitedWithCode(0), "");
  EXPECT_EQ(directory.names(), Names{"a"});
}

// As root, who may write everywhere, a child becomes somebody else.
TEST(FileSet, OfAnotherUsersFolderIsRefusedAtOnceAndBesideHisLockOneWaits) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  const TemporaryDirectory directory;
  ::chmod(directory.path().c_str(), 0755);
  std::filesystem::create_directory(directory.path() / "shared");
  ::chmod(directory.file("shared").c_str(), 0777);
  directory.write("shared/.gridmerge.lock", "");
  ::chmod(directory.file("shared/.gridmerge.lock").c_str(), 0644);
  const ::pid_t child = ::fork();
  if (child == 0) {
    constexpr ::uid_t kNobody = 65534;
    const auto begin = std::chrono::steady_clock::now();
    bool is_refused = ::setgid(kNobody) == 0 && ::setuid(kNobody) == 0;
    const std::string error = test::message_of<FileError>([&] { const FileSet files(directory.path()); });
    is_refused = is_refused && contains(error, "cannot be written to: Permission denied") &&
                 std::chrono::steady_clock::now() - begin < std::chrono::seconds(20);
    bool is_written = false;
    try {
      FileSet files(directory.path() / "shared");
      files.add("a", "new");
      files.commit();
      is_written = read_file(directory.file("shared/a")) == "new";
    } catch (const FileError&) {
    }
    ::_exit((is_refused ? 0 : 1) + (is_written ? 0 : 2));
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: not refused at once, 2: not written";
}

TEST(FileSet, OneWritesAtATime) {
  const TemporaryDirectory directory;
  std::vector<std::thread> writers;
  for (const char* content : {"1", "2", "3", "4"}) {
    writers.emplace_back([&directory, content] {
      for (int i = 0; i < 25; ++i) {
        FileSet files(directory.path() / "new", FileSet::IfMissing::make);
        files.add("a", content);
        files.add("b", content);
        if (i % 2 == 0) files.commit();
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(read_file(directory.file("new/a")), read_file(directory.file("new/b")));
  EXPECT_NE(read_file(directory.file("new/a")), "");
  EXPECT_EQ(directory.names(), Names{"new"});
}

TEST(FileSet, WhoWaitsCanBeCancelledAndHasNothingLeftOpen) {
  const TemporaryDirectory directory;
  const FileSet first(directory.path());
  const auto before = test::count_open_files();
  std::atomic<bool> cancelled = false;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    cancelled = true;
  });
  EXPECT_THROW(with_cancellation(cancelled, [&] { const FileSet second(directory.path()); }), Cancelled);
  canceller.join();
  EXPECT_EQ(test::count_open_files(), before);
}

}  // namespace
}  // namespace gridmerge
