// SPDX-License-Identifier: Apache-2.0
#include "report/interchange.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Dense>
#include <complex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/report/merge_output.hpp"
#include "report/interchange_support.hpp"
#include "report/results.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

using Json = nlohmann::json;

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
      return one["cartesian_meters"]["reference_coordinates"]["merged"][key]
          .as<std::vector<std::vector<double>>>();
    };
    const auto rmf = points("rmf"), robot = points("robot");
    ASSERT_EQ(rmf.size(), 4u);
    ASSERT_EQ(robot.size(), 4u);
    const SE2 found = similarity(rmf, robot);
    const SE2 expected = inverse(members[i].T_component_map);
    EXPECT_LT((matrix_of(found) - matrix_of(expected)).norm(), 1e-4);
    EXPECT_NEAR(one["scale"].as<double>(), 1.0, 1e-6);
    EXPECT_NEAR(one["residual"].as<double>(), 0.0, 1e-6);
  }
}

TEST(OpenRmf, PointsOfABuildingOnThePictureAreMeasuredFromItsUpperLeftCorner) {
  const std::vector<OccupancyGrid> maps(2, map_from({"#..#", ".##.", "...."}, 0.5));
  MergeResult result = test::merged(maps, {{{0, {}}, {1, {1.25, -3.0, 0.0}}}});
  const std::vector<std::string> names = test::fleet_names(2);
  const std::string text = export_text(ExportFormat::open_rmf, {names, maps, result});
  const YAML::Node yaml = YAML::Load(text);
  const OccupancyGrid& picture = result.components[0].fused.grid;
  // The first map's upper left corner is at (0, 1.5), and the second one reaches down to -3 and right
  // to 3.25.
  EXPECT_EQ(picture.height, 9);
  const auto upper_left = yaml["merged_maps"]["merged.yaml"]["upper_left"].as<std::vector<double>>();
  EXPECT_NEAR(upper_left.at(0), picture.origin.x, 1e-6);
  EXPECT_NEAR(upper_left.at(1), picture.origin.y + picture.height * picture.resolution, 1e-6);
  const auto points = [&](std::size_t map, const char* system) {
    return yaml["maps"][map][system]["reference_coordinates"]["merged"]["rmf"]
        .as<std::vector<std::vector<double>>>();
  };
  for (std::size_t map = 0; map < 2; ++map) {
    const auto from_corner = points(map, "reference_image"), in_frame = points(map, "cartesian_meters");
    ASSERT_EQ(from_corner.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(from_corner[i].at(0), in_frame.at(i).at(0) - upper_left[0], 2e-6);
      EXPECT_NEAR(from_corner[i].at(1), in_frame.at(i).at(1) - upper_left[1], 2e-6);
    }
  }
  // The first map's upper right corner is four columns to the right of the picture's, at its upper edge.
  EXPECT_NEAR(points(0, "reference_image")[2].at(0), 4 * 0.5, 1e-6);
  EXPECT_NEAR(points(0, "reference_image")[2].at(1), 0.0, 1e-6);
  EXPECT_NEAR(points(1, "reference_image")[0].at(1), -9 * 0.5, 1e-6);

  result.components[0].fused = {};  // where merge() would draw it
  EXPECT_EQ(export_text(ExportFormat::open_rmf, {names, maps, result}), text);
}

TEST(OpenRmf, HasALevelForEachMergedMap) {
  const std::vector<OccupancyGrid> maps(4, map_from({"#.", ".#"}, 1e-3));
  const MergeResult result =
      test::merged(maps, {{{0, {}}, {1, {1e-5, 0.0, 0.0}}}, {{2, {}}, {3, {0.0, -1e-7, 0.5}}}});
  const std::string text = export_text(ExportFormat::open_rmf, {test::fleet_names(4), maps, result});
  EXPECT_FALSE(contains(text, "e-0")) << "YAML 1.1 takes it for a text";
  const YAML::Node yaml = YAML::Load(text);
  EXPECT_EQ(yaml["maps"][2]["merged_map"].as<std::string>(), "merged_2.yaml");
  EXPECT_TRUE(yaml["maps"][2]["reference_image"]["reference_coordinates"]["merged_2"].IsMap());
  EXPECT_TRUE(yaml["maps"][2]["cartesian_meters"]["reference_coordinates"]["merged_2"].IsMap());
  EXPECT_EQ(yaml["merged_maps"]["merged_2.yaml"]["upper_left"].size(), 2u);
}

