// SPDX-License-Identifier: Apache-2.0
#include "dds/participant.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

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
