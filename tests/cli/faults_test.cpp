// SPDX-License-Identifier: Apache-2.0
// Every call that writes fails once, and the program is killed at each; so fail allocations and starts of
// threads: see faulty_calls.cpp.
#include "faults.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "support/effort.hpp"

namespace gridmerge::test {
namespace {

/// Every call, or under a sanitizer one of some.
constexpr int kStep = test::repeats(1, 9);

/// Whether the program may run on one core only, and starts no thread then. This heeds taskset and the cores
/// that a container has, unlike std::thread::hardware_concurrency().
bool may_use_one_core_only() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return sched_getaffinity(0, sizeof(cores), &cores) == 0 && CPU_COUNT(&cores) == 1;
}

class Faults : public FaultTest {
 protected:
  enum class Over { nothing, old_set };

  /// Runs a merge for each call that writes, with a fault there: `fault` and the call's number, then `rest`.
  /// Calls `check` with the outcome and what is found then, after which a merge without faults has to leave
  /// its own set alone.
  template <typename Check>
  void at_each_call(Over over, const std::string& fault, const std::string& rest, const Check& check) {
    const auto prepare = [&] {
      std::filesystem::remove_all(directory.file("o"));
      if (over == Over::old_set) write_old("o");
    };
    prepare();
    ASSERT_EQ(run(merge_into("o"), with_fault("none 0")).exit_code, 0);
    const int calls = counts().calls;
    ASSERT_GT(calls, 40);
    for (int call = 1; call <= calls; call += kStep) {
      SCOPED_TRACE(fmt::format("call {} of {}", call, calls));
      prepare();
      const Files before = outputs_of(files_in(directory.file("o")));
      const Outcome outcome = run(merge_into("o"), with_fault(fmt::format("{} {} {}", fault, call, rest)));
      const Files after = files_in(directory.file("o"));
      EXPECT_TRUE(outputs_of(after) == before || outputs_of(after) == new_set) << "a mixed set";
      EXPECT_EQ(after.contains("notes"), over == Over::old_set);
      check(outcome, outputs_of(after) == before);
      if (call % 4 == 1) expect_order(over);
    }
  }

  /// A merge without faults leaves nothing but its own set, and what is not its own.
  void expect_order(Over over) {
    ASSERT_EQ(run(merge_into("o")).exit_code, 0);
    Files expected = new_set;
    if (over == Over::old_set) expected["notes"] = old_set["notes"];
    EXPECT_EQ(names_in("o"), names_of(expected));
    EXPECT_TRUE(files_in(directory.file("o")) == expected);
  }

  std::set<std::string> names_in(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory.file(folder)))
      names.insert(entry.path().filename().string() + (entry.is_symlink() ? " (a link)" : ""));
    return names;
  }

  static std::set<std::string> names_of(const Files& files) {
    std::set<std::string> names;
    for (const auto& [name, content] : files) names.insert(name);
    return names;
  }

  /// The old set and nothing else.
  void expect_untouched(Over over) const {
    if (over == Over::nothing) {
      EXPECT_FALSE(std::filesystem::exists(directory.file("o")));
    } else {
      EXPECT_EQ(names_in("o"), names_of(old_set));
    }
  }

  void kill_at_each_call(Over over) {
    bool was_old = false, was_new = false;
    at_each_call(over, "kill", "", [&](const Outcome& outcome, bool is_old) {
      EXPECT_EQ(outcome.signal, SIGKILL);
      (is_old ? was_old : was_new) = true;
    });
    EXPECT_TRUE(was_old && was_new);
  }

  void fail_each_call(Over over) {
    at_each_call(over, "fail", std::to_string(ENOSPC), [&](const Outcome& outcome, bool is_old) {
      if (outcome.exit_code == 0) {
        EXPECT_FALSE(is_old) << "it said that it was done";
        return;
      }
      expect_error(outcome, directory.file("o"), "No space left on device");
      if (is_old) expect_untouched(over);
    });
  }

  /// A merge over the old set in which that fails. It is an error which says so and leaves the old set, or,
  /// where there is another way, the new set. Returns whether the merge left nothing else.
  bool expect_whole_set(const std::string& fault, const std::string& threads,
                        const std::vector<std::string>& causes) {
    SCOPED_TRACE(fault);
    write_old("o");
    const Outcome outcome = run(merge_into("o", "0.2", threads), with_fault(fault));
    const Files after = outputs_of(files_in(directory.file("o")));
    EXPECT_EQ(outcome.signal, 0) << outcome.err;
    if (outcome.exit_code == 0) {
      EXPECT_TRUE(after == new_set);
      return true;
    }
    EXPECT_TRUE(after == outputs_of(old_set) || after == new_set) << "a mixed set";
    const auto found = std::find_if(causes.begin(), causes.end(), [&](const std::string& cause) {
      return outcome.err.find(cause) != std::string::npos;
    });
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(count_lines(outcome.err), 1u) << outcome.err;
    EXPECT_EQ(outcome.err.find("gridmerge: "), 0u) << outcome.err;
    EXPECT_NE(found, causes.end()) << outcome.err;
    return !std::filesystem::exists(directory.file("o/.gridmerge.tmp"));
  }

  /// Of 20 runs, each with another allocation that fails, those which say this.
  int allocations_that_tell(const std::vector<std::string>& command, const std::string& text) const {
    constexpr int kRuns = 20;
    run(command, with_fault("none 0"));
    const int allocations = counts().allocations;
    EXPECT_GT(allocations, 1000);
    int told = 0;
    for (int i = 1; i <= kRuns; ++i) {
      const Outcome outcome =
          run(command, with_fault(fmt::format("memory {}", i * (allocations / (kRuns + 1)))));
      told += outcome.exit_code == 1 && outcome.err.find(text) != std::string::npos ? 1 : 0;
    }
    return told;
  }

  void signal_at_each_call(Over over, int signal) {
    bool was_old = false, was_new = false;
    at_each_call(over, "signal", std::to_string(signal), [&](const Outcome& outcome, bool is_old) {
      EXPECT_EQ(outcome.signal, signal);
      EXPECT_EQ(outcome.err, "");
      (is_old ? was_old : was_new) = true;
      if (is_old) {
        expect_untouched(over);
      } else {
        EXPECT_FALSE(std::filesystem::exists(directory.file("o/.gridmerge.tmp")));
        EXPECT_FALSE(std::filesystem::exists(directory.file("o/.gridmerge.lock")));
      }
    });
    EXPECT_TRUE(was_old && was_new);
  }
};