TEST(Exports, RefuseAComponentWithoutMembers) {
  const std::vector<OccupancyGrid> maps(2, map_from({"#.", ".#"}, 0.1));
  const std::vector<std::string> names = test::fleet_names(2);
  MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  result.components.emplace_back();
  for (const ExportFormat format : {ExportFormat::g2o, ExportFormat::open_rmf, ExportFormat::geojson})
    EXPECT_THROW(export_text(format, {names, maps, result}), std::invalid_argument) << name_of(format);
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

TEST(Exports, QuoteWhatNoReaderPrints) {
  EXPECT_EQ(quoted("a \"b\" ~"), "\"a \\\"b\\\" ~\"");
  EXPECT_EQ(quoted("\x7f"), "\"\\u007f\"");
  EXPECT_EQ(quoted("\xc2\x80\xc2\x9f\xc2\xa0"), "\"\\u0080\\u009f\xc2\xa0\"");
  EXPECT_EQ(quoted("\xe2\x80\xa7\xe2\x80\xa8\xe2\x80\xa9\xe2\x80\xaa"),
            "\"\xe2\x80\xa7\\u2028\\u2029\xe2\x80\xaa\"");
  EXPECT_EQ(quoted("\xef\xbb\xbe\xef\xbb\xbf\xef\xbf\xbd\xef\xbf\xbe\xef\xbf\xbf"),
            "\"\xef\xbb\xbe\\ufeff\xef\xbf\xbd\\ufffe\\uffff\"");
  EXPECT_EQ(quoted("\xdf\xbf\xe0\xa0\x80\xf0\x9f\x98\x80"), "\"\xdf\xbf\xe0\xa0\x80\xf0\x9f\x98\x80\"");
}

TEST(GeoJson, PositionsAreToldToAMicrometre) {
  const std::vector<OccupancyGrid> maps{map_from({"#"}, 1.0), map_from({"#"}, 1.0)};
  const MergeResult result = test::merged(maps, {{{0, {}}, {1, {1.0 / 3.0, 0.0000004, 0.0}}}});
  const std::string text = export_text(ExportFormat::geojson, {test::fleet_names(2), maps, result});
  EXPECT_TRUE(contains(text, "[0.333333,0.0]")) << text;
  EXPECT_TRUE(contains(text, "[1.333333,1.0]")) << text;
}

TEST(GeoJson, OfAMapOfNothingThereIsNoPolygon) {
  const std::vector<OccupancyGrid> maps{map_from({"#"}, 1.0), map_from({" "}, 1.0)};
  const MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  const Json json = Json::parse(export_text(ExportFormat::geojson, {test::fleet_names(2), maps, result}));
  EXPECT_TRUE(json["features"][1]["geometry"].is_object());
  EXPECT_TRUE(json["features"][2]["geometry"].is_null());
}

// A reader may take it for a direction.
TEST(Exports, HaveNoNegativeZero) {
  const std::vector<OccupancyGrid> maps(2, map_from({"#.", ".#"}, 0.5, {-1e-9, -0.0, -0.0}));
  MergeResult result = test::merged(maps, {{{0, {-0.0, -0.0, -0.0}}, {1, {-1e-8, -0.0, -0.0}}}});
  result.joins[0].T_fixed_moving = {-0.0, -0.0, -0.0};
  for (const ExportFormat format : {ExportFormat::g2o, ExportFormat::open_rmf, ExportFormat::geojson}) {
    const std::string text = export_text(format, {test::fleet_names(2), maps, result});
    for (const char* zero : {"-0 ", "-0\n", "-0.0,", "-0.0]", "-0.000000"})
      EXPECT_FALSE(contains(text, zero)) << zero << " in " << text;
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
  EXPECT_THROW(export_text(ExportFormat::geotiff, fleet.named()), std::invalid_argument);  // is no text
  for (const ExportFormat format : export_formats()) {
    EXPECT_THROW(export_text(format, {fleet.names, fleet.maps, nothing}), std::invalid_argument);
    const std::string error = message_of<FileError>([&] {
      write_export(format, directory.file("x"), {}, {fleet.names, fleet.maps, nothing});
    });
    EXPECT_TRUE(contains(error, "x: is not written: no two maps were joined")) << error;
    EXPECT_THROW(write_export(format, directory.file("no/such/folder"), {}, fleet.named()), FileError);
    const std::vector<std::string> few{"a"};
    EXPECT_THROW(write_export(format, directory.file("x"), {}, {few, fleet.maps, fleet.result}),
                 std::out_of_range);
    EXPECT_EQ(directory.names(), std::vector<std::string>{});
  }
  const std::string input = directory.write("in.yaml", "");
  EXPECT_TRUE(
      contains(message_of<FileError>([&] { write_export(ExportFormat::g2o, input, {input}, fleet.named()); }),
               "is an input"));
}

}  // namespace
}  // namespace gridmerge
