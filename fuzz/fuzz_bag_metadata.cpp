// SPDX-License-Identifier: Apache-2.0
#include "bag/metadata.hpp"
#include "fuzz_target.hpp"
#include "io/parse_error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  try {
    const auto names = internal::parse_metadata(fuzz::as_bytes(data, size));
    fuzz::require(!names.empty());
    for (const std::string& name : names)
      fuzz::require(!name.empty() && name != ".." && name.find('/') == std::string::npos);
  } catch (const internal::ParseError&) {
  }
  return 0;
}
