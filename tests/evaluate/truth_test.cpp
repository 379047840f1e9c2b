// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <clocale>
#include <functional>
#include <limits>
#include <stdexcept>

#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/io/file_error.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

class TruthFiles : public testing::Test {
 protected:
  // The reader's complaint, without the directory of the file.
  std::string complaint(const std::function<void(const std::string&)>& reader, const std::string& content) {
    const std::string path = directory_.write("truth.tsv", content);
    return complaint_about(reader, path);
  }

  std::string complaint_about(const std::function<void(const std::string&)>& reader,
                              const std::string& path) {
    try {
      reader(path);
    } catch (const FileError& error) {
      const std::string message = error.what();
      const std::string prefix = directory_.path().string() + "/";
      EXPECT_EQ(message.find(prefix), 0u) << message;
      return message.substr(prefix.size());
    }
    return "no complaint";
  }

  test::TemporaryDirectory directory_;
  const std::function<void(const std::string&)> pairs_ = [](const std::string& path) { read_pairs(path); };
  const std::function<void(const std::string&)> negatives_ = [](const std::string& path) {
    read_negatives(path);
  };
  const std::function<void(const std::string&)> sets_ = [](const std::string& path) { read_sets(path); };
};

constexpr const char* kPairs = "fixed\tmoving\tx\ty\ttheta\ttolerance\ttier\toverlap\n";
constexpr const char* kSets = "set\tmap\tx\ty\ttheta\ttolerance\n";

TEST_F(TruthFiles, ReadsPairs) {
  const auto pairs = read_pairs(directory_.write(
      "pairs.tsv", std::string(kPairs) + "a/m0.yaml\ta/m1.yaml\t-1.5\t2\t1e-1\t0.5\tA\t0.84\n"
                                         "\n"
                                         "/abs/c.yaml\td.yaml\t0\t0\t4\t2\tB\t0\r\n"));
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].fixed.name, "a/m0.yaml");
  EXPECT_EQ(pairs[0].fixed.path, directory_.path() / "a/m0.yaml");
  EXPECT_EQ(pairs[0].moving.path, directory_.path() / "a/m1.yaml");
  EXPECT_EQ(pairs[0].T_fixed_moving, (SE2{-1.5, 2.0, 0.1}));
  EXPECT_EQ(pairs[0].tolerance, 0.5);
  EXPECT_EQ(pairs[0].tier, "A");
  EXPECT_EQ(pairs[1].fixed.path, "/abs/c.yaml");
  EXPECT_EQ(pairs[1].T_fixed_moving.theta, normalize_angle(4.0));
}

TEST_F(TruthFiles, ColumnsMayComeInAnyOrderAndTierMayBeAbsent) {
  const auto pairs = read_pairs(directory_.write("pairs.tsv",
                                                 "tolerance\ttheta\ty\tx\tmoving\tfixed\n"
                                                 "0.5\t0.1\t2\t1\tb.yaml\ta.yaml"));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].fixed.name, "a.yaml");
  EXPECT_EQ(pairs[0].T_fixed_moving, (SE2{1.0, 2.0, 0.1}));
  EXPECT_EQ(pairs[0].tier, "");
}

TEST_F(TruthFiles, SharedWallMayBeSaid) {
  const std::string head = "fixed\tmoving\tx\ty\ttheta\ttolerance\tshared_wall\n", row = "a\tb\t0\t0\t0\t1\t";
  EXPECT_EQ(read_pairs(directory_.write("pairs.tsv", head + row + "12.5")).at(0).shared_wall, 12.5);
  EXPECT_EQ(complaint(pairs_, head + row + "-1"), "truth.tsv:2: shared_wall must not be negative");
}

TEST_F(TruthFiles, ReadsNegatives) {
  const auto negatives =
      read_negatives(directory_.write("n.tsv", "fixed\tmoving\na.yaml\tb.yaml\nc.yaml\td.yaml\n"));
  ASSERT_EQ(negatives.size(), 2u);
  EXPECT_EQ(negatives[1].fixed.path, directory_.path() / "c.yaml");
  EXPECT_EQ(negatives[1].moving.name, "d.yaml");
}

