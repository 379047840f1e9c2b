// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.hpp"
#include "io/map_yaml.hpp"
#include "io/parse_error.hpp"

using namespace gridmerge::internal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  try {
    const MapYaml map = parse_map_yaml(fuzz::as_bytes(data, size));
    const MapYaml again = parse_map_yaml(format_map_yaml(map));
    fuzz::require(again.image == map.image && again.resolution == map.resolution &&
                  again.origin == map.origin && again.occupied_thresh == map.occupied_thresh &&
                  again.free_thresh == map.free_thresh && again.negate == map.negate &&
                  again.mode == map.mode);
  } catch (const ParseError&) {
  }
  return 0;
}
