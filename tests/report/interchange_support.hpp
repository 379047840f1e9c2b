// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <istream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "gridmerge/report/merge_output.hpp"
#include "io/support.hpp"
#include "merge/drawing.hpp"
#include "report/fleet.hpp"

namespace gridmerge::test {

inline double real_between(int low, int high) {
  return *rc::gen::inRange(low * 1000, high * 1000) / 1000.0;
}

inline SE2 any_pose() {
  return {real_between(-300, 300), real_between(-300, 300), normalize_angle(real_between(-4, 4))};
}

inline OccupancyGrid any_map() {
  OccupancyGrid map;
  map.width = *rc::gen::inRange(1, 12);
  map.height = *rc::gen::inRange(1, 12);
  map.resolution = 0.05 * *rc::gen::inRange(1, 5);
  map.origin = any_pose();
  map.cells.resize(static_cast<std::size_t>(map.width * map.height));
  for (Cell& cell : map.cells) cell = static_cast<Cell>(*rc::gen::inRange(0, 3));
  map.cells.front() = Cell::free;
  return map;
}

/// A fleet with maps.
struct Fleet {
  explicit Fleet(std::size_t count) : result(fleet(count, 1)), names(fleet_names(count)) {
    for (std::size_t i = 0; i < count; ++i) {
      maps.push_back(map_from({"#..#", ".##.", "...."}, 1.0 + 0.5 * static_cast<double>(i % 3)));
      maps.back().origin = {-30.0 + static_cast<double>(i), 12.0, 0.1 * static_cast<double>(i % 7)};
    }
  }
  NamedMerge named() const { return {names, maps, result}; }

  MergeResult result;
  std::vector<std::string> names;
  std::vector<OccupancyGrid> maps;
};

// A reader of g2o files of its own, by the format's documentation.
struct Graph {
  struct Edge {
    std::size_t from = 0, to = 0;
    Eigen::Matrix3d measurement, information;
  };
  std::map<std::size_t, Eigen::Vector3d> vertices;
  std::set<std::size_t> fixed;
  std::vector<Edge> edges;
};

inline Eigen::Matrix3d matrix_of(const Eigen::Vector3d& pose) {
  Eigen::Matrix3d matrix;
  matrix << std::cos(pose[2]), -std::sin(pose[2]), pose[0], std::sin(pose[2]), std::cos(pose[2]), pose[1],
      0.0, 0.0, 1.0;
  return matrix;
}

inline Eigen::Matrix3d matrix_of(const SE2& T) {
  return matrix_of(Eigen::Vector3d(T.x, T.y, T.theta));
}

inline Eigen::Vector3d read_vector(std::istream& line) {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) line >> vector[i];
  return vector;
}

inline Graph read_g2o(const std::string& text) {
  Graph graph;
  std::istringstream lines(text);
  for (std::string one; std::getline(lines, one);) {
    if (one.empty() || one[0] == '#') continue;
    std::istringstream line(one);
    std::string tag;
    line >> tag;
    if (tag == "VERTEX_SE2") {
      std::size_t id = 0;
      line >> id;
      const Eigen::Vector3d pose = read_vector(line);
      EXPECT_TRUE(graph.vertices.emplace(id, pose).second) << one;
    } else if (tag == "EDGE_SE2") {
      Graph::Edge edge;
      line >> edge.from >> edge.to;
      edge.measurement = matrix_of(read_vector(line));
      for (int row = 0; row < 3; ++row) {
        for (int column = row; column < 3; ++column) {
          line >> edge.information(row, column);
          edge.information(column, row) = edge.information(row, column);
        }
      }
      EXPECT_TRUE(graph.vertices.count(edge.from) == 1 && graph.vertices.count(edge.to) == 1) << one;
      graph.edges.push_back(edge);
    } else {
      EXPECT_EQ(tag, "FIX") << one;
      std::size_t id = 0;
      line >> id;
      EXPECT_EQ(graph.vertices.count(id), 1u) << one;
      graph.fixed.insert(id);
    }
    EXPECT_TRUE(line) << one;
    EXPECT_TRUE((line >> std::ws).eof()) << one;
  }
  return graph;
}

inline double twice_area(const std::vector<Point2>& corners) {
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += a.x * b.y - b.x * a.y;
  }
  return area;
}

/// How far outside a convex shape a point is, or less than 0 inside [m].
inline double outside(const std::vector<Point2>& corners, const Point2& p) {
  double most = -1e9;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    most = std::max(most, ((b.y - a.y) * (p.x - a.x) - (b.x - a.x) * (p.y - a.y)) / length);
  }
  return most;
}

}  // namespace gridmerge::test
