// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/search/exhaustive.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <unordered_map>

#include "correlate.hpp"
#include "gridmerge/grid/cancellation.hpp"
#include "gridmerge/grid/parallel.hpp"
#include "gridmerge/similarity/evidence.hpp"
#include "local_maxima.hpp"

namespace gridmerge {

namespace {

constexpr double kScale = 6.0;  // score units a nat
constexpr std::size_t kPeaksPerRotation = 96;
constexpr int kPeakFloor = 4;            // peaks below the best of their rotation by this factor are dropped
constexpr std::size_t kPilotStep = 8;    // every 8th rotation tells what the others have to reach
constexpr std::size_t kPilotMargin = 4;  // see foreseen_score()
constexpr int kApart = 2;                // candidates nearer than this in x, y and rotation are one
/// Shifts at which fewer than this share of the samples could lie on the fixed map are not looked at.
constexpr double kLeastMet = 0.08;
static_assert(kMaxSearchSamples * kMaxCorrelated < 32767);

/// A local maximum of the score, in steps of the search.
struct Peak {
  int rotation;
  int x;
  int y;
  int score;

  /// Best first; the rest of the order only has to be total, so that it does not depend on threads.
  friend bool operator<(const Peak& a, const Peak& b) {
    return std::tuple(-a.score, a.rotation, a.y, a.x) < std::tuple(-b.score, b.rotation, b.y, b.x);
  }
};

/// The frame of the search: the moving map turns about its centre inside a square box of coarse cells, and
/// the box slides over the fixed map from one touch to the last.
struct SearchFrame {
  double factor;  // cells to a coarse cell
  int rotations;
  Point2 centre;    // of the moving map [cells]
  int box;          // side of the box [coarse cells]
  int fixed_width;  // of the fixed map [coarse cells]
  int fixed_height;

  double angle(int rotation) const { return normalize_angle(2.0 * std::numbers::pi * rotation / rotations); }