TEST_F(Faults, AKilledMergeLeavesTheOldSetOrTheNewOne) {
  kill_at_each_call(Over::old_set);
}

TEST_F(Faults, AKilledMergeIntoANewFolderLeavesAllOrNothing) {
  kill_at_each_call(Over::nothing);
}

TEST_F(Faults, AFailedCallIsAnErrorThatLeavesTheOldSet) {
  fail_each_call(Over::old_set);
}

TEST_F(Faults, AFailedCallInANewFolderIsAnErrorThatLeavesNothing) {
  fail_each_call(Over::nothing);
}

// All of the first ones, in which the command line and the maps are read, and a sample of the rest, of which
// there are some ten thousand.
TEST_F(Faults, AFailedAllocationIsAnErrorThatLeavesTheOldSet) {
  write_old("o");
  ASSERT_EQ(run(merge_into("o"), with_fault("none 0")).exit_code, 0);
  const int allocations = counts().allocations;
  ASSERT_GT(allocations, 5000);
  const int first = test::repeats(400, 20), step = test::repeats(97, 997);
  int runs = 0, untidy = 0;
  for (int i = 1; i <= allocations; i += i < first ? 1 : step, ++runs) {
    const bool is_tidy =
        expect_whole_set(fmt::format("memory {}", i), "1",
                         // The last one is of a thread for which there is no memory.
                         {"ut of memory", "needs more memory than there is", "insufficient memory",
                          "Cannot allocate memory", "pthread_create has failed"});
    untidy += is_tidy ? 0 : 1;
  }
  // Where a library may not throw, the program ends as if it were killed: at one allocation of a hundred. Of
  // a small sample a few may be such.
  EXPECT_LE(untidy, 3 + runs / 40);
  expect_order(Over::old_set);
}

TEST_F(Faults, WithoutMemoryTheMapsOfTheWorkAreNamed) {
  const std::vector<std::string> match{"match", a, b, "--threads", "1"};
  const std::string match_named = fmt::format(
      "out of memory while matching {} (50 x 50 cells) and {} (50 x 50 cells): maps of larger cells", a, b);
  EXPECT_GE(allocations_that_tell(match, match_named), 10);
  const std::string merge_named = "out of memory while merging 2 maps, the largest of which is " + a +
                                  " (50 x 50 cells): larger cells take less (of the merged map: "
                                  "--output-resolution)";
  EXPECT_GE(allocations_that_tell(merge_into("o"), merge_named), 10);
}

TEST_F(Faults, AThreadThatCannotBeStartedIsAnErrorThatLeavesTheOldSet) {
  write_old("o");
  ASSERT_EQ(run(merge_into("o", "0.2", "4"), with_fault("none 0")).exit_code, 0);
  const int threads = counts().threads;
  if (threads == 0 && may_use_one_core_only()) GTEST_SKIP() << "one core, so that no thread is started";
  EXPECT_GT(threads, 0);
  for (int i = 1; i <= threads; ++i)
    EXPECT_TRUE(expect_whole_set(fmt::format("thread {}", i), "4", {"Resource temporarily unavailable"}));
}

