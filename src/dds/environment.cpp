// SPDX-License-Identifier: Apache-2.0
#include "dds/environment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "dds/names.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::uint32_t kLargestDomain = 232;  // its ports would lie above 65535
constexpr int kMaxLocalParticipants = 32;      // as ROS's other middleware looks for on one machine

/// What is set and not empty.
std::string value_of(const Environment& environment, const char* name) {
  return environment(name).value_or(std::string());
}

[[noreturn]] void refuse(const char* name, std::string_view value, std::string_view why) {
  throw std::runtime_error(fmt::format("{}='{}': {}", name, value, why));
}

std::uint32_t read_domain(const Environment& environment) {
  constexpr const char* kName = "ROS_DOMAIN_ID";
  const std::string text = value_of(environment, kName);
  if (text.empty()) return 0;
  std::uint32_t domain = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), domain);
  if (error != std::errc() || end != text.data() + text.size() || domain > kLargestDomain)
    refuse(kName, text, fmt::format("is no whole number from 0 to {}", kLargestDomain));
  return domain;
}

bool is_localhost_only(const Environment& environment) {
  constexpr const char* kName = "ROS_LOCALHOST_ONLY";
  const std::string text = value_of(environment, kName);
  if (!text.empty() && text != "0" && text != "1") refuse(kName, text, "is neither 0 nor 1");
  return text == "1";
}

DiscoveryRange read_range(const Environment& environment) {
  constexpr const char* kName = "ROS_AUTOMATIC_DISCOVERY_RANGE";
  const std::string text = value_of(environment, kName);
  if (text.empty() || text == "SUBNET") return DiscoveryRange::subnet;
  if (text == "LOCALHOST") return DiscoveryRange::localhost;
  if (text == "SYSTEM_DEFAULT") return DiscoveryRange::system_default;
  if (text == "OFF") refuse(kName, text, "no robot can be found so");
  refuse(kName, text, "is none of SUBNET, LOCALHOST, SYSTEM_DEFAULT and OFF");
}

// The names go into XML, where these characters stand for themselves.
bool is_address_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view(".:-_[]%").find(c) != std::string_view::npos;
}

std::vector<std::string> read_peers(const Environment& environment) {
  constexpr const char* kName = "ROS_STATIC_PEERS";
  const std::string text = value_of(environment, kName);
  std::vector<std::string> peers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const std::string peer = text.substr(begin, end - begin);
    if (!std::all_of(peer.begin(), peer.end(), is_address_character))
      refuse(kName, text, fmt::format("'{}' is neither an address nor the name of a host", peer));
    if (!peer.empty()) peers.push_back(peer);
    begin = end + 1;
  }
  return peers;
}

/// What a list of Cyclone DDS's settings holds that is no XML: names of files. XML goes on to a comma behind
/// a tag.
std::vector<std::string> files_in(const std::string& uri) {
  constexpr const char* kSpace = " \t\n\v\f\r";
  constexpr const char* kBetween = " \t\n\v\f\r,";
  std::vector<std::string> files;
  for (std::size_t begin = uri.find_first_not_of(kBetween); begin < uri.size();) {
    std::size_t end = begin;
    if (uri[begin] == '<') {
      do {
        end = uri.find_first_not_of(kSpace, std::min(uri.find('>', end), uri.size() - 1) + 1);
      } while (end < uri.size() && uri[end] != ',');
    } else {
      end = uri.find(',', begin);
      files.push_back(uri.substr(begin, end - begin));
    }
    begin = uri.find_first_not_of(kBetween, std::min(end, uri.size()));
  }
  return files;
}

/// Cyclone DDS opens whatever bears the name, and would wait for good for who writes to a pipe.
std::string read_cyclone_uri(const Environment& environment) {
  constexpr const char* kName = "CYCLONEDDS_URI";
  constexpr std::string_view kScheme = "file://";
  std::string uri = value_of(environment, kName);
  for (std::string file : files_in(uri)) {
    std::error_code error;
    if (!std::filesystem::exists(file, error) && file.starts_with(kScheme)) file.erase(0, kScheme.size());
    if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
      refuse(kName, uri, fmt::format("{} is not a regular file", file));
  }
  return uri;
}

