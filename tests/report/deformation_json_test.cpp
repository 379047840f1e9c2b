// SPDX-License-Identifier: Apache-2.0
// Maps that are bent or stretched in the record of a merge.
#include "report/deformation_json.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/io/file_error.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "io/support.hpp"
#include "merge/drawing.hpp"
#include "report/results.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using Json = nlohmann::json;
using test::contains;
using test::map_from;
using test::message_of;

const std::vector<OccupancyGrid> kMaps{map_from({"#..", ".##"}, 0.05), map_from({"#", "."}, 0.1),
                                       map_from({".#.", "...", " .#"}, 0.05)};
const std::vector<std::string> kNames{"a.yaml", "b.yaml", "c.yaml"};

/// Two maps, the second of which is bent.
MergeResult bent_result() {
  std::vector<Point2> shifts(20);
  shifts[7] = {0.0625, -1.0 / 3.0};
  const Deformation deformation({-0.5, 0.1, 0.3}, 1.5, 5, 4, shifts);
  return test::merged(kMaps, {{{0, {}, 0.9}, {2, {1.25, -3.0, 0.5}, 0.875, {}, deformation}}});
}

TEST(MergeRecord, KeepsDeformations) {
  const MergeResult result = bent_result();
  const MergeRecord record = parse_transforms("t.json", transforms_json(kNames, result));
  const std::vector<Member>& members = record.result.components.at(0).members;
  EXPECT_TRUE(members[0].deformation.is_identity());
  EXPECT_EQ(members[1].deformation, result.components[0].members[1].deformation);
  EXPECT_EQ(transforms_json(kNames, record.result), transforms_json(kNames, result));
}

TEST(MergeRecord, RefusesDamagedDeformations) {
  const Json sound = Json::parse(transforms_json(kNames, bent_result()));
  const auto message = [&](const std::string& key, const Json& value) {
    Json damaged = sound;
    Json& deformation = damaged["components"][0]["members"][1]["deformation"];
    if (value.is_null()) {
      deformation.erase(key);
    } else {
      deformation[key] = value;
    }
    return message_of<FileError>([&] { parse_transforms("t.json", damaged.dump()); });
  };
  const std::string place = "t.json: components[0].members[1].deformation";
  for (const char* key : {"frame", "spacing", "columns", "rows", "shifts"})
    EXPECT_EQ(message(key, {}), place + "." + key + " is missing");
  EXPECT_EQ(message("columns", 3), place + ".columns is no number from 4 to 4096");
  EXPECT_EQ(message("rows", 1e9), place + ".rows is no whole number from 0 to 2^53");
  EXPECT_EQ(message("rows", 5),
            place + ".shifts does not hold two numbers for each of columns x rows points");
  EXPECT_EQ(message("shifts", "none"), place + ".shifts is no list");
  EXPECT_TRUE(contains(message("spacing", -1.0), place + ".spacing lies outside"));
  EXPECT_TRUE(contains(message("spacing", 0.0), place + " is none: a lattice's spacing must be"));
  Json shifts = sound["components"][0]["members"][1]["deformation"]["shifts"];
  shifts[3] = 1e300;
  EXPECT_TRUE(contains(message("shifts", shifts), place + ".shifts[3] lies outside"));
  shifts[3] = "x";
  EXPECT_EQ(message("shifts", shifts), place + ".shifts[3] is no number");
  shifts[3] = 5.0;
  EXPECT_TRUE(contains(message("shifts", shifts), place + " is none: neighbouring shifts"));
}

/// Two maps, the second of which has scales along two axes, and shear; or one scale alone.
MergeResult stretched_result(bool is_similar) {
  constexpr double kSpacing = 12.0;
  std::vector<Point2> shifts;
  for (int i = 0; i < 16; ++i) {
    const Point2 at{(i % 4 - 1) * kSpacing, (i / 4 - 1) * kSpacing};
    shifts.push_back(is_similar ? Point2{0.02 * at.x + 0.1, 0.02 * at.y}
                                : Point2{0.02 * at.x + 0.01 * at.y, -0.03 * at.y - 0.2});
  }
  const Deformation deformation({-3.0, 1.0, 0.3}, kSpacing, 4, 4, shifts);
  return test::merged(kMaps, {{{0, {}, 0.9}, {2, {1.25, -3.0, 0.5}, 0.875, {}, deformation}}});
}

TEST(MergeRecord, KeepsScales) {
  for (const bool is_similar : {true, false}) {
    const MergeResult result = stretched_result(is_similar);
    const std::string text = transforms_json(kNames, result);
    const MergeRecord record = parse_transforms("t.json", text);
    EXPECT_EQ(record.result.components.at(0).members[1].deformation,
              result.components[0].members[1].deformation);
    EXPECT_EQ(transforms_json(kNames, record.result), text);
    const Json json = Json::parse(text)["components"][0]["members"][1]["deformation"];
    EXPECT_EQ(json["kind"], is_similar ? "similarity" : "affine");
    EXPECT_NEAR(json["scale"], is_similar ? 1.02 : std::sqrt(1.02 * 0.97), 1e-12);
  }
}

