// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/interchange.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "gridmerge/grid/resample.hpp"
#include "io/support.hpp"
#include "merge/coverage.hpp"
#include "merge/drawing.hpp"
#include "merge/pose_graph.hpp"
#include "report/fleet.hpp"
#include "report/interchange.hpp"
#include "report/results.hpp"
#include "report/told_joins.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using Json = nlohmann::json;
using test::contains;
using test::map_from;
using test::message_of;

double real_between(int low, int high) {
  return *rc::gen::inRange(low * 1000, high * 1000) / 1000.0;
}

SE2 any_pose() {
  return {real_between(-300, 300), real_between(-300, 300), normalize_angle(real_between(-4, 4))};
}

OccupancyGrid any_map() {
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
  explicit Fleet(std::size_t count) : result(test::fleet(count, 1)), names(test::fleet_names(count)) {
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

Eigen::Matrix3d matrix_of(const Eigen::Vector3d& pose) {
  Eigen::Matrix3d matrix;
  matrix << std::cos(pose[2]), -std::sin(pose[2]), pose[0], std::sin(pose[2]), std::cos(pose[2]), pose[1],
      0.0, 0.0, 1.0;
  return matrix;
}

Eigen::Matrix3d matrix_of(const SE2& T) {
  return matrix_of(Eigen::Vector3d(T.x, T.y, T.theta));
}

Eigen::Vector3d read_vector(std::istream& line) {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) line >> vector[i];
  return vector;
}

Graph read_g2o(const std::string& text) {
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

/// The error of an edge as g2o has it: the inverse measurement times what the vertices say.
Eigen::Vector3d error_of(const Graph::Edge& edge, const std::map<std::size_t, Eigen::Vector3d>& poses) {
  const Eigen::Matrix3d off =
      edge.measurement.inverse() * matrix_of(poses.at(edge.from)).inverse() * matrix_of(poses.at(edge.to));
  return {off(0, 2), off(1, 2), std::atan2(off(1, 0), off(0, 0))};
}

/// Gauss and Newton's method with numeric derivatives.
void optimise(Graph& graph) {
  std::map<std::size_t, int> place;
  for (const auto& [id, pose] : graph.vertices) {
    if (graph.fixed.count(id) == 0) place.emplace(id, 3 * static_cast<int>(place.size()));
  }
  const int size = 3 * static_cast<int>(place.size());
  for (int round = 0; round < 12; ++round) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
    for (const Graph::Edge& edge : graph.edges) {
      const Eigen::Vector3d error = error_of(edge, graph.vertices);
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, size);
      for (const std::size_t id : {edge.from, edge.to}) {
        if (place.count(id) == 0) continue;
        for (int k = 0; k < 3; ++k) {
          std::map<std::size_t, Eigen::Vector3d> moved{{edge.from, graph.vertices[edge.from]},
                                                       {edge.to, graph.vertices[edge.to]}};
          moved[id][k] += 1e-6;
          J.col(place[id] + k) = (error_of(edge, moved) - error) / 1e-6;
        }
      }
      H += J.transpose() * edge.information * J;
      b += J.transpose() * edge.information * error;
    }
    const Eigen::VectorXd step = H.ldlt().solve(-b);
    for (const auto& [id, at] : place) graph.vertices[id] += step.segment<3>(at);
  }
}

TEST(G2o, HasEveryPlacedMapAndEveryUsedJoin) {
  const Fleet fleet(30);
  const Graph graph = read_g2o(export_text(ExportFormat::g2o, fleet.named()));
  const std::vector<Member>& members = fleet.result.components[0].members;
  ASSERT_EQ(graph.vertices.size(), members.size());
  for (const Member& member : members)
    EXPECT_EQ(matrix_of(graph.vertices.at(member.map)), matrix_of(member.T_component_map));
  EXPECT_EQ(graph.fixed, std::set<std::size_t>{0});
  std::vector<const Join*> used;
  for (const Join& join : fleet.result.joins) {
    if (join.used()) used.push_back(&join);
  }
  ASSERT_EQ(graph.edges.size(), used.size());
  ASSERT_GT(used.size(), members.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    EXPECT_EQ(graph.edges[i].from, used[i]->fixed);
    EXPECT_EQ(graph.edges[i].to, used[i]->moving);
    EXPECT_EQ(graph.edges[i].measurement, matrix_of(used[i]->T_fixed_moving));
    EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(graph.edges[i].information).info(), Eigen::Success);
  }
}