TEST_F(Faults, AnEndedMergeLeavesNothingBehind) {
  signal_at_each_call(Over::old_set, SIGTERM);
}

TEST_F(Faults, AMergeWhoseTerminalIsClosedLeavesNothingBehind) {
  signal_at_each_call(Over::nothing, SIGHUP);
}

TEST_F(Faults, AFolderThatIsMadeIsFlushedInItsParent) {
  RunOptions logged;
  logged.faulty = true;
  logged.environment = {"GRIDMERGE_FAULT_LOG=" + directory.file("log")};
  ASSERT_NE(
      run({"merge", a, b, "-o", directory.file("made/for/o"), "--cache", directory.file("made/matches")},
          logged)
          .exit_code,
      1);
  ASSERT_EQ(run({"simulate", "--size", "12x8", "--robots", "1", "--others", "0", "-o", directory.file("s/t")},
                logged)
                .exit_code,
            0);
  std::ifstream log(directory.file("log"));
  std::map<std::filesystem::path, bool>
      flushed;  // of folders that were made: whether their parents were since
  for (std::string call, path; log >> call && std::getline(log >> std::ws, path);) {
    if (call == "mkdir" && std::filesystem::exists(path)) flushed[std::filesystem::canonical(path)] = false;
    for (auto& [folder, is_flushed] : flushed) is_flushed |= call == "fsync" && path == folder.parent_path();
  }
  for (const char* folder : {"made", "made/for", "made/for/o", "made/matches", "s", "s/t"})
    EXPECT_EQ(flushed.count(directory.file(folder)), 1u) << folder;
  EXPECT_GT(flushed.size(), 6u) << "matches are in folders of their own";
  for (const auto& [folder, is_flushed] : flushed) EXPECT_TRUE(is_flushed) << folder;
}

TEST_F(Faults, WithoutLinksFilesAreReplacedOneByOne) {
  // FAT, and folders that virtual machines share with their hosts.
  for (const int error : {EPERM, EROFS, EPROTO}) {
    write_old("o");
    ASSERT_EQ(run(merge_into("o"), with_fault("refuse " + std::to_string(error))).exit_code, 0);
    expect_order(Over::old_set);
  }
  write_old("o");
  ASSERT_EQ(run(merge_into("o"), with_fault("refuse 1")).exit_code, 0);
  Files expected = new_set;
  expected["notes"] = old_set["notes"];
  EXPECT_EQ(names_in("o"), names_of(expected));
}

TEST_F(Faults, TheSetIsWholeWhileItIsReplaced) {
  write_old("o");
  const Files before = outputs_of(files_in(directory.file("o")));
  std::atomic<bool> done = false;
  std::thread writer([&] {
    EXPECT_EQ(run(merge_into("o")).exit_code, 0);
    done = true;
  });
  // A YAML is opened, then the picture that it names: if both are of one moment, they are of one set.
  int mixed = 0, looks = 0;
  while (!done) {
    const auto picture_before = read_file(directory.file("o/merged.pgm"));
    const auto yaml = read_file(directory.file("o/merged.yaml"));
    const auto picture = read_file(directory.file("o/merged.pgm"));
    const std::string& own =
        yaml == new_set["merged.yaml"] ? new_set["merged.pgm"] : old_set.at("merged.pgm");
    mixed += picture_before == picture && picture != own;
    ++looks;
  }
  writer.join();
  EXPECT_EQ(mixed, 0) << "of " << looks;
}

TEST_F(Faults, TwoMergesIntoOneFolderBothEndWell) {
  for (int i = 0; i < 10; ++i) {
    std::filesystem::remove_all(directory.file("o"));
    std::thread first([&] { EXPECT_EQ(run(merge_into("o")).exit_code, 0); });
    std::this_thread::sleep_for(std::chrono::milliseconds(3 * i));
    const Outcome second = run(merge_into("o", "0.1"));
    EXPECT_EQ(second.exit_code, 0) << second.err;
    first.join();
    Files old_alone = outputs_of(old_set);
    old_alone.erase("merged.g2o");
    const Files found = files_in(directory.file("o"));
    EXPECT_TRUE(found == new_set || found == old_alone);
    EXPECT_EQ(names_in("o"), names_of(found)) << "nothing else is left";
  }
}

