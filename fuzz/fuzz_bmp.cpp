// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.hpp"
#include "io/bmp.hpp"
#include "io/parse_error.hpp"

using namespace gridmerge::internal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  try {
    const MapImage image = decode_bmp(fuzz::as_bytes(data, size), fuzz::kMaxPixels);
    fuzz::require(fuzz::is_sound(image));
  } catch (const ParseError&) {
  }
  return 0;
}