TEST_F(TruthFiles, ReadsSetsInTheOrderOfTheirFirstLine) {
  const auto sets = read_sets(directory_.write("s.tsv", std::string(kSets) + "z\tz0.yaml\t0\t0\t0\t0.5\n"
                                                                             "a\ta0.yaml\t0\t0\t0\t0.5\n"
                                                                             "z\tz1.yaml\t1\t2\t3\t0.25\n"
                                                                             "a\ta1.yaml\t0\t0\t0\t0.5\n"));
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].name, "z");
  ASSERT_EQ(sets[0].members.size(), 2u);
  EXPECT_EQ(sets[0].members[1].map.path, directory_.path() / "z1.yaml");
  EXPECT_EQ(sets[0].members[1].T_set_map, (SE2{1.0, 2.0, 3.0}));
  EXPECT_EQ(sets[0].members[1].tolerance, 0.25);
  EXPECT_EQ(sets[1].name, "a");
}

TEST_F(TruthFiles, NumbersDoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr)
    GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
  const auto pairs =
      read_pairs(directory_.write("p.tsv", std::string(kPairs) + "a\tb\t1.5\t0\t0\t0.5\tA\t0\n"));
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(pairs.at(0).T_fixed_moving.x, 1.5);
}

TEST_F(TruthFiles, ARefusedFileIsNamedWithItsCause) {
  EXPECT_EQ(complaint_about(pairs_, directory_.file("none.tsv")), "none.tsv: No such file or directory");
  std::filesystem::create_directory(directory_.path() / "folder");
  EXPECT_EQ(complaint_about(pairs_, directory_.file("folder")), "folder: Is a directory");
  EXPECT_EQ(complaint(pairs_, ""), "truth.tsv: the file is empty; its first line should name the columns");
  EXPECT_EQ(complaint(pairs_, "\n\r\n"),
            "truth.tsv: the file is empty; its first line should name the columns");
}

TEST_F(TruthFiles, ARefusedHeaderIsExplained) {
  EXPECT_EQ(complaint(negatives_, "fixed moving\n"),
            "truth.tsv:1: names no column 'fixed': tabs separate columns, not spaces");
  EXPECT_EQ(complaint(negatives_, "\nfixed\n"), "truth.tsv:2: names no column 'moving'");
  EXPECT_EQ(complaint(negatives_, "fixed\tmoving\ttier\n"),
            "truth.tsv:1: names a column 'tier' that is not known here");
  EXPECT_EQ(complaint(negatives_, "fixed\tmoving\tmoving\n"), "truth.tsv:1: names the column 'moving' twice");
  EXPECT_EQ(complaint(pairs_, "fixed\tmoving\tx\ty\ttheta\n"), "truth.tsv:1: names no column 'tolerance'");
  EXPECT_EQ(complaint(sets_, "map\tx\ty\ttheta\ttolerance\n"), "truth.tsv:1: names no column 'set'");
}

