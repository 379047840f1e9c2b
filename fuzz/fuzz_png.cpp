// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "fuzz_target.hpp"
#include "io/png.hpp"
#include "io/png_map.hpp"

using namespace gridmerge::internal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  PngImage image;
  try {
    image = decode_png(fuzz::as_bytes(data, size), fuzz::kMaxPixels);
  } catch (const std::runtime_error&) {
    return 0;
  }
  fuzz::require(image.width > 0 && image.height > 0 && image.channels >= 1 && image.channels <= 4);
  const std::size_t sample_bytes = static_cast<std::size_t>(image.bit_depth / 8);
  fuzz::require(sample_bytes == 1 || sample_bytes == 2);
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  fuzz::require(image.samples.size() == pixels * static_cast<std::size_t>(image.channels) * sample_bytes);
  // What a map takes of it is of the same picture.
  const MapImage map = decode_png_map(fuzz::as_bytes(data, size), fuzz::kMaxPixels);
  fuzz::require(fuzz::is_sound(map) && map.width == image.width && map.height == image.height);
  if (sample_bytes == 1) fuzz::require(decode_png(encode_png(image)).samples == image.samples);
  return 0;
}
