// SPDX-License-Identifier: Apache-2.0
#include "dds/participant.hpp"

#include <dds/dds.h>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "running_node.hpp"

namespace gridmerge::internal {
namespace {

/// The file that a name leads to, as the dynamic linker sees it.
std::string file_of(const char* name) {
  Dl_info info{};
  void* const address = ::dlsym(RTLD_DEFAULT, name);
  if (address == nullptr || ::dladdr(address, &info) == 0) return "none";
  return info.dli_fname;
}

// Descriptions of types, over which Cyclone DDS 0.10.2 crashes, do not reach it.
TEST(Participant, KeepsDescriptionsOfTypesFromCycloneDds) {
  test::own_domain();
  const Participant participant(read_ros_environment(process_environment), 1 << 20);
  EXPECT_NE(file_of("dds_create_participant").find("libddsc"), std::string::npos);
  for (const char* name : {"ddsi_tl_handle_request", "ddsi_tl_handle_reply"})
    EXPECT_EQ(file_of(name).find("libddsc"), std::string::npos) << file_of(name);
}

// What anybody may send, as often as they like.
TEST(Participant, CountsWhatIsLoggedAgainAndAgain) {
  const std::uint32_t domain = test::own_domain();
  Participant participant(read_ros_environment(process_environment), 1 << 20);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in port{};
  port.sin_family = AF_INET;
  port.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  port.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain + 10));  // of a domain's first one
  std::string malformed = "RTPS\x02\x01\x01\x10............\x15\x01";
  malformed += std::string("\x60\xea", 2) + std::string(20, '\1');  // longer than the packet
  std::uint64_t count = 0;
  std::set<std::string> kinds;
  EXPECT_TRUE(test::comes_true([&] {
    for (int i = 0; i < 100; ++i) {
      malformed[8] = static_cast<char>(i);
      ::sendto(socket, malformed.data(), malformed.size(), 0, reinterpret_cast<const sockaddr*>(&port),
               sizeof port);
    }
    const std::vector<Participant::LogLine> lines = participant.take_log();
    EXPECT_LE(lines.size(), 2u);
    for (const Participant::LogLine& line : lines) {
      kinds.insert(line.kind);
      count += line.count;
    }
    return count > 1000;
  })) << count;
  EXPECT_TRUE(kinds.contains("malformed packet received"));
  ::close(socket);
}

TEST(Participant, CountsFurtherKindsAsOne) {
  test::own_domain();
  Participant participant(read_ros_environment(process_environment), 1 << 20);
  participant.take_log();
  constexpr std::size_t kKinds = Participant::kMaxLogLines + 10;
  for (int times = 0; times < 3; ++times)
    for (std::size_t i = 0; i < kKinds; ++i)
      dds_log(DDS_LC_WARNING, __FILE__, __LINE__, __func__, "%s\n", std::string(i + 1, 'x').c_str());
  const std::vector<Participant::LogLine> lines = participant.take_log();
  ASSERT_EQ(lines.size(), Participant::kMaxLogLines);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    EXPECT_EQ(lines[i].kind, std::string(i + 1, 'x'));
    EXPECT_EQ(lines[i].count, 3u);
  }
  EXPECT_EQ(lines.back().kind, "");
  EXPECT_EQ(lines.back().text, std::string(Participant::kMaxLogLines, 'x'));
  EXPECT_EQ(lines.back().count, 3 * 11u);
}

TEST(Participant, SaysWhyItIsNotLetIn) {
  test::own_domain();
  RosEnvironment environment = read_ros_environment(process_environment);
  environment.cyclone_uri = "<CycloneDDS><Domain><NoSuchThing/></Domain></CycloneDDS>";
  try {
    const Participant participant(environment, 1 << 20);
    FAIL() << "it was let in";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("NoSuchThing"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gridmerge::internal