TEST_F(Faults, ASingleFileIsReplacedWholeAndItsLeftoversAreCleared) {
  const std::string pairs = directory.write("pairs.tsv", "fixed\tmoving\na.yaml\tb.yaml\n");
  const auto evaluate = [&](const std::string& fault) {
    return run({"evaluate", "--negatives", pairs, "--json", directory.file("j/result.json")},
               with_fault(fault));
  };
  directory.write("j/result.json", "old");
  ASSERT_EQ(evaluate("none 0").exit_code, 0);
  const int calls = counts().calls;
  ASSERT_GT(calls, 5);
  for (int call = 1; call <= calls; call += kStep) {
    SCOPED_TRACE(call);
    directory.write("j/result.json", "old");
    EXPECT_EQ(evaluate("kill " + std::to_string(call)).signal, SIGKILL);
    const std::string found = read_file(directory.file("j/result.json"));
    EXPECT_TRUE(found == "old" || Json::accept(found)) << found;
    EXPECT_EQ(evaluate("none 0").exit_code, 0);
    EXPECT_EQ(names_in("j"), std::set<std::string>{"result.json"});
    EXPECT_EQ(evaluate("signal " + std::to_string(call) + " 15").signal, SIGTERM);
    EXPECT_EQ(names_in("j"), std::set<std::string>{"result.json"});
  }
}

TEST_F(Faults, AGeoTiffIsReplacedWhole) {
  write_old("o");
  ASSERT_EQ(run(merge_into("o"), with_fault("none 0")).exit_code, 0);
  const auto export_it = [&](const std::string& fault) {
    return run({"report", directory.file("o"), "--export", "geotiff=" + directory.file("t/m.tif")},
               with_fault(fault));
  };
  directory.write("t/m.tif", "old");
  ASSERT_EQ(export_it("none 0").exit_code, 0);
  const int calls = counts().calls;
  const std::string whole = read_file(directory.file("t/m.tif"));
  ASSERT_GT(calls, 5);
  for (int call = 1; call <= calls; call += kStep) {
    SCOPED_TRACE(call);
    directory.write("t/m.tif", "old");
    EXPECT_EQ(export_it("kill " + std::to_string(call)).signal, SIGKILL);
    const std::string found = read_file(directory.file("t/m.tif"));
    EXPECT_TRUE(found == "old" || found == whole);
    directory.write("t/m.tif", "old");
    const Outcome failed = export_it("fail " + std::to_string(call) + " " + std::to_string(ENOSPC));
    EXPECT_TRUE(failed.exit_code == 0 || failed.exit_code == 1);
    EXPECT_EQ(failed.err.find("No space left on device") == std::string::npos, failed.exit_code == 0);
    const std::string left_there = read_file(directory.file("t/m.tif"));
    EXPECT_TRUE(left_there == whole || (failed.exit_code != 0 && left_there == "old"));
    EXPECT_EQ(export_it("none 0").exit_code, 0);
    EXPECT_EQ(names_in("t"), std::set<std::string>{"m.tif"}) << "leftovers are cleared by the next";
  }
}

TEST_F(Faults, TheGeoTiffsOfAllMergedMapsAreReplacedTogether) {
  const std::string c = write_map(directory, "c", map_part(draw_building(2), {0, 0, 5, 5}, {}));
  const std::string copy = write_map(directory, "copy", map_part(draw_building(2), {0, 0, 5, 5}, {}));
  std::vector<std::string> merge = merge_into("o");
  merge.insert(merge.begin() + 3, {c, copy});
  ASSERT_NE(run(merge).exit_code, 1);
  ASSERT_TRUE(std::filesystem::exists(directory.file("o/merged_2.yaml")));
  const auto export_it = [&](const std::string& fault) {
    return run({"report", directory.file("o"), "--export", "geotiff=" + directory.file("t/m.tif")},
               with_fault(fault));
  };
  const auto prepare = [&] {
    std::filesystem::remove_all(directory.file("t"));
    for (const char* name : {"t/m.tif", "t/m_2.tif"}) directory.write(name, "old");
  };
  prepare();
  const Files before = files_in(directory.file("t"));
  ASSERT_EQ(export_it("none 0").exit_code, 0);
  const Files whole = files_in(directory.file("t"));
  ASSERT_EQ(names_in("t"), (std::set<std::string>{"m.tif", "m_2.tif"}));
  const int calls = counts().calls;
  bool was_old = false, was_new = false;
  for (int call = 1; call <= calls; call += kStep) {
    SCOPED_TRACE(call);
    for (const std::string& fault : {fmt::format("kill {}", call), fmt::format("fail {} {}", call, ENOSPC)}) {
      prepare();
      export_it(fault);
      Files after = files_in(directory.file("t"));
      std::erase_if(after, [](const auto& file) { return file.first.starts_with("."); });
      EXPECT_TRUE(after == before || after == whole) << fault << ": a mixed set";
      (after == before ? was_old : was_new) = true;
    }
    if (call % 9 == 1) {
      ASSERT_EQ(export_it("none 0").exit_code, 0);
      EXPECT_EQ(names_in("t"), (std::set<std::string>{"m.tif", "m_2.tif"}))
          << "leftovers are cleared by the next";
    }
  }
  EXPECT_TRUE(was_old && was_new);
}

}  // namespace
}  // namespace gridmerge::test
