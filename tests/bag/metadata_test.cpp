// SPDX-License-Identifier: Apache-2.0
#include "bag/metadata.hpp"

#include <gtest/gtest.h>

#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {
namespace {

using namespace internal;
using test::contains;
using Names = std::vector<std::string>;

std::string with_paths(const std::string& paths) {
  return "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths: " + paths + "\n";
}

std::string error_of(const std::string& text) {
  return test::message_of<ParseError>([&] { parse_metadata(text); });
}

TEST(Metadata, NamesTheFilesInTheirOrder) {
  EXPECT_EQ(parse_metadata(with_paths("[b_1.db3, b_0.db3]")), (Names{"b_1.db3", "b_0.db3"}));
  EXPECT_EQ(parse_metadata(with_paths("\n    - run_0.mcap\n    - run_1.mcap")),
            (Names{"run_0.mcap", "run_1.mcap"}));
}

TEST(Metadata, NobodyLeadsOutOfTheFolder) {
  EXPECT_EQ(parse_metadata(with_paths("[run/run_0.db3]")), (Names{"run_0.db3"})) << "old recorders";
  EXPECT_EQ(parse_metadata(with_paths("[../../etc/passwd, /dev/zero, 'C:\\b.db3']")),
            (Names{"passwd", "zero", "b.db3"}));
  for (const char* bad : {"['..']", "['.']", "['a/']", "['']", "[[a]]", "[{a: b}]", "[\"a\\0b\"]"})
    EXPECT_TRUE(contains(error_of(with_paths(bad)), "no file's name")) << bad;
}

TEST(Metadata, AFileCountsOnce) {
  EXPECT_EQ(parse_metadata(with_paths("[b.db3, a.db3, b.db3, run/a.db3]")), (Names{"b.db3", "a.db3"}));
}

TEST(Metadata, FilesAreNotEndless) {
  const auto names = [](int count) {
    std::string paths = "[b_0.db3";
    for (int i = 1; i < count; ++i) paths += ", b_" + std::to_string(i) + ".db3";
    return with_paths(paths + "]");
  };
  EXPECT_EQ(parse_metadata(names(1000)).size(), 1000u);
  EXPECT_TRUE(contains(error_of(names(1001)), "names more than 1000 files"));
}

TEST(Metadata, WhatIsNoneIsRefused) {
  EXPECT_TRUE(contains(error_of(""), "no rosbag2 metadata"));
  EXPECT_TRUE(contains(error_of("- a"), "no rosbag2 metadata"));
  EXPECT_TRUE(contains(error_of("image: a.pgm"), "missing key 'rosbag2_bagfile_information'"));
  EXPECT_TRUE(contains(error_of("rosbag2_bagfile_information: 1"), "rosbag2_bagfile_information"));
  EXPECT_TRUE(contains(error_of("rosbag2_bagfile_information: {version: 5}"), "names no files"));
  EXPECT_TRUE(contains(error_of(with_paths("[]")), "names no files"));
  EXPECT_TRUE(contains(error_of("a: [b"), "not valid YAML"));
  EXPECT_TRUE(contains(error_of(std::string(1000, '[')), "nested too deeply"));
}

}  // namespace
}  // namespace gridmerge
