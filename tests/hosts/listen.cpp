// SPDX-License-Identifier: Apache-2.0
// usage: gridmerge_listen DOMAIN TOPIC...
// What nodes publish, as a line of JSON twice per second until it is killed: each topic's newest map as a
// hash of all that counts of it, and the values of each diagnosis of the last seconds.
#include <dds/dds.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <type_traits>

#include "../dds/peer.hpp"

namespace {

using gridmerge::test::RawMap;

/// FNV-1a, which is the same on every machine.
class Hash {
 public:
  template <typename T>
  Hash& add(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3U;
    return *this;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

std::uint64_t hash_of(const RawMap& map) {
  Hash hash;
  hash.add(map.width).add(map.height).add(map.resolution).add(map.x).add(map.y).add(map.yaw);
  for (const std::int8_t value : map.data) hash.add(value);
  return hash.value();
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::cerr << "usage: gridmerge_listen DOMAIN TOPIC...\n";
    return 2;
  }
  gridmerge::test::Peer peer(static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10)));
  using Clock = std::chrono::steady_clock;
  struct Last {
    std::uint64_t received = 0;
    Clock::time_point at;
  };
  constexpr std::chrono::seconds kFresh{3};  // nodes tell each second
  std::map<std::string, Last> last;
  nlohmann::json maps = nlohmann::json::object();
  for (;;) {
    for (int i = 2; i < count; ++i) {
      const std::string topic = arguments[i];
      if (const auto map = peer.take_map(topic))
        maps[topic] = {{"hash", hash_of(*map)}, {"width", map->width}, {"height", map->height}};
    }
    nlohmann::json robots = nlohmann::json::object();
    for (const auto& [name, diagnosis] : peer.diagnoses()) {
      Last& seen = last[name];
      if (seen.received != diagnosis.received) seen = {diagnosis.received, Clock::now()};
      if (Clock::now() - seen.at < kFresh) robots[name] = diagnosis.values;
    }
    std::cout << nlohmann::json{{"maps", maps}, {"diagnoses", robots}} << std::endl;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
}