  /// Grid frames, cells.
  SE2 pose(const Peak& peak) const {
    const SE2 rotate{0.0, 0.0, angle(peak.rotation)};
    const Point2 turned = rotate * centre;
    return {(peak.x - 0.5 * box) * factor - turned.x, (peak.y - 0.5 * box) * factor - turned.y, rotate.theta};
  }
};

SearchFrame make_frame(const WallMap& fixed, const WallMap& moving, const ExhaustiveSearchOptions& options) {
  const double factor = options.coarse_factor;
  const auto coarse = [&](double cells) { return static_cast<int>(std::ceil(cells / factor)); };
  SearchFrame frame{factor, options.rotations,   {0.5 * moving.width, 0.5 * moving.height},
                    0,      coarse(fixed.width), coarse(fixed.height)};
  frame.box = coarse(std::hypot(moving.width, moving.height)) + 2;
  return frame;
}

/// The evidence of a wall in each coarse cell of the fixed map.
EvidenceImage make_evidence_image(const WallMap& fixed, const SearchFrame& frame,
                                  const ExhaustiveSearchOptions& options) {
  const auto table = evidence_table({options.sigma, options.outliers}, fixed.background);
  std::vector<float> sums(static_cast<std::size_t>(frame.fixed_width) * frame.fixed_height, 0.0F);
  for (int y = 0; y < fixed.height; ++y) {
    throw_if_cancelled();
    const std::size_t line = static_cast<std::size_t>(y / options.coarse_factor) * frame.fixed_width;
    for (int x = 0; x < fixed.width; ++x) {
      const int distance = fixed.places[static_cast<std::size_t>(y) * fixed.width + x].distance;
      if (distance == kUnseen) continue;
      sums[line + x / options.coarse_factor] += table[encounter(distance, kUnclearFacing)];
    }
  }

  EvidenceImage image(frame.fixed_width, frame.fixed_height);
  const double cells = static_cast<double>(options.coarse_factor) * options.coarse_factor;
  for (int y = 0; y < frame.fixed_height; ++y) {
    for (int x = 0; x < frame.fixed_width; ++x) {
      const double mean = sums[static_cast<std::size_t>(y) * frame.fixed_width + x] / cells;
      image.at(x, y) = static_cast<std::int8_t>(
          std::clamp<long>(std::lround(kScale * mean), -kMaxCorrelated, kMaxCorrelated));
    }
  }
  return image;
}

/// The turned wall points, and the shifts at which enough of them can meet the fixed map.
struct TurnedWalls {
  std::vector<Sample> samples;  // in the fixed map's evidence, at the first shift
  int first_x = 0;              // shifts of the box, with one more on each side
  int first_y = 0;
  int shifts_x = 0;
  int shifts_y = 0;
};

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
  // the rim.
  return {box - highest - 1, length + highest - lowest + 2};
}

TurnedWalls turn_walls(const std::vector<WallPoint>& walls, const SearchFrame& frame, int rotation) {
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
  const std::size_t least = 1 + static_cast<std::size_t>(kLeastMet * static_cast<double>(walls.size()));
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

/// Finds the peaks of one rotation after the other, in memory that it keeps.
class PeakFinder {
 public:
  /// `pooled` is `evidence` by pool_pairs().
  PeakFinder(const EvidenceImage& evidence, const EvidenceImage& pooled)
      : evidence_(evidence), pooled_(pooled) {}

  /// The best local maxima of all shifts.
  std::vector<Peak> find_all(const TurnedWalls& turned, int rotation) {
    resize(scores_, turned.shifts_x, turned.shifts_y);
    correlate(evidence_, turned.samples, scores_);
    return best_of(turned, rotation, 0);
  }

  /// Those of them that score `least` (above 0) or more. Most shifts need no score of their own, because four
  /// at a time are found to score less.
  std::vector<Peak> find_from(int least, const TurnedWalls& turned, int rotation) {
    resize(bounds_, (turned.shifts_x + 1) / 2, (turned.shifts_y + 1) / 2);
    correlate(pooled_, pool_pairs(turned.samples), bounds_);
    resize(scores_, turned.shifts_x, turned.shifts_y);
    correlate_where(evidence_, turned.samples, bounds_, least, scores_);
    return best_of(turned, rotation, least - 1);
  }

 private:
  static void resize(ScoreImage& scores, int columns, int rows) {
    scores.width = (columns + kCorrelateBlock - 1) / kCorrelateBlock * kCorrelateBlock;
    scores.height = rows;
    scores.values.resize(static_cast<std::size_t>(scores.width) * scores.height);
  }

  std::vector<Peak> best_of(const TurnedWalls& turned, int rotation, int floor) const {
    const int best = find_maximum(scores_, turned.shifts_x);
    std::vector<Peak> peaks;
    for (const LocalMaximum& maximum :
         find_local_maxima(scores_, turned.shifts_x, std::max(floor, best / kPeakFloor)))
      peaks.push_back({rotation, turned.first_x + maximum.x, turned.first_y + maximum.y, maximum.score});
    if (peaks.size() > kPeaksPerRotation) {
      std::nth_element(peaks.begin(), peaks.begin() + kPeaksPerRotation, peaks.end());
      peaks.resize(kPeaksPerRotation);
    }
    return peaks;
  }

  const EvidenceImage& evidence_;
  const EvidenceImage& pooled_;
  ScoreImage scores_;
  ScoreImage bounds_;
};

/// Drops, best first, every peak that has a better one next to it.
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

/// What the last of `max_candidates` will score at least, by the peaks of the pilots: so that all rotations
/// have kPilotMargin times as many peaks, most of which lie beside better ones. 0 if they have not.
int foreseen_score(std::vector<Peak> pilots, std::size_t max_candidates) {
  const std::size_t wanted = kPilotMargin * max_candidates / kPilotStep;
  if (wanted == 0 || pilots.size() <= wanted) return 0;
  std::nth_element(pilots.begin(), pilots.begin() + static_cast<std::ptrdiff_t>(wanted), pilots.end());
  return pilots[wanted].score;
}

void check(const WallMap& fixed, const WallMap& moving, const ExhaustiveSearchOptions& options) {
  if (fixed.cell != moving.cell) throw std::invalid_argument("both wall maps must have cells of one size");
  if (options.coarse_factor < 1) throw std::invalid_argument("coarse_factor must be at least 1");
  if (options.rotations < 1) throw std::invalid_argument("rotations must be at least 1");
  if (options.samples > kMaxSearchSamples) throw std::invalid_argument("samples must be at most 240");
  if (!(options.sigma > 0.0)) throw std::invalid_argument("sigma must be positive");
  if (!(options.outliers > 0.0 && options.outliers < 1.0))
    throw std::invalid_argument("outliers must lie in (0, 1)");
}

}  // namespace

std::vector<PoseCandidate> search_all_poses(const WallMap& fixed, const WallMap& moving,
                                            const ExhaustiveSearchOptions& options) {
  check(fixed, moving, options);
  const SearchFrame frame = make_frame(fixed, moving, options);
  const EvidenceImage evidence = make_evidence_image(fixed, frame, options);
  const std::vector<WallPoint> walls = draw_evenly(moving.walls, options.samples);

  if (walls.empty()) return {};

  const EvidenceImage pooled = pool_pairs(evidence);
  tbb::enumerable_thread_specific<PeakFinder> finders([&] { return PeakFinder(evidence, pooled); });
  std::vector<std::vector<Peak>> peaks(options.rotations);
  const auto in_rotations = [&](bool pilots, auto find) {
    parallel_for(peaks.size(), [&](std::size_t i) {
      if ((i % kPilotStep == 0) != pilots) return;
      const int rotation = static_cast<int>(i);
      peaks[i] = find(finders.local(), turn_walls(walls, frame, rotation), rotation);
    });
  };
  const auto find_all = [](PeakFinder& finder, const TurnedWalls& turned, int rotation) {
    return finder.find_all(turned, rotation);
  };

  in_rotations(true, find_all);
  const int least = foreseen_score(together(peaks), options.max_candidates);
  if (least > 0) {
    in_rotations(false, [&](PeakFinder& finder, const TurnedWalls& turned, int rotation) {
      return finder.find_from(least, turned, rotation);
    });
  }
  // The best ones are the same whatever lies below `least`, if there are enough of them from there on.
  std::vector<Peak> kept;
  if (least > 0) {
    std::vector<Peak> from_least = together(peaks);
    std::erase_if(from_least, [&](const Peak& peak) { return peak.score < least; });
    kept = keep_distinct(std::move(from_least), options.rotations, options.max_candidates);
  }
  if (kept.size() < options.max_candidates) {
    in_rotations(false, find_all);
    kept = keep_distinct(together(peaks), options.rotations, options.max_candidates);
  }

  std::vector<PoseCandidate> candidates;
  for (const Peak& peak : kept) candidates.push_back({frame.pose(peak), peak.score});
  return candidates;
}

}  // namespace gridmerge