TEST(G2o, IsSolvedByOthersToTheSamePoses) {
  const Fleet fleet(30);
  const Graph written = read_g2o(export_text(ExportFormat::g2o, fleet.named()));
  Graph solved = written;
  for (auto& [id, pose] : solved.vertices) {
    if (solved.fixed.count(id) == 0)
      pose += Eigen::Vector3d(0.3, -0.2, 0.05) * std::sin(static_cast<double>(id));
  }
  optimise(solved);
  for (const auto& [id, pose] : written.vertices)
    EXPECT_LT((matrix_of(solved.vertices[id]) - matrix_of(pose)).norm(), 1e-6) << id;
}

RC_GTEST_PROP(G2o, WeighsAnErrorAsTheMergeDoes, ()) {
  Fleet fleet(6);
  fleet.maps[0] = any_map();
  fleet.maps[1] = any_map();
  Join join = fleet.result.joins[0];
  join.T_fixed_moving = any_pose();
  const double sd = real_between(1, 3) / 10.0;
  join.match.hypotheses = {{join.T_fixed_moving, 1.0, 0.99}};
  set_deviation(join, sd);
  fleet.result.joins = {join};
  const Graph graph = read_g2o(export_text(ExportFormat::g2o, fleet.named()));
  RC_ASSERT(graph.edges.size() == 1u);
  const auto extent = [](const OccupancyGrid& map) { return Coverage(crop_to_known(map)).extent(); };
  const RelativePose measured =
      measured_between(0, 1, join.T_fixed_moving, extent(fleet.maps[0]), extent(fleet.maps[1]), sd);
  // How far a small error moves the place at which the deviations are known.
  const Eigen::Vector3d error(real_between(-1, 1) * 1e-6, real_between(-1, 1) * 1e-6,
                              real_between(-1, 1) * 1e-8);
  const Point2 p = measured.pivot, moved = SE2{error[0], error[1], error[2]} * p;
  const double expected = (std::pow(moved.x - p.x, 2) + std::pow(moved.y - p.y, 2)) / (sd * sd) +
                          std::pow(error[2] / measured.sd_theta, 2);
  const double weighed = error.dot(graph.edges[0].information * error);
  RC_ASSERT(std::abs(weighed - expected) <= 1e-4 * expected + 1e-18);
}

TEST(G2o, BeginsWithVerticesAndEdges) {
  // Some readers know these alone, and stop at anything else.
  const Fleet fleet(12);
  const std::string text = export_text(ExportFormat::g2o, fleet.named());
  EXPECT_GT(text.find("\nFIX "), text.rfind("\nEDGE_SE2 "));
  EXPECT_LT(text.rfind("\nVERTEX_SE2 "), text.find("\nEDGE_SE2 "));
  EXPECT_GT(text.find('#'), text.rfind("\nEDGE_SE2 "));
  EXPECT_EQ(text.find("VERTEX_SE2 "), 0u);
}

TEST(G2o, SaysWhereNoDeviationIsKnown) {
  Fleet fleet(6);
  Join join = fleet.result.joins[0];
  join.outcome = JoinOutcome::known;
  join.match.hypotheses.clear();
  fleet.result.joins = {join};
  const std::string text = export_text(ExportFormat::g2o, fleet.named());
  EXPECT_TRUE(contains(text, "# 0 to 1: no deviation is known")) << text;
  // That of agreement_tolerance(): half a metre for small maps.
  EXPECT_DOUBLE_EQ(read_g2o(text).edges.at(0).information(0, 0), 4.0);
}

TEST(G2o, FixesTheFixedMapsOfTheWorldsFrame) {
  Fleet fleet(8);
  Component& component = fleet.result.components[0];
  component.in_world_frame = true;
  for (Member& member : component.members) member.T_component_map.x += 5.0;
  component.members[2].sd = component.members[4].sd = PoseDeviation{};
  EXPECT_EQ(read_g2o(export_text(ExportFormat::g2o, fleet.named())).fixed, (std::set<std::size_t>{2, 4}));
  for (Member& member : component.members) member.sd = std::nullopt;
  EXPECT_EQ(read_g2o(export_text(ExportFormat::g2o, fleet.named())).fixed, std::set<std::size_t>{0});
}

/// The similarity that takes points to others best (least squares), as adapters estimate it. Expects a scale
/// of 1.
SE2 similarity(const std::vector<std::vector<double>>& from, const std::vector<std::vector<double>>& to) {
  using Complex = std::complex<double>;
  const auto count = static_cast<double>(from.size());
  Complex from_mean, to_mean, sum;
  for (const auto& p : from) from_mean += Complex(p.at(0), p.at(1)) / count;
  for (const auto& p : to) to_mean += Complex(p.at(0), p.at(1)) / count;
  double spread = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Complex p = Complex(from[i].at(0), from[i].at(1)) - from_mean;
    sum += std::conj(p) * (Complex(to.at(i).at(0), to[i].at(1)) - to_mean);
    spread += std::norm(p);
  }
  const Complex turn = sum / spread, shift = to_mean - turn * from_mean;
  EXPECT_NEAR(std::abs(turn), 1.0, 1e-5);
  return {shift.real(), shift.imag(), std::arg(turn)};
}

