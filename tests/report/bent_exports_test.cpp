// SPDX-License-Identifier: Apache-2.0
// Exports of maps that are bent or stretched.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "gridmerge/report/merge_output.hpp"
#include "report/interchange_support.hpp"
#include "report/results.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

/// By so much along both axes, within 60 m about the origin.
Deformation stretched(double along_x, double along_y) {
  constexpr double kSpacing = 60.0;
  std::vector<Point2> shifts;
  for (int i = 0; i < 16; ++i) {
    const Point2 at{(i % 4 - 1.5) * kSpacing, (i / 4 - 1.5) * kSpacing};
    shifts.push_back({(along_x - 1.0) * at.x, (along_y - 1.0) * at.y});
  }
  return {{-0.5 * kSpacing, -0.5 * kSpacing, 0.0}, kSpacing, 4, 4, shifts};
}

/// The middle of a wide map is 1 m or so above its ends.
Deformation bulging() {
  constexpr double kSpacing = 3.0;
  std::vector<Point2> shifts;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 9; ++column)
      shifts.push_back({0.0, std::sin(std::numbers::pi * (column - 1) / 6.0)});
  }
  return {{-3.0, -3.0, 0.0}, kSpacing, 9, 6, shifts};
}

/// Two maps of 12 m x 6 m, of which nothing is known about the corners of the second, and which is deformed.
struct BentPair {
  explicit BentPair(const Deformation& deformation) {
    OccupancyGrid map = make_grid(24, 12, 0.5, {0.0, 0.0, 0.0}, Cell::free);
    maps.push_back(map);
    for (int row = 0; row < map.height; ++row) {
      for (int column = 0; column < map.width; ++column) {
        if (std::abs(column - 11.5) + std::abs(row - 5.5) > 14.0) map.at(column, row) = Cell::unknown;
      }
    }
    maps.push_back(map);
    result = merged(maps, {{{0, {}}, {1, {2.0, -1.0, 0.5}, {}, {}, deformation}}});
  }
  const Member& bent() const { return result.components[0].members[1]; }
  std::string text(ExportFormat format) const { return export_text(format, {names, maps, result}); }

  std::vector<OccupancyGrid> maps;
  std::vector<std::string> names = fleet_names(2);
  MergeResult result;
};

/// How a similarity that is fitted to points does.
struct Fit {
  double scale = 0.0, residual = 0.0;
};

/// By four unknowns: x and y go to a x - b y + c and b x + a y + d.
Fit fit(const std::vector<Point2>& from, const std::vector<Point2>& to) {
  const auto rows = static_cast<Eigen::Index>(2 * from.size());
  Eigen::MatrixXd A(rows, 4);
  Eigen::VectorXd b(rows);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    A.row(row) << from[i].x, -from[i].y, 1.0, 0.0;
    A.row(row + 1) << from[i].y, from[i].x, 0.0, 1.0;
    b.segment<2>(row) << to[i].x, to[i].y;
  }
  const Eigen::Vector4d found = A.colPivHouseholderQr().solve(b);
  return {std::hypot(found[0], found[1]),
          (A * found - b).norm() / std::sqrt(static_cast<double>(from.size()))};
}

/// The centres of all known cells.
std::vector<Point2> known_cells(const OccupancyGrid& map) {
  std::vector<Point2> cells;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) != Cell::unknown) cells.push_back(map.cell_centre(column, row));
    }
  }
  return cells;
}

TEST(BentExports, OpenRmfHasPointsWhereTheMapPutsThem) {
  for (const Deformation& deformation : {stretched(1.05, 1.05), stretched(1.05, 0.96), bulging()}) {
    const BentPair pair(deformation);
    const YAML::Node one = YAML::Load(pair.text(ExportFormat::open_rmf))["maps"][1];
    const auto points = [&](const char* key) {
      std::vector<Point2> read;
      for (const YAML::Node& point : one["cartesian_meters"]["reference_coordinates"]["merged"][key])
        read.push_back({point[0].as<double>(), point[1].as<double>()});
      return read;
    };
    const std::vector<Point2> rmf = points("rmf"), robot = points("robot");
    ASSERT_EQ(rmf.size(), robot.size());
    const bool is_similar = deformation.kind() == MapTransform::similarity;
    EXPECT_EQ(robot.size(), is_similar ? 4u : 4u + 16u);
    for (std::size_t i = 0; i < robot.size(); ++i) {
      const Point2 place = pair.bent().to_component(robot[i]);
      EXPECT_NEAR(rmf[i].x, place.x, 2e-6);
      EXPECT_NEAR(rmf[i].y, place.y, 2e-6);
    }
    const Fit best = fit(robot, rmf);
    EXPECT_NEAR(one["scale"].as<double>(), best.scale, 1e-5);
    EXPECT_NEAR(one["residual"].as<double>(), best.residual, 1e-5);
    // What the points say is about what all cells would say.
    const std::vector<Point2> cells = known_cells(pair.maps[1]);
    std::vector<Point2> placed;
    for (const Point2& cell : cells) placed.push_back(pair.bent().to_component(cell));
    const Fit of_all = fit(cells, placed);
    EXPECT_NEAR(best.scale, of_all.scale, 0.01);
    if (is_similar) {
      EXPECT_NEAR(best.scale, 1.05, 1e-6);
      EXPECT_NEAR(best.residual, 0.0, 1e-5);
    } else {
      EXPECT_GT(best.residual, 0.05);
      EXPECT_LT(best.residual, 2.0 * of_all.residual);
      EXPECT_GT(best.residual, 0.5 * of_all.residual);
    }
  }
}

TEST(BentExports, OutlinesHoldTheMapAsItIsPlaced) {
  for (const Deformation& deformation : {stretched(1.05, 1.05), stretched(1.05, 0.96), bulging()}) {
    const BentPair pair(deformation);
    const auto json = nlohmann::json::parse(pair.text(ExportFormat::geojson));
    std::vector<Point2> ring;
    for (const auto& position : json["features"][2]["geometry"]["coordinates"][0])
      ring.push_back({position[0], position[1]});
    ring.pop_back();
    EXPECT_GT(twice_area(ring), 0.0);
    std::vector<Point2> corners;
    for (const Point2& cell : known_cells(pair.maps[1])) {
      for (const double dx : {-0.25, 0.25}) {
        for (const double dy : {-0.25, 0.25})
          corners.push_back(pair.bent().to_component({cell.x + dx, cell.y + dy}));
      }
    }
    for (const Point2& corner : corners) EXPECT_LT(outside(ring, corner), 1e-5);
    for (const Point2& point : ring) {
      EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](const Point2& corner) {
        return std::hypot(corner.x - point.x, corner.y - point.y) < 1e-5;
      }));
    }
  }
}

TEST(BentExports, G2oSaysThatItHasPosesAlone) {
  const std::string note = "# of maps that are bent or stretched these are the rigid parts";
  EXPECT_NE(BentPair(bulging()).text(ExportFormat::g2o).find(note), std::string::npos);
  EXPECT_EQ(BentPair({}).text(ExportFormat::g2o).find(note), std::string::npos);
}

}  // namespace
}  // namespace gridmerge
