// SPDX-License-Identifier: Apache-2.0
#include "dds/environment.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "dds/network.hpp"
#include "own_network.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge::internal {
namespace {

using Variables = std::map<std::string, std::string>;

RosEnvironment read(const Variables& variables) {
  return read_ros_environment([&](const std::string& name) -> std::optional<std::string> {
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional(found->second);
  });
}

std::string refusal(const Variables& variables) {
  try {
    read(variables);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "taken";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string configuration(const Variables& variables, bool network = true) {
  return cyclone_configuration(read(variables), 1000, network);
}

TEST(RosEnvironment, IsTheUsualOneWhereNothingIsSet) {
  for (const Variables& variables : {Variables{}, Variables{{"ROS_DOMAIN_ID", ""},
                                                            {"ROS_AUTOMATIC_DISCOVERY_RANGE", ""},
                                                            {"ROS_STATIC_PEERS", ""},
                                                            {"ROS_LOCALHOST_ONLY", ""},
                                                            {"CYCLONEDDS_URI", ""}}}) {
    const RosEnvironment environment = read(variables);
    EXPECT_EQ(environment.domain, 0u);
    EXPECT_EQ(environment.range, DiscoveryRange::subnet);
    EXPECT_TRUE(environment.static_peers.empty());
    const std::string text = configuration(variables);
    EXPECT_FALSE(has(text, "Peer"));
    EXPECT_FALSE(has(text, "AllowMulticast"));
    EXPECT_TRUE(has(text, "<MaxSampleSize>1000B</MaxSampleSize>"));
    EXPECT_FALSE(has(text, ","));
  }
}

TEST(RosEnvironment, HasADomain) {
  EXPECT_EQ(read({{"ROS_DOMAIN_ID", "232"}}).domain, 232u);
  for (const char* text : {"233", "-1", "1.5", "x", " 1", "1 ", "99999999999999999999"})
    EXPECT_TRUE(has(refusal({{"ROS_DOMAIN_ID", text}}), "ROS_DOMAIN_ID")) << text;
}

TEST(RosEnvironment, KeepsToThisMachine) {
  for (const Variables& variables :
       {Variables{{"ROS_LOCALHOST_ONLY", "1"}}, Variables{{"ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"}}}) {
    EXPECT_EQ(read(variables).range, DiscoveryRange::localhost);
    const std::string text = configuration(variables);
    EXPECT_TRUE(has(text, "<AllowMulticast>false</AllowMulticast>"));
    EXPECT_TRUE(has(text, "<Peers><Peer Address=\"127.0.0.1\"/></Peers>"));
    EXPECT_TRUE(has(text, "<NetworkInterface autodetermine=\"true\"/>"));
    // Cyclone DDS would choose the loopback interface, which it has already.
    EXPECT_FALSE(has(configuration(variables, false), "autodetermine"));
  }
  EXPECT_EQ(read({{"ROS_LOCALHOST_ONLY", "0"}}).range, DiscoveryRange::subnet);
  EXPECT_TRUE(has(refusal({{"ROS_LOCALHOST_ONLY", "yes"}}), "ROS_LOCALHOST_ONLY"));
}

TEST(RosEnvironment, LocalhostOnlyCountsForMore) {
  const Variables variables{{"ROS_LOCALHOST_ONLY", "1"},
                            {"ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET"},
                            {"ROS_STATIC_PEERS", "192.0.2.7"}};
  EXPECT_EQ(read(variables).range, DiscoveryRange::localhost);
  EXPECT_TRUE(read(variables).static_peers.empty());
}

TEST(RosEnvironment, HasPeers) {
  const Variables variables{{"ROS_STATIC_PEERS", "192.0.2.7;;robot-1.local;"}};
  EXPECT_EQ(read(variables).static_peers, (std::vector<std::string>{"192.0.2.7", "robot-1.local"}));
  EXPECT_TRUE(
      has(configuration(variables), "<Peer Address=\"192.0.2.7\"/><Peer Address=\"robot-1.local\"/>"));
  EXPECT_FALSE(has(configuration(variables), "AllowMulticast"));
  const std::string both =
      configuration({{"ROS_STATIC_PEERS", "a"}, {"ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"}});
  EXPECT_TRUE(has(both, "<Peer Address=\"127.0.0.1\"/><Peer Address=\"a\"/>"));
}

TEST(RosEnvironment, TakesNoPeersThatCouldEndTheXml) {
  for (const char* text : {"\"/><x", "a b", "a<", "a&b", "a,b"})
    EXPECT_TRUE(has(refusal({{"ROS_STATIC_PEERS", text}}), "ROS_STATIC_PEERS")) << text;
}

TEST(RosEnvironment, NamesRangesThatRosDoesNotHave) {
  EXPECT_TRUE(has(refusal({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost"}}), "is none of"));
  EXPECT_TRUE(has(refusal({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF"}}), "no robot can be found"));
  EXPECT_EQ(read({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "SYSTEM_DEFAULT"}, {"ROS_STATIC_PEERS", "a"}})
                .static_peers.size(),
            0u);
}

TEST(RosEnvironment, DoesNotSpeakOpenlyWhereSecurityIsAskedFor) {
  Variables variables{{"ROS_SECURITY_ENABLE", "true"}, {"ROS_SECURITY_STRATEGY", "Permissive"}};
  EXPECT_TRUE(has(refusal(variables), "ROS_SECURITY_ENABLE='true': ROS_SECURITY_KEYSTORE is not set"));
  const test::TemporaryDirectory keystore;
  variables["ROS_SECURITY_KEYSTORE"] = keystore.path().string();
  for (const char* name : {"identity_ca.cert.pem", "cert.pem", "key.pem", "permissions_ca.cert.pem",
                           "governance.p7s", "permissions.p7s"}) {
    const std::string file = std::string("enclaves/") + name;
    EXPECT_TRUE(has(refusal(variables), "the enclave / has no file " + keystore.file(file)))
        << refusal(variables);
    keystore.write(file, "");
    keystore.write(std::string("enclaves/a/b/") + name, "");
  }
  EXPECT_EQ(read(variables).enclave_files, keystore.path() / "enclaves" / "");
  variables["ROS_SECURITY_ENCLAVE_OVERRIDE"] = "/a/b";
  EXPECT_EQ(read(variables).enclave, "/a/b");
  EXPECT_EQ(read(variables).enclave_files, keystore.path() / "enclaves/a/b");
  for (const char* name : {"a/b", "/a//b", "/../a", "/a b"}) {
    variables["ROS_SECURITY_ENCLAVE_OVERRIDE"] = name;
    EXPECT_TRUE(has(refusal(variables), "ROS_SECURITY_ENCLAVE_OVERRIDE")) << name;
  }
  variables["ROS_SECURITY_ENABLE"] = "false";
  EXPECT_TRUE(read(variables).enclave_files.empty());
}

TEST(RosEnvironment, CyclonesOwnSettingsComeLast) {
  const std::string uri = "<CycloneDDS><Domain><General/></Domain></CycloneDDS>";
  const std::string text = configuration({{"CYCLONEDDS_URI", uri}, {"ROS_LOCALHOST_ONLY", "1"}});
  EXPECT_TRUE(text.ends_with("," + uri));
  EXPECT_FALSE(has(text, "NetworkInterface"));  // they could not be taken away again
}

TEST(RosEnvironment, WaitsForNoPipe) {
  const test::TemporaryDirectory folder;
  const std::string pipe = folder.file("pipe"), file = folder.write("dds.xml", "<CycloneDDS/>");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string xml = "<Domain><General><AllowMulticast>a,b</AllowMulticast></General></Domain>";
  for (const std::string& uri : {pipe, "file://" + pipe, " ," + pipe, file + "," + pipe + "," + file,
                                 xml + " ,\n" + pipe, xml + "," + xml + ",file://" + pipe})
    EXPECT_EQ(refusal({{"CYCLONEDDS_URI", uri}}),
              "CYCLONEDDS_URI='" + uri + "': " + pipe + " is not a regular file");
  EXPECT_TRUE(has(refusal({{"CYCLONEDDS_URI", folder.path().string()}}), " is not a regular file"));
  // What is missing, or is no XML, is for Cyclone DDS to tell.
  for (const std::string& uri :
       {file, "file://" + file, xml + "," + file, folder.file("none"), xml, std::string("<"),
        std::string(","), "<a>" + pipe + "</a>", "<a/>" + pipe, "<" + pipe + ","})
    EXPECT_EQ(read({{"CYCLONEDDS_URI", uri}}).cyclone_uri, uri);
}

/// As in a container without a network, which has the loopback interface alone.
TEST(RosEnvironment, LoopbackIsNoNetwork) {
  enum Outcome { none, found, cannot_be_tried };
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const bool is_apart = ::unshare(CLONE_NEWNET) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0;
    if (!is_apart) ::_exit(cannot_be_tried);
    try {
      test::set_loopback(true);
    } catch (const std::runtime_error&) {  // the child is not to go on with other tests
      ::_exit(cannot_be_tried);
    }
    ::_exit(network_addresses().empty() ? none : found);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == cannot_be_tried) GTEST_SKIP() << "no network of its own can be made here";
  EXPECT_EQ(WEXITSTATUS(status), none);
}

TEST(RosEnvironment, WaitsForNoPipeOfRevokedCertificates) {
  const test::TemporaryDirectory keystore;
  for (const EnclaveFile& file : kEnclaveFiles) keystore.write(std::string("enclaves/") + file.name, "");
  const Variables variables{{"ROS_SECURITY_ENABLE", "true"},
                            {"ROS_SECURITY_KEYSTORE", keystore.path().string()}};
  EXPECT_EQ(refusal(variables), "taken");
  const std::string revoked = keystore.file("enclaves/crl.pem");
  ASSERT_EQ(::mkfifo(revoked.c_str(), 0600), 0);
  EXPECT_TRUE(has(refusal(variables), revoked + " is not a regular file")) << refusal(variables);
}

}  // namespace
}  // namespace gridmerge::internal
