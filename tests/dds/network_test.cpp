// SPDX-License-Identifier: Apache-2.0
// What becomes of the node when its network changes. The network is one of the test's own.
#include "dds/network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <string>
#include <thread>

#include "../cli/program.hpp"
#include "dds/environment.hpp"
#include "dds/participant.hpp"
#include "own_network.hpp"
#include "peer.hpp"
#include "running_node.hpp"

namespace gridmerge::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kJoins = "this machine has other addresses in the network: the node joins it anew";
/// Settings with which Cyclone DDS waits for good for a network that is gone.
constexpr const char* kWaitsForGood =
    "CYCLONEDDS_URI=<CycloneDDS><Domain><Internal><MultipleReceiveThreads>true</MultipleReceiveThreads>"
    "</Internal></Domain></CycloneDDS>";

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
    options.environment.emplace_back(kWaitsForGood);
    EXPECT_LT(end_without_network(options, outcome), std::chrono::seconds(30));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("does not let go"), std::string::npos) << outcome.err;
  });
  if (!was_run) GTEST_SKIP() << "no network of its own can be made here";
}

/// Sets a variable of this process while it lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name), before_(internal::process_environment(name)) {
    ::setenv(name, value, 1);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(Network, ThatWasDownLeavesAMapWithItsUpdates) {
  const std::uint32_t domain = own_domain();
  const Variable lease("CYCLONEDDS_URI",
                       "<CycloneDDS><Domain><Discovery><LeaseDuration>1s</LeaseDuration></Discovery>"
                       "</Domain></CycloneDDS>");
  const bool was_run = in_own_network([&] {
    set_loopback(true);
    RunningProgram program({"node"});
    const internal::Participant network(internal::read_ros_environment(internal::process_environment),
                                        1 << 20);
    Peer peer(domain);
    const MapTopic map = peer.maps("/a/map");
    map.publish(RawMap{.frame = "a"});
    const auto value = [&](const std::string& key) {
      const auto& all = peer.diagnoses();
      const auto found = all.find("gridmerge: a");
      return found == all.end() ? std::string() : found->second.values.at(key);
    };
    ASSERT_TRUE(comes_true([&] { return value("maps") == "1" && value("publishers") == "1"; }));
    peer.publish_update("/a/map_updates", {"a", 2});
    ASSERT_TRUE(comes_true([&] { return value("updates") == "1"; }));

    set_loopback(false);
    std::this_thread::sleep_for(std::chrono::seconds(3));
    set_loopback(true);
    EXPECT_EQ(program.read_line().find("hears a map"), 0u);
    EXPECT_EQ(program.read_line().find("a: first map"), 0u);
    EXPECT_EQ(program.read_line(), "a: its publisher is gone; its map is kept");
    ASSERT_TRUE(comes_true([&] { return value("publishers") == "1" && std::stoi(value("updates")) >= 2; }));
    const int updates = std::stoi(value("updates"));  // the one that is kept came again
    peer.publish_update("/a/map_updates", {"a", 3});
    EXPECT_TRUE(comes_true([&] { return std::stoi(value("updates")) > updates; }));
    // The map came again too, and did not undo them.
    EXPECT_EQ(value("maps"), "1");
    EXPECT_EQ(value("refused"), "0") << value("last refusal");
  });
  if (!was_run) GTEST_SKIP() << "no network of its own can be made here";
}

/// Whether the commands could be run, one after the other, in the thread's network.
bool can(std::initializer_list<const char*> commands) {
  return std::all_of(commands.begin(), commands.end(), [](const std::string& command) {
    return std::system((command + " > /dev/null 2>&1").c_str()) == 0;  // NOLINT(cert-env33-c)
  });
}

/// Whether an interface with a carrier could be made in the thread's network: gm0, with 10.99.0.1.
bool make_interface() {
  return can({"ip link add gm0 type veth peer name gm1", "ip address add 10.99.0.1/24 dev gm0",
              "ip link set gm0 up", "ip link set gm1 up"});
}

/// Publishes this robot's map until the node says that it heard it.
void expect_heard(RunningProgram& program, std::uint32_t domain, const std::string& robot) {
  const internal::Participant network(internal::read_ros_environment(internal::process_environment), 1 << 20);
  const Peer peer(domain);
  const MapTopic map = peer.maps("/" + robot + "/map");
  map.publish(RawMap{.frame = robot});
  EXPECT_EQ(program.read_line().rfind(robot + ": first map", 0), 0u);
}

TEST(Network, LeadsOutWhereThereIsACarrier) {
  bool has_interfaces = false;
  const bool was_run = in_own_network([&] {
    has_interfaces = can({"ip link add gm0 type veth peer name gm1", "ip address add 10.99.0.1/24 dev gm0",
                          "ip link set gm0 up"});
    if (!has_interfaces) return;
    const auto leads_out = [] {
      const internal::NetworkAddresses addresses = internal::network_addresses();
      return addresses.size() == 1 && addresses.begin()->leads_out;
    };
    EXPECT_EQ(internal::network_addresses().size(), 1u);
    EXPECT_FALSE(leads_out());
    ASSERT_TRUE(can({"ip link set gm1 up"}));
    EXPECT_TRUE(comes_true(leads_out));
  });
  if (!was_run || !has_interfaces) GTEST_SKIP() << "no network of its own can be made here";
}

