// SPDX-License-Identifier: Apache-2.0
#include "report/deformation_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gridmerge::internal {

namespace {

constexpr double kSame = 1e-6;  // [1] and [m]

/// Row by row, the shift last.
std::array<double, 6> entries_of(const Affine& affine) {
  return {affine.xx, affine.xy, affine.shift.x, affine.yx, affine.yy, affine.shift.y};
}

Deformation read_lattice(const JsonReader& json, double farthest) {
  const auto points = [&](const char* key) {
    const std::int64_t count = json.at(key).count();
    if (count < 4 || count > Deformation::kMostPoints) json.at(key).fail("is no number from 4 to 4096");
    return static_cast<int>(count);
  };
  const int columns = points("columns"), rows = points("rows");
  const JsonReader numbers = json.at("shifts");
  if (numbers.size() != 2 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    numbers.fail("does not hold two numbers for each of columns x rows points");
  std::vector<Point2> shifts;
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    shifts.push_back(
        {numbers.at(i).number_in(-farthest, farthest), numbers.at(i + 1).number_in(-farthest, farthest)});
  const SE2 frame = json.at("frame").transform(farthest);
  const double spacing = json.at("spacing").number_in(0.0, farthest);
  try {
    return {frame, spacing, columns, rows, std::move(shifts)};
  } catch (const std::invalid_argument& error) {
    json.fail(std::string("is none: ") + error.what());
  }
}

}  // namespace

Json shape_json(const Deformation& deformation) {
  Json json{{"kind", name_of(deformation.kind())}};
  if (const std::optional<Affine> affine = deformation.affine()) json["scale"] = number_json(affine->scale());
  return json;
}

Json deformation_json(const Deformation& deformation) {
  Json json = shape_json(deformation);
  if (const std::optional<Affine> affine = deformation.affine()) {
    Json rows = Json::array({Json::array(), Json::array()});
    const std::array<double, 6> entries = entries_of(*affine);
    for (std::size_t i = 0; i < entries.size(); ++i) rows[i / 3].push_back(number_json(entries[i]));
    json["matrix"] = std::move(rows);
  }
  Json shifts = Json::array();
  for (const Point2& shift : deformation.shifts()) {
    shifts.push_back(number_json(shift.x));
    shifts.push_back(number_json(shift.y));
  }
  json["frame"] = transform_json(deformation.T_map_lattice());
  json["spacing"] = number_json(deformation.spacing());
  json["columns"] = deformation.columns();
  json["rows"] = deformation.rows();
  json["shifts"] = std::move(shifts);
  return json;
}

Deformation read_deformation(const JsonReader& json, double farthest) {
  Deformation deformation = read_lattice(json, farthest);
  if (!json.has("kind")) return deformation;
  const std::optional<MapTransform> kind = map_transform(json.at("kind").text());
  if (!kind || *kind == MapTransform::rigid)
    json.at("kind").fail("is none of similarity, affine and elastic");
  // Rounding may make a function that is nearly a similarity an affine one.
  const std::optional<Affine> affine = deformation.affine();
  if ((*kind == MapTransform::elastic) == affine.has_value())
    json.at("kind").fail("is not that of its lattice");
  if (!affine) return deformation;
  if (*kind != MapTransform::affine && !affine->is_similarity(kSame))
    json.at("kind").fail("is not that of its lattice");
  const JsonReader scale = json.at("scale"), matrix = json.at("matrix");
  if (std::abs(scale.number_in(0.0, farthest) - affine->scale()) > kSame)
    scale.fail("is not that of its lattice");
  const std::array<double, 6> entries = entries_of(*affine);
  for (std::size_t row = 0; row < 2; ++row) {
    if (matrix.size() != 2 || matrix.at(row).size() != 3)
      matrix.fail("does not have two rows of three numbers");
    for (std::size_t column = 0; column < 3; ++column) {
      const double entry = entries[3 * row + column];
      if (std::abs(matrix.at(row).at(column).number_in(-farthest, farthest) - entry) >
          kSame * std::max(1.0, std::abs(entry)))
        matrix.fail("is not that of its lattice");
    }
  }
  return deformation;
}

}  // namespace gridmerge::internal