TEST(MergeRecord, RefusesScalesThatAreNotThoseOfTheirLattices) {
  const std::string place = "t.json: components[0].members[1].deformation";
  const auto message = [&](bool is_similar, const std::string& key, const Json& value) {
    Json damaged = Json::parse(transforms_json(kNames, stretched_result(is_similar)));
    damaged["components"][0]["members"][1]["deformation"][key] = value;
    return message_of<FileError>([&] { parse_transforms("t.json", damaged.dump()); });
  };
  const std::string is_none = place + ".kind is none of similarity, affine and elastic";
  const std::string is_another = place + ".kind is not that of its lattice";
  EXPECT_EQ(message(true, "kind", "projective"), is_none);
  EXPECT_EQ(message(true, "kind", "rigid"), is_none);
  EXPECT_EQ(message(true, "kind", 3), place + ".kind is no text");
  EXPECT_EQ(message(true, "kind", "elastic"), is_another);
  EXPECT_EQ(message(false, "kind", "similarity"), is_another);
  EXPECT_EQ(message(true, "scale", 1.03), place + ".scale is not that of its lattice");
  EXPECT_EQ(message(true, "scale", "1.02"), place + ".scale is no number");
  EXPECT_EQ(message(true, "matrix", Json::array({1.0})),
            place + ".matrix does not have two rows of three numbers");
  EXPECT_EQ(message(true, "matrix", Json::parse("[[1.02, 0, 0], [0, 1.02, 0]]")),
            place + ".matrix is not that of its lattice");
  const Json matrix = Json::parse(transforms_json(
      kNames, stretched_result(false)))["components"][0]["members"][1]["deformation"]["matrix"];
  for (std::size_t row = 0; row < 2; ++row) {
    Json shorter = matrix;
    shorter[row].erase(0);
    EXPECT_EQ(message(false, "matrix", shorter), place + ".matrix does not have two rows of three numbers");
    for (std::size_t column = 0; column < 3; ++column) {
      Json other = matrix;
      other[row][column] = other[row][column].get<double>() + 0.001;
      EXPECT_EQ(message(false, "matrix", other), place + ".matrix is not that of its lattice")
          << row << column;
    }
  }
  // Of a lattice that bends, and of one that earlier versions wrote.
  Json bent = Json::parse(transforms_json(kNames, bent_result()));
  Json& deformation = bent["components"][0]["members"][1]["deformation"];
  EXPECT_EQ(deformation["kind"], "elastic");
  deformation["kind"] = "affine";
  EXPECT_EQ(message_of<FileError>([&] { parse_transforms("t.json", bent.dump()); }), is_another);
  deformation.erase("kind");
  EXPECT_NO_THROW(parse_transforms("t.json", bent.dump()));
}

/// Shifts that put the point (0, 0) at `origin`, and stretch by `along_x` and `along_y`.
Deformation stretched(double along_x, double along_y, const Point2& origin) {
  constexpr double kSpacing = 16.0;
  std::vector<Point2> shifts;
  for (int i = 0; i < 16; ++i) {
    const Point2 at{(i % 4 - 1) * kSpacing, (i / 4 - 1) * kSpacing};
    shifts.push_back({(along_x - 1.0) * at.x + origin.x, (along_y - 1.0) * at.y + origin.y});
  }
  return {{}, kSpacing, 4, 4, shifts};
}

constexpr double kFar = 1e6;

/// What is said of it when a number of the record is changed; "" if nothing.
std::string said_of(const Deformation& deformation, const std::string& pointer, double more) {
  Json json = Json::parse(deformation_json(deformation).dump());
  Json& number = json.at(Json::json_pointer(pointer));
  number = number.get<double>() + more;
  try {
    read_deformation(JsonReader(json), kFar);
    return "";
  } catch (const JsonError& error) {
    return error.what();
  }
}

TEST(DeformationJson, EntriesMayBeOffByAMillionth) {
  const Deformation deformation = stretched(1.25, 0.75, {1000.0, -0.5});
  const std::vector<std::pair<std::string, double>> entries{{"/matrix/0/0", 1.25},   {"/matrix/0/1", 0.0},
                                                            {"/matrix/0/2", 1000.0}, {"/matrix/1/0", 0.0},
                                                            {"/matrix/1/1", 0.75},   {"/matrix/1/2", -0.5}};
  for (const auto& [pointer, entry] : entries) {
    // Of entries beyond 1 a millionth part of themselves.
    const double allowed = 1e-6 * std::max(1.0, std::abs(entry));
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_EQ(said_of(deformation, pointer, 0.99 * sign * allowed), "") << pointer;
      EXPECT_EQ(said_of(deformation, pointer, 1.01 * sign * allowed), "matrix is not that of its lattice")
          << pointer;
    }
  }
}

