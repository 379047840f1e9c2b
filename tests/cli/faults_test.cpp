// SPDX-License-Identifier: Apache-2.0
// Every call that writes fails once, and the program is killed at each: see fault_shim.cpp.
#include "faults.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

#include "support/effort.hpp"

namespace gridmerge::test {
namespace {

/// Every call, or under a sanitizer one of some.
constexpr int kStep = test::repeats(1, 9);

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
    const int calls = count();
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

TEST_F(Faults, AnEndedMergeLeavesNothingBehind) {
  signal_at_each_call(Over::old_set, SIGTERM);
}

TEST_F(Faults, AMergeWhoseTerminalIsClosedLeavesNothingBehind) {
  signal_at_each_call(Over::nothing, SIGHUP);
}

TEST_F(Faults, WithoutLinksFilesAreReplacedOneByOne) {
  write_old("o");
  ASSERT_EQ(run(merge_into("o"), with_fault("refuse 0")).exit_code, 0);
  expect_order(Over::old_set);
  write_old("o");
  ASSERT_EQ(run(merge_into("o"), with_fault("refuse 0")).exit_code, 0);
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
    old_alone.erase("merged_7.yaml");
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
  const int calls = count();
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

}  // namespace
}  // namespace gridmerge::test
