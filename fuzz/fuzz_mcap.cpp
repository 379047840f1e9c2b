// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "fuzz_target.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/io/file_error.hpp"

namespace {

// A file in memory, as the reader reads files.
int memory_file() {
  static const int descriptor = ::memfd_create("bag", MFD_CLOEXEC);
  return descriptor;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  const std::string_view bytes = fuzz::as_bytes(data, size);
  if (!bytes.starts_with("\x89MCAP")) return 0;  // other files have targets of their own, or tests
  const int file = memory_file();
  fuzz::require(::ftruncate(file, 0) == 0 && ::pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  try {
    const Bag bag(path, {.max_cells = fuzz::kMaxPixels});
    for (const BagTopic& topic : bag.map_topics()) {
      if (topic.encoding != "cdr") continue;
      BagMaps maps(bag, topic.name);
      for (std::size_t messages = maps.messages(), read = 0; read < messages; ++read) {
        try {
          const auto map = maps.next();
          if (!map) break;
          validate(map->grid);
        } catch (const FileError& error) {
          fuzz::require(std::string_view(error.what()).starts_with(path));
        }
      }
    }
  } catch (const FileError& error) {
    fuzz::require(std::string_view(error.what()).starts_with(path));
  }
  return 0;
}
