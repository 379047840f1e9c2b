// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
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
  std::string enclave = "/";              // whose identity and permissions the node has
  std::filesystem::path enclave_files;    // folder of these; empty: DDS Security is off
};

/// What a folder of an enclave holds, as ROS's tools (`ros2 security`) make it.
struct EnclaveFile {
  const char* name;
  const char* property;  ///< that names it in the standard (OMG DDS Security 1.1, tables 42 and 49)
};
inline constexpr std::array kEnclaveFiles{
    EnclaveFile{"identity_ca.cert.pem", "dds.sec.auth.identity_ca"},
    EnclaveFile{"cert.pem", "dds.sec.auth.identity_certificate"},
    EnclaveFile{"key.pem", "dds.sec.auth.private_key"},
    EnclaveFile{"permissions_ca.cert.pem", "dds.sec.access.permissions_ca"},
    EnclaveFile{"governance.p7s", "dds.sec.access.governance"},
    EnclaveFile{"permissions.p7s", "dds.sec.access.permissions"}};
/// Not in every keystore; the property is Cyclone DDS's own.
inline constexpr EnclaveFile kRevokedCertificates{"crl.pem", "org.eclipse.cyclonedds.sec.auth.crl"};

/// Reads ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS and
/// CYCLONEDDS_URI as ROS does: one that is empty is not set, and ROS_LOCALHOST_ONLY=1 counts for more than
/// the two that replace it. With ROS_SECURITY_ENABLE=true also ROS_SECURITY_KEYSTORE and
/// ROS_SECURITY_ENCLAVE_OVERRIDE, which counts for more than `enclave`, a name such as "/robots/merger".
/// Throws std::runtime_error that names the variable for a value that ROS would not take; for
/// ROS_AUTOMATIC_DISCOVERY_RANGE=OFF, with which no robot can be found; where CYCLONEDDS_URI names a pipe or
/// anything else but a file; and where a file of the enclave is missing, whatever ROS_SECURITY_STRATEGY says:
/// a node that is to be secure does not speak openly.
RosEnvironment read_ros_environment(const Environment& environment, const std::string& enclave = "/");

/// Whether a node's enclave can be called so: "/", or levels of letters, digits and '_', each with a slash
/// before it.
bool is_enclave_name(const std::string& name);

/// Cyclone DDS's configuration that does the same: XML, and behind a comma CYCLONEDDS_URI. Messages above
/// `largest_message` bytes are not taken in.
std::string cyclone_configuration(const RosEnvironment& environment, std::uint64_t largest_message,
                                  bool network);

}  // namespace gridmerge::internal
