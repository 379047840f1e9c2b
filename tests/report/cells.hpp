// SPDX-License-Identifier: Apache-2.0
// Reads what the report page's script reads.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::test {

inline std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) throw std::runtime_error("no base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xffu);
  }
  return bytes;
}

/// The cells of a map or component of the page's data; throws when they do not fit its size.
inline std::vector<Cell> cells_of(const nlohmann::json& map) {
  const std::string stream = from_base64(map.at("cells").get<std::string>());
  const std::size_t count = map.at("width").get<std::size_t>() * map.at("height").get<std::size_t>();
  std::vector<Cell> cells(count + 1);
  uLongf size = cells.size();
  if (uncompress(reinterpret_cast<Bytef*>(cells.data()), &size, reinterpret_cast<const Bytef*>(stream.data()),
                 stream.size()) != Z_OK ||
      size != count)
    throw std::runtime_error("no zlib stream of the map's cells");
  cells.resize(count);
  return cells;
}

}  // namespace gridmerge::test
