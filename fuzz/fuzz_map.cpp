// SPDX-License-Identifier: Apache-2.0
// A whole map in one input: the YAML up to its end mark, a line "...", then the image.
#include <algorithm>

#include "fuzz_target.hpp"
#include "io/image.hpp"
#include "io/interpret.hpp"
#include "io/parse_error.hpp"

using namespace gridmerge::internal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  constexpr std::string_view kEnd = "\n...\n";
  const std::string_view bytes = fuzz::as_bytes(data, size);
  const std::size_t end = bytes.find(kEnd);
  if (end == std::string_view::npos) return 0;
  try {
    const MapYaml yaml = parse_map_yaml(bytes.substr(0, end));
    const MapImage image = decode_image(bytes.substr(end + kEnd.size()), fuzz::kMaxPixels);
    fuzz::require(fuzz::is_sound(image));
    const OccupancyGrid grid = interpret(yaml, image).grid;
    validate(grid);
    const auto sound = [](float p) { return !(p < 0.0f || p > 1.0f); };  // unknown is NaN
    fuzz::require(std::all_of(grid.probability.begin(), grid.probability.end(), sound));
  } catch (const ParseError&) {
  }
  return 0;
}