/// Where the enclave's files are; all of them are there.
std::filesystem::path find_enclave(const Environment& environment, const std::string& enclave) {
  constexpr const char* kKeystore = "ROS_SECURITY_KEYSTORE";
  const std::string keystore = value_of(environment, kKeystore);
  if (keystore.empty()) refuse("ROS_SECURITY_ENABLE", "true", fmt::format("{} is not set", kKeystore));
  std::filesystem::path folder =
      std::filesystem::absolute(keystore) / "enclaves" / std::filesystem::path(enclave).relative_path();
  for (const EnclaveFile& file : kEnclaveFiles) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(folder / file.name, error))
      refuse(kKeystore, keystore,
             fmt::format("the enclave {} has no file {}", enclave, (folder / file.name).string()));
  }
  const std::filesystem::path revoked = folder / kRevokedCertificates.name;
  std::error_code error;
  if (std::filesystem::exists(revoked, error) && !std::filesystem::is_regular_file(revoked, error))
    refuse(kKeystore, keystore, fmt::format("{} is not a regular file", revoked.string()));
  return folder;
}

}  // namespace

std::optional<std::string> process_environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  if (value == nullptr) return std::nullopt;
  return std::string(value);
}

bool is_enclave_name(const std::string& name) {
  return name == "/" || is_topic_name(name);
}

RosEnvironment read_ros_environment(const Environment& environment, const std::string& enclave) {
  RosEnvironment read;
  read.enclave = enclave;
  if (value_of(environment, "ROS_SECURITY_ENABLE") == "true") {
    constexpr const char* kOverride = "ROS_SECURITY_ENCLAVE_OVERRIDE";
    const std::string instead = value_of(environment, kOverride);
    if (!instead.empty()) read.enclave = instead;
    if (!is_enclave_name(read.enclave)) refuse(kOverride, instead, "is no enclave's name, as /robots/merger");
    read.enclave_files = find_enclave(environment, read.enclave);
  }
  read.domain = read_domain(environment);
  read.cyclone_uri = read_cyclone_uri(environment);
  if (is_localhost_only(environment)) {
    read.range = DiscoveryRange::localhost;
    return read;
  }
  read.range = read_range(environment);
  if (read.range != DiscoveryRange::system_default) read.static_peers = read_peers(environment);
  return read;
}

std::string cyclone_configuration(const RosEnvironment& environment, std::uint64_t largest_message,
                                  bool network) {
  std::string general;
  std::vector<std::string> peers = environment.static_peers;
  if (environment.range == DiscoveryRange::localhost) {
    // Other nodes of this machine may go by the loopback address alone, or by that of its network alone.
    // CYCLONEDDS_URI could only add interfaces to these, so that it is left to name them all.
    if (environment.cyclone_uri.empty())
      general += fmt::format("<Interfaces><NetworkInterface address=\"127.0.0.1\"/>{}</Interfaces>",
                             network ? "<NetworkInterface autodetermine=\"true\"/>" : "");
    general += "<AllowMulticast>false</AllowMulticast>";
    peers.insert(peers.begin(), "127.0.0.1");
  }
  std::string discovery;
  if (!peers.empty()) {
    // Peers look at well-known ports, of which a participant takes one only if it is told to. Nobody hears a
    // peer that starts later, where there is no multicast: so peers are called every second, not every 30.
    discovery += fmt::format(
        "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>"
        "<SPDPInterval>1s</SPDPInterval><Peers>",
        kMaxLocalParticipants);
    for (const std::string& peer : peers)
      fmt::format_to(std::back_inserter(discovery), "<Peer Address=\"{}\"/>", peer);
    discovery += "</Peers>";
  }
  // The two sizes of buffers let maps of 16 MB through; the least of the first is what the system grants.
  // A thread for each socket could only be ended by a packet to the node's own address, which may be gone.
  std::string configuration = fmt::format(
      "<CycloneDDS><Domain Id=\"any\"><General>{}</General><Discovery>{}</Discovery><Internal>"
      "<SocketReceiveBufferSize min=\"default\" max=\"4MB\"/>"
      "<MultipleReceiveThreads>false</MultipleReceiveThreads>"
      "<MaxQueuedRexmitBytes>1MB</MaxQueuedRexmitBytes><MaxSampleSize>{}B</MaxSampleSize>"
      "</Internal></Domain></CycloneDDS>",
      general, discovery, largest_message);
  if (!environment.cyclone_uri.empty()) configuration += "," + environment.cyclone_uri;
  return configuration;
}

}  // namespace gridmerge::internal
