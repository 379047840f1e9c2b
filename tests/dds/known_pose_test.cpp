// SPDX-License-Identifier: Apache-2.0
// What the node says of poses that were given to it.
#include <gtest/gtest.h>

#include "node_fixture.hpp"

namespace gridmerge::test {
namespace {

TEST_F(NodeTest, WarnsOnceOfAPoseThatHoldsNoLonger) {
  options.known_poses["b"] = KnownPose{explorers.between(0, 1), 0.5, 0.05, false};
  start();
  merge_two();
  b->publish(map_of(3, "b/map"));  // another building: the map alone says that it started anew
  ASSERT_TRUE(comes_true([&] { return node->said("the pose given for it holds no longer"); }))
      << node->lines();
  b->publish(map_of(1, "b/map_2"));
  ASSERT_TRUE(comes_true([&] { return node->said("b: started anew"); })) << node->lines();
  ASSERT_TRUE(diagnosed("b", "frame", "b/map_2"));
  EXPECT_EQ(node->times_said("holds no longer"), 1) << node->lines();
}

}  // namespace
}  // namespace gridmerge::test
