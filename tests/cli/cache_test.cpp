// SPDX-License-Identifier: Apache-2.0
// Matches that are kept, and shards.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <map>
#include <regex>
#include <thread>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class CacheTest : public CliTest {
 protected:
  std::vector<std::string> with_cache(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{
        "merge", left, middle, right, other, "--cache", directory.file("matches")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  /// transforms.json of a merge, but for its times.
  std::string answer(const std::string& output) const {
    return std::regex_replace(read_file(directory.file(output + "/transforms.json")),
                              std::regex(R"re("seconds": *[0-9.eE+-]+)re"), "");
  }

  void expect_answer_of_one_machine(const std::string& output) {
    if (!std::filesystem::exists(directory.file("plain"))) {
      EXPECT_EQ(run({"merge", left, middle, right, other, "-o", directory.file("plain")}).exit_code, 3);
    }
    const std::string expected = answer("plain");
    EXPECT_GT(expected.size(), 500u);
    EXPECT_EQ(answer(output), expected);
    EXPECT_EQ(read_file(directory.file(output + "/merged.pgm")),
              read_file(directory.file("plain/merged.pgm")));
  }

  std::vector<std::filesystem::path> kept() const {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::exists(directory.file("matches"))) return files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(directory.file("matches")))
      if (entry.is_regular_file() && entry.path().extension() == ".match") files.push_back(entry.path());
    return files;
  }

  static constexpr std::size_t kMatches = 9;  // six pairs, and the stranger's three again

  const std::string middle =
      write_map(directory, "middle", map_part(draw_building(1), {3, 0, 15, 12}, {2.0, 1.0, 2.5}));
};

TEST_F(CacheTest, AMergeThroughItIsThatWithoutIt) {
  const Outcome first = run(with_cache({"-o", directory.file("first")}));
  EXPECT_EQ(first.exit_code, 3) << first.err;
  EXPECT_EQ(first.err, "gridmerge: 0 matches of the cache, 9 made\n");
  expect_answer_of_one_machine("first");
  const Outcome second = run(with_cache({"-o", directory.file("second")}));
  EXPECT_EQ(second.err, "gridmerge: 9 matches of the cache, 0 made\n");
  EXPECT_EQ(run(with_cache({"-o", directory.file("third"), "--quiet"})).err, "");
  expect_answer_of_one_machine("second");
  EXPECT_EQ(read_file(directory.file("second/transforms.json")),
            read_file(directory.file("first/transforms.json")))
      << "with the times, too";
  EXPECT_EQ(kept().size(), kMatches);
}

TEST_F(CacheTest, ShardsAndAMergeAreOneMachine) {
  for (int round = 0; round < 2; ++round) {
    for (int shard = 1; shard <= 3; ++shard) {
      const Outcome outcome = run(with_cache({"--shard", fmt::format("{}/3", shard)}));
      // The third shard makes the first round's last match, and its own of the second round.
      const bool is_all_made = round == 1 && shard >= 2;
      EXPECT_EQ(outcome.exit_code, is_all_made ? 0 : 3) << outcome.out << outcome.err;
      EXPECT_EQ(outcome.err, "");
      EXPECT_EQ(outcome.out.rfind(fmt::format("shard {}/3: ", shard), 0), 0u) << outcome.out;
    }
  }
  EXPECT_EQ(kept().size(), kMatches);
  const Outcome last = run(with_cache({"-o", directory.file("o")}));
  EXPECT_EQ(last.err, "gridmerge: 9 matches of the cache, 0 made\n");
  expect_answer_of_one_machine("o");
}

TEST_F(CacheTest, TheMergeMakesWhatShardsHaveLeft) {
  EXPECT_EQ(run(with_cache({"--shard", "2/3"})).exit_code, 3);
  EXPECT_EQ(kept().size(), 2u);
  const Outcome merged = run(with_cache({"-o", directory.file("o")}));
  EXPECT_EQ(merged.exit_code, 3);
  EXPECT_EQ(merged.err, fmt::format("gridmerge: warning: {}: shards that have not ended here: 1/3, 3/3\n"
                                    "gridmerge: 2 matches of the cache, 7 made\n",
                                    directory.file("matches")));
  EXPECT_EQ(kept().size(), kMatches);
  expect_answer_of_one_machine("o");
}

TEST_F(CacheTest, ShardsThatDoNotFitAreNamed) {
  const std::string told =
      fmt::format("gridmerge: warning: {}: shards do not fit: ", directory.file("matches"));
  const std::string helps = ". Run all shards with the same N, maps, options and version of gridmerge\n";
  EXPECT_EQ(run(with_cache({"--shard", "1/3"})).err, "");
  const std::string numbers = told + "1/3, 2/4 are of different numbers of shards" + helps;
  EXPECT_EQ(run(with_cache({"--shard", "2/4"})).err, numbers) << "a shard waits in vain";
  EXPECT_EQ(run({"merge", left, right, "--cache", directory.file("matches"), "--shard", "2/3"}).exit_code, 0);
  EXPECT_EQ(run(with_cache({"-o", directory.file("o")})).err,
            told +
                "1/3, 2/4 are of different numbers of shards; 2/3 was made with 2 maps, of which 2 are among "
                "the 4 here" +
                helps + "gridmerge: 4 matches of the cache, 5 made\n");
  expect_answer_of_one_machine("o");
  EXPECT_EQ(run(with_cache({"-o", directory.file("p")})).err, "gridmerge: 9 matches of the cache, 0 made\n");
}

