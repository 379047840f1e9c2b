// SPDX-License-Identifier: Apache-2.0
// What becomes of the node when its network changes. The network is one of the test's own.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>

#include "../cli/program.hpp"
#include "own_network.hpp"
#include "running_node.hpp"

namespace gridmerge::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Ends a node whose network went down before, and says how long that took.
Clock::duration end_without_network(const RunOptions& options, Outcome& outcome) {
  set_loopback(true);
  RunningProgram program({"node"}, options);
  EXPECT_NE(program.read_line(), "");  // it has begun
  set_loopback(false);
  const auto asked = Clock::now();
  outcome = program.end_with(SIGTERM);
  return Clock::now() - asked;
}

TEST(Network, ThatIsGoneKeepsNoNodeFromEnding) {
  own_domain();
  const bool was_run = in_own_network([] {
    RunOptions options;
    options.environment = {"ROS_LOCALHOST_ONLY=0"};
    Outcome outcome;
    EXPECT_LT(end_without_network(options, outcome), std::chrono::seconds(4));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("does not let go"), std::string::npos) << outcome.err;
    // With settings of the user's with which Cyclone DDS waits for good, too.
    options.environment.emplace_back(
        "CYCLONEDDS_URI=<CycloneDDS><Domain><Internal><MultipleReceiveThreads>true</MultipleReceiveThreads>"
        "</Internal></Domain></CycloneDDS>");
    EXPECT_LT(end_without_network(options, outcome), std::chrono::seconds(30));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("does not let go"), std::string::npos) << outcome.err;
  });
  if (!was_run) GTEST_SKIP() << "no network of its own can be made here";
}

}  // namespace
}  // namespace gridmerge::test
