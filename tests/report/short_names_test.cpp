// SPDX-License-Identifier: Apache-2.0
#include "report/short_names.hpp"

#include <gtest/gtest.h>

namespace gridmerge {

using namespace internal;
namespace {

using Names = std::vector<std::string>;

TEST(ShortNames, LackTheFoldersThatAllLieIn) {
  EXPECT_EQ(short_names({"a/b/one.yaml", "a/b/two.yaml"}), (Names{"one.yaml", "two.yaml"}));
  EXPECT_EQ(short_names({"/runs/robot_1/map.yaml", "/runs/robot_2/map.yaml"}),
            (Names{"robot_1/map.yaml", "robot_2/map.yaml"}));
  EXPECT_EQ(short_names({"/runs/one.yaml", "/maps/two.yaml"}), (Names{"/runs/one.yaml", "/maps/two.yaml"}));
  EXPECT_EQ(short_names({"a/one.yaml", "two.yaml"}), (Names{"a/one.yaml", "two.yaml"}));
  EXPECT_EQ(short_names({"/one.yaml", "one.yaml"}), (Names{"/one.yaml", "one.yaml"}));
  EXPECT_EQ(short_names({"a/b/c", "a/b"}), (Names{"b/c", "b"}));
  EXPECT_EQ(short_names({"ab/c", "ax/c"}), (Names{"ab/c", "ax/c"})) << "a folder is whole";
}

TEST(ShortNames, OfOneOfNoneAndOfOddOnes) {
  EXPECT_EQ(short_names({"a/b/one.yaml"}), Names{"one.yaml"});
  EXPECT_EQ(short_names({}), Names{});
  EXPECT_EQ(short_names({"", "a/b"}), (Names{"", "a/b"}));
  EXPECT_EQ(short_names({"a/", "a/b"}), (Names{"", "b"}));
  EXPECT_EQ(short_names({"a/b", "a/b"}), (Names{"b", "b"}));
}

}  // namespace
}  // namespace gridmerge