TEST_F(CacheTest, ShardsOfOtherMapsOrOptionsAreNotUsed) {
  EXPECT_EQ(
      run({"merge", left, right, "--cache", directory.file("matches"), "--shard", "1/1", "--accept", "0.9"})
          .exit_code,
      0);
  const Outcome outcome = run(with_cache({"-o", directory.file("o")}));
  EXPECT_EQ(
      outcome.err,
      fmt::format("gridmerge: warning: {}: its matches are not used, as they were made with accept 0.9: give "
                  "the same to use them\ngridmerge: 0 matches of the cache, 9 made\n",
                  directory.file("matches")));
  // A map by another name, of another folder, is the same map.
  std::filesystem::create_directories(directory.file("copy"));
  for (const char* name : {"left.yaml", "left.pgm"})
    std::filesystem::copy_file(directory.file(name), directory.file(std::string("copy/") + name));
  const Outcome moved = run({"merge", directory.file("copy/left.yaml"), right, "--cache",
                             directory.file("matches"), "-o", directory.file("p"), "--verbose"});
  EXPECT_NE(moved.err.find("1 match of the cache, 0 made"), std::string::npos) << moved.err;
}

TEST_F(CacheTest, AKilledRunGoesOn) {
  RunOptions kill;
  kill.faulty = true;
  kill.environment = {"GRIDMERGE_FAULT=kill 30"};  // the 30th call that changes what is on the disk
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(run(with_cache({"-o", directory.file("killed")}), kill).signal, SIGKILL);
  }
  EXPECT_GT(kept().size(), 2u);
  EXPECT_LT(kept().size(), kMatches);
  const Outcome outcome = run(with_cache({"-o", directory.file("o")}));
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_EQ(outcome.err.find("checksum"), std::string::npos) << outcome.err;
  expect_answer_of_one_machine("o");
}

TEST_F(CacheTest, TwoAtOnceDisturbNobody) {
  Outcome one, two;
  std::thread beside([&] { one = run(with_cache({"-o", directory.file("one")})); });
  two = run(with_cache({"-o", directory.file("two")}));
  beside.join();
  for (const Outcome* each : {&one, &two})
    EXPECT_TRUE(std::regex_match(each->err, std::regex("gridmerge: \\d match(es)? of the cache, \\d made\n")))
        << each->err;
  expect_answer_of_one_machine("one");
  expect_answer_of_one_machine("two");
}

TEST_F(CacheTest, DamagedFilesAreMatchedAgainWithOneWarning) {
  EXPECT_EQ(run(with_cache({"-o", directory.file("o")})).exit_code, 3);
  const std::vector<std::filesystem::path> files = kept();
  ASSERT_EQ(files.size(), kMatches);
  const std::string good = read_file(files[0]);
  std::ofstream(files[0], std::ios::binary) << good.substr(0, good.size() / 2);
  std::ofstream(files[1], std::ios::binary) << "something else";
  std::ofstream(files[2], std::ios::binary) << good;  // another pair's
  std::ofstream(directory.file("matches/notes.txt")) << "somebody's own";
  const Outcome outcome = run(with_cache({"-o", directory.file("p"), "--verbose"}));
  EXPECT_NE(outcome.err.find("6 matches of the cache, 3 made"), std::string::npos) << outcome.err;
  const std::string told = "it is not used, and its maps are matched again";
  const std::size_t at = outcome.err.find(told);
  ASSERT_NE(at, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find(told, at + 1), std::string::npos) << outcome.err;
  expect_answer_of_one_machine("p");
  EXPECT_EQ(read_file(directory.file("matches/notes.txt")), "somebody's own");
}

TEST_F(CacheTest, AFullDiskCostsTheCacheAndNotTheMerge) {
  RunOptions full;
  full.file_size_limit = 1000;  // [bytes]: less than a match takes
  const Outcome shard = run(with_cache({"--shard", "1/2"}), full);
  expect_error(shard, directory.file("matches"), "cannot be written");
  // The merge's own outputs need a disk that is not full, so single calls fail here.
  RunOptions faulty;
  faulty.faulty = true;
  faulty.environment = {fmt::format("GRIDMERGE_FAULT=fail 18 {}", ENOSPC)};
  const Outcome merged = run(with_cache({"-o", directory.file("o")}), faulty);
  EXPECT_EQ(merged.exit_code, 3) << merged.err;
  EXPECT_EQ(count_lines(merged.err), 2u) << merged.err;
  EXPECT_NE(merged.err.find("No space left on device"), std::string::npos) << merged.err;
  // The call that fails may be the one that makes a rename last: the match is kept then.
  EXPECT_GE(kept().size(), kMatches - 1);
  expect_answer_of_one_machine("o");
}