TEST(DeformationJson, TheScaleMayBeOffByAMillionth) {
  const Deformation deformation = stretched(1.25, 1.25, {});
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(said_of(deformation, "/scale", 0.99e-6 * sign), "");
    EXPECT_EQ(said_of(deformation, "/scale", 1.01e-6 * sign), "scale is not that of its lattice");
  }
}

TEST(DeformationJson, MayBeCalledASimilarityIfItNearlyIsOne) {
  // Its two scales differ by twice as much as an entry may be off.
  const auto said = [](double along_y) {
    Json json = Json::parse(deformation_json(stretched(1.25, along_y, {})).dump());
    EXPECT_EQ(json["kind"], along_y == 1.25 ? "similarity" : "affine");
    json["kind"] = "similarity";
    try {
      read_deformation(JsonReader(json), kFar);
      return std::string();
    } catch (const JsonError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(said(1.25), "");
  EXPECT_EQ(said(1.25 + 1.9e-6), "");
  EXPECT_EQ(said(1.25 + 2.1e-6), "kind is not that of its lattice");
  EXPECT_EQ(said(1.25 - 2.1e-6), "kind is not that of its lattice");
  // What is a similarity is an affine function, too.
  Json json = Json::parse(deformation_json(stretched(1.25, 1.25, {})).dump());
  json["kind"] = "affine";
  EXPECT_EQ(read_deformation(JsonReader(json), kFar), stretched(1.25, 1.25, {}));
}

TEST(DeformationJson, HoldsRowsOfTheMatrixAndShiftsPointByPoint) {
  const Deformation deformation = stretched(1.25, 0.75, {8.0, -0.5});
  const Json json = Json::parse(deformation_json(deformation).dump());
  EXPECT_EQ(json["kind"], "affine");
  EXPECT_EQ(json["scale"], std::sqrt(1.25 * 0.75));
  ASSERT_EQ(json["matrix"].size(), 2u);
  const double expected[2][3] = {{1.25, 0.0, 8.0}, {0.0, 0.75, -0.5}};
  for (std::size_t row = 0; row < 2; ++row) {
    ASSERT_EQ(json["matrix"][row].size(), 3u);
    for (std::size_t column = 0; column < 3; ++column)
      EXPECT_NEAR(json["matrix"][row][column], expected[row][column], 1e-12);
  }
  EXPECT_EQ(json["columns"], 4);
  EXPECT_EQ(json["rows"], 4);
  EXPECT_EQ(json["spacing"], 16.0);
  ASSERT_EQ(json["shifts"].size(), 32u);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(json["shifts"][2 * i], deformation.shifts()[i].x);
    EXPECT_EQ(json["shifts"][2 * i + 1], deformation.shifts()[i].y);
  }
}

TEST(DeformationJson, KeepsLatticesOfFewAndOfManyPoints) {
  // All between 4 and 4096 points, and no number of them beyond.
  for (const auto& [columns, rows] : {std::pair(4, 4), {4096, 4}, {4, 4096}, {5, 7}}) {
    const std::vector<Point2> shifts(static_cast<std::size_t>(columns * rows), Point2{0.25, 0.5});
    const Deformation deformation({1.0, 2.0, 0.5}, 2.0, columns, rows, shifts);
    const Json json = Json::parse(deformation_json(deformation).dump());
    EXPECT_EQ(read_deformation(JsonReader(json), kFar), deformation);
  }
  const Json sound = Json::parse(deformation_json(stretched(1.25, 1.25, {})).dump());
  for (const char* key : {"columns", "rows"}) {
    for (const unsigned count : {0u, 3u, 4097u}) {
      Json json = sound;
      json[key] = count;
      EXPECT_EQ(message_of<JsonError>([&] { read_deformation(JsonReader(json), kFar); }),
                std::string(key) + " is no number from 4 to 4096");
    }
  }
}

TEST(DeformationJson, NothingLiesFartherThanItMay) {
  const Deformation deformation = stretched(1.25, 1.25, {100.0, -100.0});
  const Json json = Json::parse(deformation_json(deformation).dump());
  // The farthest shift, at a corner of the lattice, is 100 + 0.25 * 32.
  EXPECT_EQ(read_deformation(JsonReader(json), 108.0), deformation);
  EXPECT_TRUE(contains(message_of<JsonError>([&] { read_deformation(JsonReader(json), 107.9); }),
                       "lies outside [-107.9, 107.9]"));
}

}  // namespace
}  // namespace gridmerge