TEST(OpenRmf, HasPointsByWhichAdaptersFindTheTransform) {
  const Fleet fleet(12);
  const YAML::Node yaml = YAML::Load(export_text(ExportFormat::open_rmf, fleet.named()));
  const std::vector<Member>& members = fleet.result.components[0].members;
  ASSERT_EQ(yaml["maps"].size(), members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const YAML::Node one = yaml["maps"][i];
    EXPECT_EQ(one["source"].as<std::string>(), fleet.names[members[i].map]);
    EXPECT_EQ(one["merged_map"].as<std::string>(), "merged.yaml");
    const auto points = [&](const char* key) {
      return one["reference_coordinates"]["merged"][key].as<std::vector<std::vector<double>>>();
    };
    const auto rmf = points("rmf"), robot = points("robot");
    ASSERT_EQ(rmf.size(), 4u);
    ASSERT_EQ(robot.size(), 4u);
    const SE2 found = similarity(rmf, robot);
    const SE2 expected = inverse(members[i].T_component_map);
    EXPECT_LT((matrix_of(found) - matrix_of(expected)).norm(), 1e-4);
  }
}

TEST(OpenRmf, HasALevelForEachMergedMap) {
  const std::vector<OccupancyGrid> maps(4, map_from({"#.", ".#"}, 1e-3));
  const MergeResult result =
      test::merged(maps, {{{0, {}}, {1, {1e-5, 0.0, 0.0}}}, {{2, {}}, {3, {0.0, -1e-7, 0.5}}}});
  const std::string text = export_text(ExportFormat::open_rmf, {test::fleet_names(4), maps, result});
  EXPECT_FALSE(contains(text, "e-0")) << "YAML 1.1 takes it for a text";
  const YAML::Node yaml = YAML::Load(text);
  EXPECT_EQ(yaml["maps"][2]["merged_map"].as<std::string>(), "merged_2.yaml");
  EXPECT_TRUE(yaml["maps"][2]["reference_coordinates"]["merged_2"].IsMap());
}

TEST(Exports, TakeNamesForTextAlone) {
  const std::size_t count = test::kHostileNames.size();
  std::vector<std::string> names = test::kHostileNames;
  names.push_back("\x7f\xc2\x85\xe2\x80\xa8\xef\xbb\xbf: {[#\xf0\x9f\x98\x80");
  const std::vector<OccupancyGrid> maps(names.size(), map_from({"#.", ".#"}, 0.1));
  std::vector<Member> members;
  for (std::size_t i = 0; i < names.size(); ++i) members.push_back({i, {}});
  const MergeResult result = test::merged(maps, {members});
  const NamedMerge merge{names, maps, result};
  const Json geojson = Json::parse(export_text(ExportFormat::geojson, merge));
  const YAML::Node yaml = YAML::Load(export_text(ExportFormat::open_rmf, merge));
  EXPECT_EQ(read_g2o(export_text(ExportFormat::g2o, merge)).vertices.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto source = geojson["features"][i + 1]["properties"]["source"].get<std::string>();
    EXPECT_EQ(yaml["maps"][i]["source"].as<std::string>(), source);
    if (i != 2) {
      EXPECT_EQ(source, names[i]);
    }  // that one is not UTF-8
  }
  EXPECT_EQ(yaml["maps"][count]["source"].as<std::string>(), names[count]);
}

double twice_area(const std::vector<Point2>& corners) {
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += a.x * b.y - b.x * a.y;
  }
  return area;
}

/// How far outside a convex shape a point is, or less than 0 inside [m].
double outside(const std::vector<Point2>& corners, const Point2& p) {
  double most = -1e9;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    most = std::max(most, ((b.y - a.y) * (p.x - a.x) - (b.x - a.x) * (p.y - a.y)) / length);
  }
  return most;
}

RC_GTEST_PROP(Outlines, HoldEveryKnownCellAndTouchTheirCorners, ()) {
  const OccupancyGrid map = any_map();
  const std::vector<Point2> outline = known_outline(map);
  RC_ASSERT(outline.size() >= 4u);
  RC_ASSERT(twice_area(outline) > 0.0);
  std::vector<Point2> corners;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.cells[static_cast<std::size_t>(row * map.width + column)] == Cell::unknown) continue;
      for (const double dx : {0.0, 1.0}) {
        for (const double dy : {0.0, 1.0})
          corners.push_back(map.origin * Point2{(column + dx) * map.resolution, (row + dy) * map.resolution});
      }
    }
  }
  for (const Point2& corner : corners) RC_ASSERT(outside(outline, corner) < 1e-9);
  for (const Point2& point : outline) {
    RC_ASSERT(std::any_of(corners.begin(), corners.end(), [&](const Point2& corner) {
      return std::hypot(corner.x - point.x, corner.y - point.y) < 1e-9;
    }));
  }
}

