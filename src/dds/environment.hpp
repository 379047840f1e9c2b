// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gridmerge::internal {

/// The value of an environment variable; none where it is not set.
using Environment = std::function<std::optional<std::string>(const std::string& name)>;

/// That of this process.
std::optional<std::string> process_environment(const std::string& name);

/// Where other nodes are looked for.
enum class DiscoveryRange { subnet, localhost, system_default };

/// What ROS's variables say to its middleware.
struct RosEnvironment {
  std::uint32_t domain = 0;
  DiscoveryRange range = DiscoveryRange::subnet;
  std::vector<std::string> static_peers;  // addresses and host names
  std::string cyclone_uri;                // Cyclone DDS's own settings, which count for more
};

/// Reads ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS and
/// CYCLONEDDS_URI as ROS does: one that is empty is not set, and ROS_LOCALHOST_ONLY=1 counts for more than
/// the two that replace it. Throws std::runtime_error that names the variable for a value that ROS would not
/// take; for ROS_AUTOMATIC_DISCOVERY_RANGE=OFF, with which no robot can be found; and for
/// ROS_SECURITY_ENABLE=true, since DDS Security is not set up here.
RosEnvironment read_ros_environment(const Environment& environment);

/// Whether this machine has an interface, up and with an address, that is not a loopback one.
bool has_network();

/// Cyclone DDS's configuration that does the same: XML, and behind a comma CYCLONEDDS_URI. Messages above
/// `largest_message` bytes are not taken in.
std::string cyclone_configuration(const RosEnvironment& environment, std::uint64_t largest_message,
                                  bool network);

}  // namespace gridmerge::internal
