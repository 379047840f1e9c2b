// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_mean.hpp"

#include <algorithm>
#include <cmath>

#include "grid/longer_side.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"
#include "match/prepared_map.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kSpacingsAlong = 16.0;  // the longest map
constexpr double kLeastSpacing = 1.0;    // [m]
constexpr std::size_t kSamples = 2000;   // of a map's known cells

/// Sums over pairs of points, straight and bent.
struct Moments {
  double count = 0.0;
  Point2 straight, bent;                              // sums
  double xx = 0.0, xy = 0.0, yy = 0.0;                // of products of the straight one's coordinates
  double bxx = 0.0, bxy = 0.0, byx = 0.0, byy = 0.0;  // of bent by straight

  void add(const Point2& s, const Point2& b) {
    count += 1.0;
    straight = {straight.x + s.x, straight.y + s.y};
    bent = {bent.x + b.x, bent.y + b.y};
    xx += s.x * s.x;
    xy += s.x * s.y;
    yy += s.y * s.y;
    bxx += b.x * s.x;
    bxy += b.x * s.y;
    byx += b.y * s.x;
    byy += b.y * s.y;
  }
  Moments centred() const {
    Moments m = *this;
    const Point2 s{straight.x / count, straight.y / count}, b{bent.x / count, bent.y / count};
    m.xx -= count * s.x * s.x;
    m.xy -= count * s.x * s.y;
    m.yy -= count * s.y * s.y;
    m.bxx -= count * b.x * s.x;
    m.bxy -= count * b.x * s.y;
    m.byx -= count * b.y * s.x;
    m.byy -= count * b.y * s.y;
    return m;
  }
};

/// Straight and bent, both about `origin` in the group's frame as far as they are in it.
Moments moments_of(const ElasticSheet& sheet, const std::vector<Point2>& known, const SE2& T_group_map,
                   const Point2& origin) {
  Moments moments;
  for (const Point2& p : known) {
    const Point2 s = T_group_map * p, b = sheet.to_group(p);
    moments.add({s.x - origin.x, s.y - origin.y}, {b.x - origin.x, b.y - origin.y});
  }
  return moments;
}

}  // namespace

std::vector<Point2> sample_known(const OccupancyGrid& map) {
  std::vector<Point2> known;
  std::size_t count = count_cells(map).known(), number = 0;
  const std::size_t step = std::max<std::size_t>(1, count / kSamples);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) == Cell::unknown) continue;
      if (number++ % step == step / 2) known.push_back(map.cell_centre(column, row));
    }
  }
  return known;
}

SE2 rigid_part(const ElasticSheet& sheet, const std::vector<Point2>& known) {
  const SE2& T = sheet.T_group_map();
  const Point2 origin = T * known.front();
  const Moments all = moments_of(sheet, known, T, origin), m = all.centred();
  const double theta = std::atan2(m.byx - m.bxy, m.bxx + m.byy);
  const Point2 s{all.straight.x / all.count, all.straight.y / all.count};
  const Point2 b{all.bent.x / all.count, all.bent.y / all.count};
  const SE2 about{origin.x + b.x, origin.y + b.y, theta};
  return about * SE2{-origin.x - s.x, -origin.y - s.y, 0.0} * T;
}

Affine without_mean_strain(const std::vector<ElasticMember>& members,
                           const std::vector<std::vector<Point2>>& known,
                           const std::vector<SE2>& T_group_map) {
  // Of each map the linear function that is nearest to it, as strongly as it has cells.
  double weight = 0.0, xx = 0.0, shear = 0.0, yy = 0.0;
  Point2 middle;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (known[i].empty()) continue;
    const Point2 origin = T_group_map[i] * known[i].front();
    const Moments all = moments_of(members[i].sheet, known[i], T_group_map[i], origin), m = all.centred();
    const double determinant = m.xx * m.yy - m.xy * m.xy;
    if (!(determinant > 1e-9 * (m.xx + m.yy) * (m.xx + m.yy))) continue;
    weight += all.count;
    xx += all.count * (m.bxx * m.yy - m.bxy * m.xy) / determinant;
    shear += all.count * 0.5 * ((m.bxy * m.xx - m.bxx * m.xy) + (m.byx * m.yy - m.byy * m.xy)) / determinant;
    yy += all.count * (m.byy * m.xx - m.byx * m.xy) / determinant;
    middle.x += all.count * origin.x + all.bent.x;
    middle.y += all.count * origin.y + all.bent.y;
  }
  if (weight == 0.0) return {};
  xx /= weight;
  shear /= weight;
  yy /= weight;
  middle = {middle.x / weight, middle.y / weight};
  const double determinant = xx * yy - shear * shear;
  Affine change{yy / determinant, -shear / determinant, -shear / determinant, xx / determinant, {}};
  const Point2 moved = change * middle;
  change.shift = {middle.x - moved.x, middle.y - moved.y};
  return change;
}

double common_cell(const std::vector<RigidMember>& maps) {
  double cell = 0.0;
  for (const RigidMember& one : maps) cell = std::max(cell, working_cell(*one.map, *one.map));
  return cell;
}

double choose_spacing(const std::vector<RigidMember>& maps) {
  double longest = 0.0;
  for (const RigidMember& one : maps) longest = std::max(longest, longer_side(one.map->known()));
  return std::max(kLeastSpacing, longest / kSpacingsAlong);
}

}  // namespace gridmerge::internal