TEST_F(CacheTest, ADirectoryThatCannotBeWrittenToIsToldBeforeTheWork) {
  const std::string file = directory.write("a_file", "");
  for (const std::string& bad : {file, file + "/below", std::string("/proc/self")}) {
    expect_error(run({"merge", left, right, "--cache", bad, "-o", directory.file("o")}), bad, "cannot be");
    EXPECT_FALSE(std::filesystem::exists(directory.file("o")));
    expect_error(run({"merge", left, right, "--cache", bad, "--shard", "1/2"}), bad, "cannot be");
  }
}

TEST_F(CacheTest, AFailedRunLeavesNoFolderThatItMade) {
  const std::string bad = directory.write("bad.yaml", "image: none.pgm\n");
  for (const auto& [folder, calls] : std::map<std::string, int>{{"matches", 5}, {"deep/matches", 7}}) {
    const std::string cache = directory.file(folder);
    expect_error(run({"merge", left, bad, "--cache", cache, "-o", directory.file("o")}), bad, "");
    expect_error(run({"merge", left, bad, "--cache", cache, "--shard", "1/2"}), bad, "");
    EXPECT_FALSE(std::filesystem::exists(cache));
    // The calls that make the folder, and a file in it on trial: each fails once.
    RunOptions faulty;
    faulty.faulty = true;
    for (int call = 1; call <= calls; ++call) {
      faulty.environment = {fmt::format("GRIDMERGE_FAULT=fail {} {}", call, ENOSPC)};
      expect_error(run({"merge", left, bad, "--cache", cache, "-o", directory.file("o")}, faulty), cache,
                   "No space left on device");
      EXPECT_FALSE(std::filesystem::exists(cache));
      EXPECT_FALSE(std::filesystem::exists(directory.file("deep")));
    }
  }
  std::filesystem::create_directory(directory.file("matches"));
  expect_error(run({"merge", left, bad, "--cache", directory.file("matches"), "-o", directory.file("o")}),
               bad, "");
  EXPECT_TRUE(std::filesystem::exists(directory.file("matches"))) << "it is the user's own";
}

TEST_F(CacheTest, UsageErrors) {
  const auto expect_usage = [](const Outcome& outcome, const std::string& cause) {
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find(cause), std::string::npos) << outcome.err;
  };
  for (const char* bad : {"3/2", "0/2", "1", "/", "1/", "/2", "-1/2", "1/2/3", "a/b", "1/0", "1/2000000", ""})
    expect_usage(run(with_cache({"--shard", bad})), "--shard");
  expect_usage(run({"merge", left, right, "--shard", "1/2"}), "--shard: needs --cache");
  expect_usage(run(with_cache({"--shard", "1/2", "-o", directory.file("o")})), "leave -o out");
  expect_usage(run(with_cache({"--shard", "1/2", "--export", "g2o"})), "--export: excludes --shard");
  expect_usage(run(with_cache({})), "--output is required");
  expect_usage(run(with_cache({"-o", directory.file("o"), "--strategy", "tree"})),
               "--cache: needs --strategy joint");
  expect_usage(run({"evaluate", "pairs.tsv", "--cache", "m", "--search", "random-walk"}), "--cache");
  EXPECT_FALSE(std::filesystem::exists(directory.file("matches")));
}

TEST_F(CacheTest, AnEvaluationThroughItIsThatWithoutIt) {
  const std::string negatives = directory.write("negatives.tsv", "fixed\tmoving\nleft.yaml\tother.yaml\n");
  const std::string sets = directory.write(
      "sets.tsv",
      "set\tmap\tx\ty\ttheta\ttolerance\none\tleft.yaml\t0\t0\t0\t1\none\tother.yaml\t0\t0\t0\t1\n");
  const auto evaluate = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"evaluate", "--negatives", negatives, "--sets", sets, "--json", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  };
  const std::string first = evaluate({"--cache", directory.file("matches")});
  EXPECT_EQ(kept().size(), 3u);  // of the negative, and of the set the quick look and the thorough one
  EXPECT_EQ(evaluate({"--cache", directory.file("matches")}), first) << "with the times";
  const std::regex times(R"re("(seconds|median|p90|max)": *[0-9.eE+-]+)re");
  EXPECT_EQ(std::regex_replace(evaluate({}), times, ""), std::regex_replace(first, times, ""));
}

TEST_F(CacheTest, AnEvaluationOfPairsTellsOfMatchesThatItCannotUse) {
  const std::string negatives = directory.write("negatives.tsv", "fixed\tmoving\nleft.yaml\tother.yaml\n");
  const auto evaluate = [&](const std::string& accept) {
    return run({"evaluate", "--negatives", negatives, "--accept", accept, "--cache",
                directory.file("matches")})
        .err;
  };
  EXPECT_EQ(evaluate("0.95"), "gridmerge: 0 matches of the cache, 1 made\n");
  EXPECT_NE(evaluate("0.9").find("its matches are not used, as they were made with accept 0.95"),
            std::string::npos);
  EXPECT_EQ(evaluate("0.9"), "gridmerge: 1 match of the cache, 0 made\n");
}

}  // namespace
}  // namespace gridmerge::test
