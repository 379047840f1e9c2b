// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/cache/match_cache.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "cache/match_file.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

MatchResult some_match(double x) {
  MatchResult match;
  match.T_fixed_moving = {x, -1.0 / 3.0, 0.1};
  match.probability = 0.75;
  match.hypotheses.resize(2);
  return match;
}

class MatchCacheTest : public testing::Test {
 protected:
  MatchCache open() {
    return MatchCache(directory.file("matches"), [this](const std::string& line) { warned.push_back(line); });
  }

  std::string file_of(const std::string& name) const {
    return directory.file("matches/" + name.substr(0, 2) + "/" + name.substr(2) + ".match");
  }

  const test::TemporaryDirectory directory;
  const std::string key = std::string(63, 'a') + "1";
  const std::string other_key = std::string(63, 'a') + "2";
  std::vector<std::string> warned;
};

TEST_F(MatchCacheTest, GivesWhatWasKeptToAnyProcess) {
  MatchCache cache = open();
  EXPECT_FALSE(cache.find(key));
  cache.keep(key, some_match(1.0));
  cache.keep(other_key, some_match(2.0));
  EXPECT_EQ(to_bytes(cache.find(key).value()), to_bytes(some_match(1.0)));
  cache.keep(key, some_match(3.0));  // replaces it
  MatchCache again = open();
  EXPECT_EQ(again.find(key).value().T_fixed_moving.x, 3.0);
  EXPECT_EQ(again.find(other_key).value().T_fixed_moving.x, 2.0);
  EXPECT_TRUE(warned.empty());
  EXPECT_EQ(directory.names(), std::vector<std::string>{"matches"});
}

TEST_F(MatchCacheTest, WhatIsDamagedIsMissingAndToldOnce) {
  MatchCache cache = open();
  cache.keep(key, some_match(1.0));
  const std::string good = test::read_file(file_of(key));
  const std::string name = "matches/" + key.substr(0, 2) + "/" + key.substr(2) + ".match";
  std::vector<std::string> bad{"", "gridmerge match 1\n", "somebody's notes", good + "x",
                               "gridmerge match 2" + good.substr(17)};
  for (std::size_t i = 0; i < good.size(); i += 7) {
    bad.push_back(good.substr(0, i));
    bad.push_back(good);
    bad.back()[i] = static_cast<char>(bad.back()[i] ^ 1);
  }
  for (const std::string& content : bad) {
    directory.write(name, content);
    EXPECT_FALSE(cache.find(key)) << content.size();
  }
  EXPECT_EQ(cache.damaged(), bad.size());
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_NE(warned[0].find(file_of(key)), std::string::npos) << warned[0];
  cache.keep(key, some_match(1.0));
  EXPECT_TRUE(cache.find(key));
}

TEST_F(MatchCacheTest, AFileIsReadUpToSixteenMebibytes) {
  MatchCache cache = open();
  cache.keep(key, some_match(1.0));
  const std::string name = "matches/" + key.substr(0, 2) + "/" + key.substr(2) + ".match";
  directory.write(name, std::string((std::size_t{1} << 24) + 1, 'x'));
  EXPECT_FALSE(cache.find(key));
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_NE(warned[0].find("larger than 16777216 bytes"), std::string::npos) << warned[0];
  EXPECT_NE(warned[0].find("its maps are matched again"), std::string::npos) << warned[0];
}

TEST_F(MatchCacheTest, WhatIsDamagedIsToldByItsKind) {
  const std::string name = "matches/" + key.substr(0, 2) + "/" + key.substr(2) + ".match";
  const auto told = [&](const std::string& content) {
    MatchCache cache = open();
    directory.write(name, content);
    warned.clear();
    EXPECT_FALSE(cache.find(key));
    return warned.size() == 1 ? warned[0] : std::string();
  };
  open().keep(key, some_match(1.0));
  const std::string good = test::read_file(file_of(key));
  EXPECT_NE(told("somebody's notes").find("is no match of this format"), std::string::npos);
  // The format's line, the key's and a digest of 32 bytes are the least that there is.
  const std::size_t least = std::string("gridmerge match 1\n").size() + key.size() + 1 + 32;
  EXPECT_NE(told(good.substr(0, least - 1)).find("is cut short"), std::string::npos);
  EXPECT_NE(told(good.substr(0, least)).find("its checksum is not that of its content"), std::string::npos);
  open().keep(other_key, some_match(1.0));
  EXPECT_NE(told(test::read_file(file_of(other_key))).find("is a match of something else"),
            std::string::npos);
}

TEST_F(MatchCacheTest, AMatchUnderAnothersNameIsMissing) {
  MatchCache cache = open();
  cache.keep(key, some_match(1.0));
  std::filesystem::rename(file_of(key), file_of(other_key));
  EXPECT_FALSE(cache.find(other_key));
  EXPECT_EQ(cache.damaged(), 1u);
}

TEST_F(MatchCacheTest, WhatIsNoKeyIsRefused) {
  MatchCache cache = open();
  const std::string digits(62, '0');
  for (const std::string& bad : {std::string(), std::string("a"), digits + "0", digits + "000", digits + "0G",
                                 "../" + digits.substr(1), "/x" + digits, digits + "AB"}) {
    EXPECT_THROW(cache.find(bad), std::invalid_argument) << bad;
    EXPECT_THROW(cache.keep(bad, some_match(1.0)), std::invalid_argument) << bad;
    EXPECT_THROW(cache.keep_if_possible(bad, some_match(1.0)), std::invalid_argument) << bad;
    EXPECT_THROW(cache.find_or_make(bad, [] { return some_match(1.0); }), std::invalid_argument) << bad;
  }
  EXPECT_FALSE(cache.find(digits + "ab"));
  EXPECT_TRUE(warned.empty());
}

