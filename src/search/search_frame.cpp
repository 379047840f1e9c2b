// SPDX-License-Identifier: Apache-2.0
#include "search/search_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "search/local_maxima.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kPeaksPerRotation = 96;
constexpr int kPeakFloor = 4;  // peaks below the best of their rotation by this factor are dropped
constexpr int kApart = 2;      // candidates nearer than this in x, y and rotation are one

/// The shifts along one axis at which at least `least` of the points can lie in [0, length).
struct Shifts {
  int first;
  int count;
};
Shifts useful_shifts(std::vector<int>& points, std::size_t least, int box, int length) {
  const auto low = points.begin() + static_cast<std::ptrdiff_t>(least - 1);
  std::nth_element(points.begin(), low, points.end());
  const int lowest = *low;
  const auto high = points.end() - static_cast<std::ptrdiff_t>(least);
  std::nth_element(points.begin(), high, points.end());
  const int highest = *high;
  // The box begins `box` before the fixed map, and points are shifted by the result. One more on either side:
  // the rim. There is none where even `least` neighbours lie farther apart than that.
  return {box - highest - 1, std::max(0, length + highest - lowest + 2)};
}

}  // namespace

SE2 SearchFrame::pose(const Peak& peak) const {
  const SE2 rotate{0.0, 0.0, angle(peak.rotation)};
  const Point2 turned = rotate * centre;
  return {(peak.x - 0.5 * box) * factor - turned.x, (peak.y - 0.5 * box) * factor - turned.y, rotate.theta};
}

SearchFrame make_search_frame(const LikelihoodField& fixed, const LikelihoodField& moving, int coarse_factor,
                              int rotations) {
  const double factor = coarse_factor;
  const auto coarse = [&](double cells) { return static_cast<int>(std::ceil(cells / factor)); };
  SearchFrame frame{factor, rotations,           {0.5 * moving.width, 0.5 * moving.height},
                    0,      coarse(fixed.width), coarse(fixed.height)};
  frame.box = coarse(std::hypot(moving.width, moving.height)) + 2;
  return frame;
}

void check_search(const LikelihoodField& fixed, const LikelihoodField& moving,
                  const ExhaustiveSearchOptions& options, std::size_t most_samples) {
  if (fixed.cell != moving.cell)
    throw std::invalid_argument("both likelihood fields must have cells of one size");
  if (options.coarse_factor < 1) throw std::invalid_argument("coarse_factor must be at least 1");
  if (options.rotations < 1) throw std::invalid_argument("rotations must be at least 1");
  if (options.samples > most_samples)
    throw std::invalid_argument("samples must be at most " + std::to_string(most_samples));
  if (!(options.sigma > 0.0)) throw std::invalid_argument("sigma must be positive");
  if (!(options.outliers > 0.0 && options.outliers < 1.0))
    throw std::invalid_argument("outliers must lie in (0, 1)");
}

TurnedWalls turn_walls(const std::vector<WallPoint>& walls, const SearchFrame& frame, int rotation,
                       std::size_t least) {
  const double angle = frame.angle(rotation);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  TurnedWalls turned;
  turned.samples.reserve(walls.size());
  std::vector<int> columns;
  std::vector<int> rows;
  for (const WallPoint& wall : walls) {
    const double x = wall.position.x - frame.centre.x;
    const double y = wall.position.y - frame.centre.y;
    columns.push_back(static_cast<int>(std::floor((c * x - s * y) / frame.factor + 0.5 * frame.box)));
    rows.push_back(static_cast<int>(std::floor((s * x + c * y) / frame.factor + 0.5 * frame.box)));
    turned.samples.push_back({columns.back(), rows.back()});
  }
  const Shifts x = useful_shifts(columns, least, frame.box, frame.fixed_width);
  const Shifts y = useful_shifts(rows, least, frame.box, frame.fixed_height);
  turned.first_x = x.first;
  turned.shifts_x = x.count;
  turned.first_y = y.first;
  turned.shifts_y = y.count;
  for (Sample& sample : turned.samples) {
    sample.x += turned.first_x - frame.box;
    sample.y += turned.first_y - frame.box;
  }
  return turned;
}

namespace {

/// The best of a rotation's maxima.
std::vector<Peak> to_peaks(const std::vector<LocalMaximum>& maxima, const TurnedWalls& turned, int rotation) {
  std::vector<Peak> peaks;
  peaks.reserve(maxima.size());
  for (const LocalMaximum& maximum : maxima)
    peaks.push_back({rotation, turned.first_x + maximum.x, turned.first_y + maximum.y, maximum.score});
  if (peaks.size() > kPeaksPerRotation) {
    std::nth_element(peaks.begin(), peaks.begin() + kPeaksPerRotation, peaks.end());
    peaks.resize(kPeaksPerRotation);
  }
  return peaks;
}

}  // namespace

std::vector<Peak> best_peaks(const ScoreImage& scores, const TurnedWalls& turned, int rotation) {
  const int floor = find_maximum(scores, turned.shifts_x) / kPeakFloor;
  return to_peaks(find_local_maxima(scores, turned.shifts_x, floor), turned, rotation);
}

std::vector<Peak> best_peaks(const ScoreImage& scores, const std::vector<ScoreBlock>& looked_at,
                             const TurnedWalls& turned, int rotation, int floor) {
  floor = std::max(floor, find_maximum(scores, looked_at, turned.shifts_x) / kPeakFloor);
  return to_peaks(find_local_maxima(scores, looked_at, turned.shifts_x, floor), turned, rotation);
}

std::vector<Peak> keep_distinct(std::vector<Peak> peaks, int rotations, std::size_t max_count) {
  std::sort(peaks.begin(), peaks.end());
  const auto bucket = [](int x, int y) {
    return (static_cast<std::int64_t>(x) << 32) ^ static_cast<std::uint32_t>(y);
  };
  constexpr int kBucket = kApart + 1;
  std::unordered_map<std::int64_t, std::vector<Peak>> kept_near;
  std::vector<Peak> kept;
  for (const Peak& peak : peaks) {
    const int bx = peak.x / kBucket;
    const int by = peak.y / kBucket;
    const auto is_near = [&](const Peak& other) {
      const int turn = std::abs(other.rotation - peak.rotation);
      return std::min(turn, rotations - turn) <= kApart && std::abs(other.x - peak.x) <= kApart &&
             std::abs(other.y - peak.y) <= kApart;
    };
    bool distinct = true;
    for (int dx = -1; dx <= 1 && distinct; ++dx) {
      for (int dy = -1; dy <= 1 && distinct; ++dy) {
        const auto found = kept_near.find(bucket(bx + dx, by + dy));
        if (found != kept_near.end())
          distinct = std::none_of(found->second.begin(), found->second.end(), is_near);
      }
    }
    if (!distinct) continue;
    kept_near[bucket(bx, by)].push_back(peak);
    kept.push_back(peak);
    if (kept.size() == max_count) break;
  }
  return kept;
}

std::vector<Peak> together(const std::vector<std::vector<Peak>>& by_rotation) {
  std::vector<Peak> all;
  for (const std::vector<Peak>& some : by_rotation) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void resize(ScoreImage& scores, int columns, int rows) {
  scores.width = (columns + kCorrelateBlock - 1) / kCorrelateBlock * kCorrelateBlock;
  scores.height = rows;
  scores.values.resize(static_cast<std::size_t>(scores.width) * scores.height);
}

}  // namespace gridmerge::internal
