// SPDX-License-Identifier: Apache-2.0
#include "dds/network.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>

namespace gridmerge::internal {

NetworkAddresses network_addresses() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  NetworkAddresses addresses;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    const bool is_up = (one->ifa_flags & IFF_UP) != 0 && (one->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_up || one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address{};
    std::memcpy(&address, one->ifa_addr, sizeof address);
    addresses.insert({one->ifa_name, ::if_nametoindex(one->ifa_name), address.sin_addr.s_addr});
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
  const bool has_all = std::includes(now.begin(), now.end(), begun_with_.begin(), begun_with_.end());
  if (has_all && !begun_with_.empty()) return Change::none;
  begun_with_ = now;
  return Change::replaced;
}

}  // namespace gridmerge::internal
