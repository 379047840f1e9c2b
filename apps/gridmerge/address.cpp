// SPDX-License-Identifier: Apache-2.0
#include "address.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>

namespace gridmerge::cli {

namespace {

using Bytes = std::array<std::uint8_t, 16>;

/// As version 6 has it; one of version 4 is mapped into that.
Bytes bytes_of(const addrinfo& entry) {
  Bytes bytes{};
  if (entry.ai_family == AF_INET6) {
    sockaddr_in6 address{};
    std::memcpy(&address, entry.ai_addr, sizeof address);
    std::memcpy(bytes.data(), &address.sin6_addr, bytes.size());
  } else {
    sockaddr_in address{};
    std::memcpy(&address, entry.ai_addr, sizeof address);
    bytes[10] = bytes[11] = 0xff;
    std::memcpy(&bytes[12], &address.sin_addr, 4);
  }
  return bytes;
}

bool is_mapped(const Bytes& bytes) {
  return std::all_of(bytes.begin(), bytes.begin() + 10, [](std::uint8_t byte) { return byte == 0; }) &&
         bytes[10] == 0xff && bytes[11] == 0xff;
}

Address describe(const addrinfo& entry) {
  std::array<char, NI_MAXHOST> number{};
  if (::getnameinfo(entry.ai_addr, entry.ai_addrlen, number.data(), number.size(), nullptr, 0,
                    NI_NUMERICHOST) != 0)
    return {};
  const Bytes bytes = bytes_of(entry);
  const bool mapped = is_mapped(bytes);
  Bytes loopback{};
  loopback.back() = 1;
  return {.number = number.data(),
          .is_any = std::all_of(bytes.begin() + (mapped ? 12 : 0), bytes.end(),
                                [](std::uint8_t byte) { return byte == 0; }),
          .is_loopback = mapped ? bytes[12] == 127 : bytes == loopback};
}

}  // namespace

std::vector<Address> resolve(const std::string& text) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(text.c_str(), nullptr, &hints, &found) != 0) return {};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
  std::vector<Address> addresses;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    if (entry->ai_family != AF_INET && entry->ai_family != AF_INET6) continue;
    Address address = describe(*entry);
    if (!address.number.empty()) addresses.push_back(std::move(address));
  }
  return addresses;
}

}  // namespace gridmerge::cli
