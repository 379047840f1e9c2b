// SPDX-License-Identifier: Apache-2.0
// `gridmerge node` with DDS Security, beside peers that have the right keys, others, or none.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "../cli/program.hpp"
#include "bag/bag_builder.hpp"
#include "keystore.hpp"
#include "online/explorers.hpp"
#include "running_node.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge::test {
namespace {

constexpr const char* kMerger = "/merger";

class NodeSecurity : public testing::Test {
 protected:
  void SetUp() override {
    if (!Keystore::can_be_made()) GTEST_SKIP() << "the program openssl is not here (Debian: openssl)";
  }

  static RunOptions with_keys(const Keystore& keystore) {
    RunOptions options;
    options.environment = {"ROS_SECURITY_ENABLE=true", "ROS_SECURITY_KEYSTORE=" + keystore.path()};
    return options;
  }

  /// A node that publishes the map of a robot again and again, as the robot would. Cyclone DDS does not take
  /// participants with and without keys in one process, so each peer is a program.
  RunningProgram robot(const std::string& name, int number, const RunOptions& options = {}) const {
    const std::string bag = directory.write(
        name + ".mcap", mcap_file({record("/map", 1, explorers.map(number, Explorers::kSteps))}));
    return RunningProgram({"node", "--bag", bag, "--name", name, "--enclave", "/" + name, "--output",
                           "/of_" + name, "--tf", "none"},
                          options);
  }

  const std::uint32_t domain = own_domain();
  const Explorers explorers{};
  const TemporaryDirectory directory;
};

/// The robots that a node which ran once tells of.
std::vector<std::string> robots_of(const Outcome& outcome) {
  std::vector<std::string> robots;
  for (const char* name : {"a", "b", "forged", "open"}) {
    if (("\n" + outcome.out).find(std::string("\n") + name + ": ") != std::string::npos)
      robots.push_back(name);
  }
  return robots;
}

TEST_F(NodeSecurity, HearsWhoeverHasKeysOfTheSameAuthorityAndNobodyElse) {
  const Keystore keystore, others;
  for (const char* enclave : {kMerger, "/a", "/b"}) keystore.add(enclave);
  for (const char* enclave : {kMerger, "/forged"}) others.add(enclave);
  const RunningProgram open = robot("open", 0), forged = robot("forged", 0, with_keys(others)),
                       a = robot("a", 0, with_keys(keystore)), b = robot("b", 1, with_keys(keystore));
  const auto once = [](const std::string& wait) {
    return std::vector<std::string>{"node",      "--once", "--wait",   wait,     "--quiet",
                                    "--enclave", kMerger,  "--output", "/of_all"};
  };
  const Outcome merged = run(once("60"), with_keys(keystore));  // ends when both are there
  EXPECT_EQ(merged.exit_code, 0) << merged.out << merged.err;
  EXPECT_EQ(robots_of(merged), (std::vector<std::string>{"a", "b"})) << merged.out;
  // The others were there, and whoever is like them hears them.
  EXPECT_EQ(robots_of(run(once("6"), with_keys(others))), std::vector<std::string>{"forged"});
  EXPECT_EQ(robots_of(run(once("6"))), std::vector<std::string>{"open"});
}

TEST_F(NodeSecurity, TellsWhoseKeysItHas) {
  const Keystore keystore;
  keystore.add(kMerger);
  RunningProgram program({"node", "--enclave", kMerger}, with_keys(keystore));
  EXPECT_NE(program.read_line().find(" in domain " + std::to_string(domain) + ", secure as /merger, and"),
            std::string::npos);
  EXPECT_EQ(program.end_with(SIGTERM).exit_code, 0);
}

TEST_F(NodeSecurity, TheVariableCountsForMoreThanTheOption) {
  const Keystore keystore;
  keystore.add(kMerger);
  RunOptions options = with_keys(keystore);
  options.environment.push_back("ROS_SECURITY_ENCLAVE_OVERRIDE=/merger");
  RunningProgram program({"node", "--enclave", "/another"}, options);
  EXPECT_NE(program.read_line().find("secure as /merger"), std::string::npos);
  EXPECT_EQ(program.end_with(SIGINT).exit_code, 0);
}

TEST_F(NodeSecurity, DoesNotSpeakOpenlyWhereItsKeysDoNotServe) {
  const Keystore keystore, others;
  keystore.add(kMerger);
  others.add(kMerger);
  // Another authority's certificate, and a text that nobody has signed.
  std::filesystem::copy_file(others.folder(kMerger) + "/cert.pem", keystore.folder(kMerger) + "/cert.pem",
                             std::filesystem::copy_options::overwrite_existing);
  const Outcome forged = run({"node", "--enclave", kMerger}, with_keys(keystore));
  EXPECT_EQ(forged.exit_code, 1);
  EXPECT_EQ(count_lines(forged.err), 1u) << forged.err;
  EXPECT_EQ(forged.out, "");
  std::filesystem::copy_file(others.folder(kMerger) + "/permissions.xml",
                             others.folder(kMerger) + "/permissions.p7s",
                             std::filesystem::copy_options::overwrite_existing);
  const Outcome unsigned_permissions = run({"node", "--enclave", kMerger}, with_keys(others));
  EXPECT_EQ(unsigned_permissions.exit_code, 1);
  EXPECT_EQ(count_lines(unsigned_permissions.err), 1u) << unsigned_permissions.err;

  std::filesystem::remove(keystore.folder(kMerger) + "/key.pem");
  const Outcome missing = run({"node", "--enclave", kMerger}, with_keys(keystore));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("the enclave /merger has no file " + keystore.folder(kMerger) + "/key.pem"),
            std::string::npos)
      << missing.err;
  EXPECT_EQ(run({"node", "--enclave", "merger"}).exit_code, 2);
}

}  // namespace
}  // namespace gridmerge::test
