// SPDX-License-Identifier: Apache-2.0
#include "fuzz_bag.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  const std::string_view bytes = fuzz::as_bytes(data, size);
  if (bytes.starts_with(std::string_view("SQLite format 3\0", 16))) fuzz::read_bag(bytes);
  return 0;
}