RC_GTEST_PROP(Outlines, AreThoseOfEveryTriple, ()) {
  // A point is a corner if it lies in no triangle of others: brute force.
  std::vector<Point2> points(*rc::gen::inRange<std::size_t>(3, 9));
  for (Point2& point : points) point = {real_between(-5, 5), real_between(-5, 5)};
  const std::vector<Point2> hull = convex_hull(points);
  RC_PRE(hull.size() >= 3u);
  for (const Point2& point : points) {
    bool is_inside = false;
    for (const Point2& a : points)
      for (const Point2& b : points)
        for (const Point2& c : points) {
          if (a == point || b == point || c == point || twice_area({a, b, c}) <= 0.0) continue;
          is_inside = is_inside || outside({a, b, c}, point) < 0.0;
        }
    const bool is_corner = std::find(hull.begin(), hull.end(), point) != hull.end();
    RC_ASSERT(!(is_inside && is_corner));
    RC_ASSERT(outside(hull, point) < 1e-12);
  }
}

TEST(GeoJson, OutlinesEachMapAndEachMergedMap) {
  const Fleet fleet(12);
  const Json json = Json::parse(export_text(ExportFormat::geojson, fleet.named()));
  EXPECT_EQ(json["type"], "FeatureCollection");
  EXPECT_EQ(json["coordinate_frame"]["unit"], "metre");
  EXPECT_EQ(json["coordinate_frame"]["frames"]["merged.yaml"], "that of the map site/robot_1.yaml");
  const std::vector<Member>& members = fleet.result.components[0].members;
  ASSERT_EQ(json["features"].size(), members.size() + 1);
  const auto ring_of = [](const Json& feature) {
    EXPECT_EQ(feature["type"], "Feature");
    EXPECT_EQ(feature["geometry"]["type"], "Polygon");
    EXPECT_EQ(feature["geometry"]["coordinates"].size(), 1u);
    std::vector<Point2> ring;
    for (const Json& position : feature["geometry"]["coordinates"][0])
      ring.push_back({position[0], position[1]});
    EXPECT_EQ(ring.front(), ring.back());
    ring.pop_back();
    EXPECT_GT(twice_area(ring), 0.0) << "counter-clockwise";
    return ring;
  };
  const std::vector<Point2> all = ring_of(json["features"][0]);
  EXPECT_EQ(json["features"][0]["properties"]["maps"], members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Json& feature = json["features"][i + 1];
    EXPECT_EQ(feature["properties"]["source"], fleet.names[members[i].map]);
    EXPECT_EQ(feature["properties"]["transform"]["x"], members[i].T_component_map.x);
    const std::vector<Point2> ring = ring_of(feature);
    for (const Point2& corner : ring) EXPECT_LT(outside(all, corner), 1e-5);
    const OccupancyGrid& map = fleet.maps[members[i].map];
    const SE2 T = members[i].T_component_map * map.origin;
    for (const double x : {0.0, map.width * map.resolution})
      for (const double y : {0.0, map.height * map.resolution})
        EXPECT_LT(outside(ring, T * Point2{x, y}), 1e-5);
  }
}

TEST(Exports, AreFoundByTheirNames) {
  for (const ExportFormat format : export_formats()) EXPECT_EQ(export_format(name_of(format)), format);
  EXPECT_FALSE(export_format("kml"));
  EXPECT_FALSE(export_format(""));
}

TEST(Exports, OfNothingOrToNowhereAreErrors) {
  const test::TemporaryDirectory directory;
  const Fleet fleet(6);
  const MergeResult nothing;
  for (const ExportFormat format : export_formats()) {
    EXPECT_THROW(export_text(format, {fleet.names, fleet.maps, nothing}), std::invalid_argument);
    const std::string error = message_of<FileError>([&] {
      write_export(format, directory.file("x"), {}, {fleet.names, fleet.maps, nothing});
    });
    EXPECT_TRUE(contains(error, "x: is not written: no two maps were joined")) << error;
    EXPECT_THROW(write_export(format, directory.file("no/such/folder"), {}, fleet.named()), FileError);
    const std::vector<std::string> few{"a"};
    EXPECT_THROW(export_text(format, {few, fleet.maps, fleet.result}), std::out_of_range);
  }
  const std::string input = directory.write("in.yaml", "");
  EXPECT_TRUE(
      contains(message_of<FileError>([&] { write_export(ExportFormat::g2o, input, {input}, fleet.named()); }),
               "is an input"));
}

}  // namespace
}  // namespace gridmerge