TEST_F(MatchCacheTest, WhatIsNoFileIsMissing) {
  MatchCache cache = open();
  std::filesystem::create_directories(file_of(key));  // a folder
  EXPECT_FALSE(cache.find(key));
  EXPECT_THROW(cache.keep(key, some_match(1.0)), FileError);
  ASSERT_EQ(::mkfifo(file_of(other_key).c_str(), 0600), 0);  // nobody writes to it
  EXPECT_FALSE(cache.find(other_key));
  EXPECT_EQ(warned.size(), 1u);
}

TEST_F(MatchCacheTest, NeedsADirectoryThatCanBeWrittenTo) {
  const std::string file = directory.write("a_file", "");
  EXPECT_THROW(MatchCache{file}, FileError);
  EXPECT_THROW(MatchCache{file + "/below"}, FileError);
  ASSERT_LT(::open("/proc/self/trial", O_RDWR | O_CREAT | O_CLOEXEC, 0600), 0);
  const std::string why = std::generic_category().message(errno);
  try {
    MatchCache{"/proc/self"};
    FAIL() << "there is no writing to /proc";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), "/proc/self: cannot be written to: " + why);
  }
}

TEST_F(MatchCacheTest, LeavesNoFolderInWhichNothingWasKept) {
  {
    MatchCache cache = open();
    const MatchCache copy = cache;
    EXPECT_EQ(directory.names(), std::vector<std::string>{"matches"});
    EXPECT_FALSE(cache.find(key));
    std::filesystem::create_directories(file_of(key));  // in the way of the match
    EXPECT_THROW(copy.keep(key, some_match(1.0)), FileError);
    std::filesystem::remove(file_of(key));
    std::filesystem::remove(std::filesystem::path(file_of(key)).parent_path());
  }
  EXPECT_TRUE(directory.names().empty());
  open().keep(key, some_match(1.0));
  EXPECT_TRUE(open().find(key));
}

TEST_F(MatchCacheTest, MakesWhatIsMissingOnce) {
  MatchCache cache = open();
  int made = 0;
  const auto make = [&] { return some_match(++made); };
  EXPECT_EQ(cache.find_or_make(key, make).T_fixed_moving.x, 1.0);
  EXPECT_EQ(cache.find_or_make(key, make).T_fixed_moving.x, 1.0);
  EXPECT_EQ(open().find_or_make(key, make).T_fixed_moving.x, 1.0);
  EXPECT_EQ(made, 1);
}

TEST_F(MatchCacheTest, WhatCannotBeKeptIsToldOnce) {
  MatchCache cache = open();
  std::filesystem::remove_all(directory.file("matches"));
  directory.write("matches", "a file now");
  cache.keep_if_possible(key, some_match(1.0));
  EXPECT_EQ(cache.find_or_make(other_key, [] { return some_match(2.0); }).T_fixed_moving.x, 2.0);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_NE(warned[0].find("matches that cannot be kept are made all the same"), std::string::npos)
      << warned[0];
}

TEST_F(MatchCacheTest, TellsOfOtherEnginesAndOptionsOnce) {
  open().announce(0.95);
  EXPECT_TRUE(warned.empty());
  open().announce(0.95);
  EXPECT_TRUE(warned.empty());
  MatchCache cache = open();
  cache.announce(0.9);
  cache.announce(0.9);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_EQ(warned[0],
            directory.file("matches") +
                ": its matches are not used, as they were made with accept 0.95: give the same to use them");
  open().announce(0.95);
  open().announce(0.9);
  EXPECT_EQ(warned.size(), 1u);
}

TEST_F(MatchCacheTest, NamesOtherEngines) {
  directory.write("matches/made-with/0.0.8+12_accept_0.95", "");
  directory.write("matches/made-with/0.0.9+34_accept_0.95", "");
  directory.write("matches/made-with/0.0.9+34_accept_0.9", "");
  directory.write("matches/made-with/notes", "somebody's own");
  open().announce(0.95);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_EQ(warned[0],
            directory.file("matches") +
                ": its matches are not used, as they are of gridmerge 0.0.8+12, 0.0.9+34, and this is " +
                engine_id() + ": use that again, or delete the directory when it is of no use any more");
}

TEST_F(MatchCacheTest, WhatIsToldCannotBeKeptIsToldAsWell) {
  directory.write("matches/made-with", "a file");
  open().announce(0.95);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_NE(warned[0].find("made-with"), std::string::npos) << warned[0];
}

TEST_F(MatchCacheTest, SeveralMayWriteAtOnce) {
  MatchCache cache = open();
  std::vector<std::thread> writers;
  for (int i = 0; i < 4; ++i)
    writers.emplace_back([&] {
      for (int round = 0; round < 20; ++round) cache.keep(key, some_match(1.0));
    });
  for (int round = 0; round < 200; ++round) cache.find(key);
  for (std::thread& writer : writers) writer.join();
  EXPECT_TRUE(cache.find(key));
  EXPECT_EQ(cache.damaged(), 0u);
}

}  // namespace
}  // namespace gridmerge
