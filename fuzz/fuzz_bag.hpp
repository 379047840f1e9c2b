// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>
#include <string_view>

#include "fuzz_target.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/io/file_error.hpp"

namespace gridmerge::fuzz {

/// Reads all maps of a bag with these bytes: a file in memory, as the reader reads files.
inline void read_bag(std::string_view bytes) {
  static const int file = ::memfd_create("bag", MFD_CLOEXEC);
  require(::ftruncate(file, 0) == 0 &&
          ::pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  try {
    const Bag bag(path, {.max_cells = kMaxPixels});
    for (const BagTopic& topic : bag.map_topics()) {
      if (topic.encoding != "cdr") continue;
      BagMaps maps(bag, topic.name);
      for (std::size_t messages = maps.messages(), read = 0; read < messages; ++read) {
        try {
          const auto map = maps.next();
          if (!map) break;
          validate(map->grid);
        } catch (const FileError& error) {
          require(std::string_view(error.what()).starts_with(path));
        }
      }
    }
  } catch (const FileError& error) {
    require(std::string_view(error.what()).starts_with(path));
  }
}

}  // namespace gridmerge::fuzz