/// As at boot, where docker may be up before the network is.
TEST(Network, IsJoinedWhereABridgeToNowhereWasFirst) {
  own_domain();
  const Variable everywhere("ROS_LOCALHOST_ONLY", "0");
  bool has_interfaces = false;
  const bool was_run = in_own_network([&] {
    set_loopback(true);
    // A carrier that is missing makes it one.
    has_interfaces = can({"ip link add gm0 type veth peer name gm1", "ip address add 172.17.0.1/16 dev gm0",
                          "ip link set gm0 up", "ip link add gm2 type veth peer name gm3"});
    if (!has_interfaces) return;
    RunningProgram program({"node"});
    EXPECT_NE(program.read_line(), "");
    ASSERT_TRUE(can({"ip address add 10.99.0.1/24 dev gm2", "ip link set gm2 up", "ip link set gm3 up"}));
    EXPECT_EQ(program.read_line(), kJoins);
    EXPECT_EQ(program.end_with(SIGTERM).exit_code, 0);
  });
  if (!was_run || !has_interfaces) GTEST_SKIP() << "no network of its own can be made here";
}

TEST(Network, IsJoinedWheneverItComesAndChanges) {
  const std::uint32_t domain = own_domain();
  const Variable everywhere("ROS_LOCALHOST_ONLY", "0");
  bool has_interfaces = false;
  const bool was_run = in_own_network([&] {
    set_loopback(true);
    RunningProgram program({"node"});
    EXPECT_NE(program.read_line(), "");
    has_interfaces = make_interface();
    if (!has_interfaces) return;
    EXPECT_EQ(program.read_line(), kJoins);
    expect_heard(program, domain, "a");
    EXPECT_EQ(program.read_line(), "a: its publisher is gone; its map is kept");
    ASSERT_TRUE(can({"ip address del 10.99.0.1/24 dev gm0", "ip address add 10.99.0.9/24 dev gm0"}));
    EXPECT_EQ(program.read_line(), kJoins);
    expect_heard(program, domain, "b");
    EXPECT_EQ(program.end_with(SIGTERM).exit_code, 0);
  });
  if (!was_run || !has_interfaces) GTEST_SKIP() << "no network of its own can be made here";
}

TEST(Network, ThatIsReplacedHidesNoPublisherThatWent) {
  const std::uint32_t domain = own_domain();
  const Variable everywhere("ROS_LOCALHOST_ONLY", "0");
  bool has_interfaces = false;
  const bool was_run = in_own_network([&] {
    set_loopback(true);
    has_interfaces = make_interface();
    if (!has_interfaces) return;
    RunningProgram program({"node"});
    EXPECT_NE(program.read_line(), "");
    {
      const internal::Participant network(internal::read_ros_environment(internal::process_environment),
                                          1 << 20);
      const Peer peer(domain);
      const MapTopic map = peer.maps("/a/map");
      map.publish(RawMap{.frame = "a"});
      EXPECT_EQ(program.read_line().rfind("a: first map", 0), 0u);
      // Nobody hears how it goes.
      ASSERT_TRUE(can({"ip link set gm0 down", "ip address del 10.99.0.1/24 dev gm0"}));
    }
    ASSERT_TRUE(can({"ip address add 10.99.0.9/24 dev gm0", "ip link set gm0 up"}));
    EXPECT_EQ(program.read_line(), kJoins);
    EXPECT_EQ(program.read_line(), "a: its publisher is gone; its map is kept");
    EXPECT_EQ(program.end_with(SIGTERM).exit_code, 0);
  });
  if (!was_run || !has_interfaces) GTEST_SKIP() << "no network of its own can be made here";
}

TEST(Network, ThatIsReplacedKeepsNoNodeFromEnding) {
  own_domain();
  bool has_interfaces = false;
  const bool was_run = in_own_network([&] {
    set_loopback(true);
    has_interfaces = make_interface();
    if (!has_interfaces) return;
    RunOptions options;
    options.environment = {"ROS_LOCALHOST_ONLY=0", kWaitsForGood};
    RunningProgram program({"node"}, options);
    EXPECT_NE(program.read_line(), "");
    ASSERT_TRUE(can({"ip address del 10.99.0.1/24 dev gm0", "ip address add 10.99.0.9/24 dev gm0"}));
    EXPECT_EQ(program.read_line(), kJoins);
    const auto asked = Clock::now();
    EXPECT_EQ(program.end_with(SIGTERM).exit_code, 0);
    EXPECT_LT(Clock::now() - asked, std::chrono::seconds(30));
  });
  if (!was_run || !has_interfaces) GTEST_SKIP() << "no network of its own can be made here";
}

}  // namespace
}  // namespace gridmerge::test
