// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <sstream>
#include <string>

#include "gridmerge/grid/se2.hpp"

namespace gridmerge::test {

/// The poses of a pose graph in g2o's format, by id.
inline std::map<std::size_t, SE2> g2o_vertices(const std::string& text) {
  std::map<std::size_t, SE2> vertices;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    std::size_t id = 0;
    SE2 pose;
    if (words >> kind >> id >> pose.x >> pose.y >> pose.theta && kind == "VERTEX_SE2") vertices[id] = pose;
  }
  return vertices;
}

}  // namespace gridmerge::test
