// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <set>
#include <string>

namespace gridmerge::internal {

/// An address of this machine on a network.
struct NetworkAddress {
  std::string interface;
  unsigned index = 0;      // of the interface: another one when it was made anew under the same name
  std::uint32_t ipv4 = 0;  // in network byte order
  bool leads_out = true;   // to other machines, as far as can be seen: see network_addresses()

  // NOLINTNEXTLINE(modernize-use-nullptr): the 0 is one that the compiler puts there
  friend auto operator<=>(const NetworkAddress&, const NetworkAddress&) = default;
};
using NetworkAddresses = std::set<NetworkAddress>;

/// Those of interfaces that are up, without the loopback one. One without a carrier, and a bridge that has no
/// device among its ports, as docker's, lead to no other machine.
NetworkAddresses network_addresses();

/// Tells when DDS has to begin anew: it keeps to the addresses that were there when it began.
class NetworkWatch {
 public:
  enum class Change {
    none,
    gone,     // there is no network any more; told once
    replaced  // there is another one, and DDS does not hear it; or it may be the first that leads out
  };

  explicit NetworkWatch(const NetworkAddresses& begun_with) : begun_with_(begun_with), last_(begun_with) {}

  /// What DDS begins with: at first, and after `replaced`.
  const NetworkAddresses& begun_with() const { return begun_with_; }

  /// What has become of the network. Addresses count once they were there in two looks in a row: a network
  /// that comes up gets them one by one.
  Change look(const NetworkAddresses& now);

 private:
  NetworkAddresses begun_with_;
  NetworkAddresses last_;
  bool is_gone_ = false;
};

}  // namespace gridmerge::internal
