// SPDX-License-Identifier: Apache-2.0
#include "dds/network.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

namespace gridmerge::internal {

namespace {

namespace fs = std::filesystem;

/// Whether it is a bridge of virtual interfaces alone.
bool is_inner_bridge(const std::string& interface) {
  const fs::path interfaces = "/sys/class/net";
  std::error_code error;
  fs::directory_iterator port(interfaces / interface / "brif", error);
  if (error) return false;
  for (; !error && port != fs::directory_iterator(); port.increment(error))
    if (fs::exists(interfaces / port->path().filename() / "device", error)) return false;
  return true;
}

bool contains(const NetworkAddresses& addresses, const NetworkAddress& one) {
  return std::any_of(addresses.begin(), addresses.end(), [&](const NetworkAddress& other) {
    return other.interface == one.interface && other.index == one.index && other.ipv4 == one.ipv4;
  });
}

}  // namespace

NetworkAddresses network_addresses() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  NetworkAddresses addresses;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    const bool is_up = (one->ifa_flags & IFF_UP) != 0 && (one->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_up || one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address{};
    std::memcpy(&address, one->ifa_addr, sizeof address);
    const bool leads_out = (one->ifa_flags & IFF_RUNNING) != 0 && !is_inner_bridge(one->ifa_name);
    addresses.insert({one->ifa_name, ::if_nametoindex(one->ifa_name), address.sin_addr.s_addr, leads_out});
  }
  ::freeifaddrs(all);
  return addresses;
}

NetworkWatch::Change NetworkWatch::look(const NetworkAddresses& now) {
  const bool is_steady = now == last_;
  last_ = now;
  if (!is_steady) return Change::none;
  if (now.empty()) {
    const bool was_there = !begun_with_.empty() && !is_gone_;
    is_gone_ = true;
    return was_there ? Change::gone : Change::none;
  }
  is_gone_ = false;
  const auto leads_out = [](const NetworkAddress& one) { return one.leads_out; };
  const bool has_all = std::all_of(begun_with_.begin(), begun_with_.end(),
                                   [&](const NetworkAddress& one) { return contains(now, one); });
  // A carrier that comes later is no reason: DDS has the address already.
  const bool is_first_out = std::none_of(begun_with_.begin(), begun_with_.end(), leads_out) &&
                            std::any_of(now.begin(), now.end(), [&](const NetworkAddress& one) {
                              return one.leads_out && !contains(begun_with_, one);
                            });
  if (has_all && !begun_with_.empty() && !is_first_out) return Change::none;
  begun_with_ = now;
  return Change::replaced;
}

}  // namespace gridmerge::internal