TEST_F(TruthFiles, ARefusedFieldIsNamedWithItsLine) {
  const auto pair = [&](const std::string& line) { return complaint(pairs_, kPairs + line + "\n"); };
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t1\tA\t0\n\nc\td\t1\n"),
            "truth.tsv:4: has 3 fields where the first line names 8 columns");
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t1\tA\t0\t"),
            "truth.tsv:2: has 9 fields where the first line names 8 columns");
  EXPECT_EQ(pair("\tb\t0\t0\t0\t1\tA\t0"), "truth.tsv:2: fixed is empty");
  EXPECT_EQ(pair("a\tb\t0\t\t0\t1\tA\t0"), "truth.tsv:2: y is empty");
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t1\t\t0"), "truth.tsv:2: tier is empty");
  EXPECT_EQ(pair("a\tb\tone\t0\t0\t1\tA\t0"), "truth.tsv:2: x is 'one', not a finite number");
  EXPECT_EQ(pair("a\tb\t1,5\t0\t0\t1\tA\t0"), "truth.tsv:2: x is '1,5', not a finite number");
  EXPECT_EQ(pair("a\tb\t0\t0\tnan\t1\tA\t0"), "truth.tsv:2: theta is 'nan', not a finite number");
  EXPECT_EQ(pair("a\tb\t0\tinf\t0\t1\tA\t0"), "truth.tsv:2: y is 'inf', not a finite number");
  EXPECT_EQ(pair("a\tb\t1e999\t0\t0\t1\tA\t0"), "truth.tsv:2: x is '1e999', not a finite number");
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t0\tA\t0"), "truth.tsv:2: tolerance must be positive");
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t-1\tA\t0"), "truth.tsv:2: tolerance must be positive");
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t1\tA\t1.5"), "truth.tsv:2: overlap must be between 0 and 1");
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t1\tA\t1.001"), "truth.tsv:2: overlap must be between 0 and 1");
  EXPECT_EQ(pair("a\tb\t0\t0\t0\t1\tA\t-0.001"), "truth.tsv:2: overlap must be between 0 and 1");
}

TEST_F(TruthFiles, LimitsThemselvesAreFine) {
  const auto pairs = read_pairs(
      directory_.write("p.tsv", std::string(kPairs) + "a\tb\t0\t0\t0\t1e-9\tA\t0\nc\td\t0\t0\t0\t1\tA\t1\n"));
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].tolerance, 1e-9);
  EXPECT_EQ(pairs[0].overlap, 0.0);
  EXPECT_EQ(pairs[1].overlap, 1.0);
  const std::string head = "fixed\tmoving\tx\ty\ttheta\ttolerance\tshared_wall\n";
  EXPECT_EQ(read_pairs(directory_.write("p.tsv", head + "a\tb\t0\t0\t0\t1\t0\n")).at(0).shared_wall, 0.0);
}

TEST_F(TruthFiles, ANameWithANulIsRefused) {
  using namespace std::string_literals;
  EXPECT_EQ(complaint(negatives_, "fixed\tmoving\na.yaml\tb.yaml\0.old\n"s),
            "truth.tsv:2: moving holds a NUL character");
  EXPECT_EQ(complaint(pairs_, kPairs + "a\0\tb\t0\t0\t0\t1\tA\t0\n"s),
            "truth.tsv:2: fixed holds a NUL character");
  EXPECT_EQ(complaint(sets_, kSets + "s\t\0a\t0\t0\t0\t1\n"s), "truth.tsv:2: map holds a NUL character");
}

TEST_F(TruthFiles, NumbersThatCouldNotBeReadAreNotWritten) {
  TruePair pair;
  pair.fixed.name = "a";
  pair.moving.name = "b";
  pair.tolerance = 1.0;
  EXPECT_NO_THROW(format_pairs({pair}));
  for (double TruePair::*const value : {&TruePair::tolerance, &TruePair::overlap, &TruePair::shared_wall}) {
    TruePair bad = pair;
    bad.*value = std::numeric_limits<double>::infinity();
    EXPECT_THROW(format_pairs({bad}), std::invalid_argument);
  }
  pair.T_fixed_moving.theta = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(format_pairs({pair}), std::invalid_argument);
  TrueSet set{"s", {{pair.fixed, {}, std::numeric_limits<double>::quiet_NaN()}}};
  EXPECT_THROW(format_sets({set}), std::invalid_argument);
}

TEST_F(TruthFiles, ASetOfOneMapIsRefused) {
  EXPECT_EQ(
      complaint(sets_, std::string(kSets) + "s\ta\t0\t0\t0\t1\ns\tb\t0\t0\t0\t1\nlone\tc\t0\t0\t0\t1\n"),
      "truth.tsv:4: set 'lone' has a single map");
}

}  // namespace
}  // namespace gridmerge
