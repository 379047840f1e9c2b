// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "grid/parallel.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kWalls = 400;      // of each map that are looked at for a pair
constexpr std::size_t kFirstWalls = 80;  // that say whether maps have any in common
constexpr std::size_t kDrawnTo = 8;      // maps are tied to so many others
constexpr double kLeastMet = 0.05;       // of the first walls
constexpr double kSd = 0.1;              // of a wall's place [m]
constexpr double kIndependent = 1.0;     // so long a wall is one observation [m]
constexpr double kHalfMisfit = 0.2;      // [m]: at which a wall counts half
constexpr double kCellsOfHalfMisfit = 2.0;
constexpr double kMisfitReach = 3.0;  // of that: what is farther counts as none
constexpr double kAlong = 0.05;       // where along a wall its partner is says so much less

/// A map's walls where they lie now.
struct SeenMap {
  Deformation deformation;
  SE2 T_map_group;
};

std::vector<SeenMap> see_all(const std::vector<ElasticMember>& members) {
  std::vector<SeenMap> seen;
  seen.reserve(members.size());
  for (const ElasticMember& member : members)
    seen.push_back({member.sheet.deformation(), inverse(member.sheet.T_group_map())});
  return seen;
}

Point2 turned(double theta, const Point2& p) {
  return SE2{0.0, 0.0, theta} * p;
}

/// The wall of a map where another map has it.
ElasticWall seen_in(const SeenMap& other, const ElasticMember& of, const ElasticWall& wall) {
  ElasticWall seen = wall;
  seen.position = other.deformation.straighten(other.T_map_group * of.sheet.to_group(wall.position));
  seen.normal = turned(of.sheet.T_group_map().theta + other.T_map_group.theta, wall.normal);
  return seen;
}

std::size_t drawn(std::size_t i, std::size_t of, std::size_t all) {
  return i * all / of;
}

/// Where a wall of a straight map lies.
FloorSquare square_of(const ElasticMember& member, const ElasticWall& wall, const WallFold& fold) {
  if (fold.has_all()) return {};
  const Point2 at = member.sheet.T_group_map() * wall.position;
  const auto part = [&](double value) {
    return static_cast<int>(std::clamp(std::floor(value / fold.side), -1e8, 1e8));
  };
  return {part(at.x), part(at.y)};
}

/// Adds what ties walls of `from` to those of `to`.
void tie(const ElasticMember& from, const ElasticMember& to, const SeenMap& seen_from_map,
         const SeenMap& seen_to, double reach, double cell, const WallFold& fold, bool to_is_first,
         std::vector<WallTie>& ties) {
  const std::vector<ElasticWall>& walls = from.walls.walls();
  const std::size_t count = std::min(kWalls, walls.size());
  const double weight = (fold.has_all() ? 1.0 : 2.0) * cell * static_cast<double>(walls.size()) /
                        static_cast<double>(count) / kIndependent;
  const double sd = std::max(kSd, cell), usual = std::max(0.5 * reach, 1.5 * sd);
  for (std::size_t i = 0; i < count; ++i) {
    const ElasticWall& wall = walls[drawn(i, count, walls.size())];
    if (!fold.has(square_of(from, wall, fold))) continue;
    const ElasticWall there = seen_in(seen_to, from, wall);
    const ElasticWall* const nearest = to.walls.nearest(there, reach);
    if (nearest == nullptr) continue;
    const Point2 here_in_group = from.sheet.to_group(wall.position);
    const Point2 there_in_group = to.sheet.to_group(nearest->position);
    const Point2 gap{here_in_group.x - there_in_group.x, here_in_group.y - there_in_group.y};
    // The normal half-way between the two.
    const double sign =
        nearest->normal.x * there.normal.x + nearest->normal.y * there.normal.y < 0.0 ? -1.0 : 1.0;
    const Point2 sum = turned(to.sheet.T_group_map().theta, {there.normal.x + sign * nearest->normal.x,
                                                             there.normal.y + sign * nearest->normal.y});
    const double length = std::hypot(sum.x, sum.y);
    // Shifts are compared at one place: two that shift it alike close no gap, so maps gain nothing by all
    // shrinking together.
    const Point2 middle{0.5 * (here_in_group.x + there_in_group.x),
                        0.5 * (here_in_group.y + there_in_group.y)};
    const SplineWeights at_from =
        from.sheet.weights_at(seen_from_map.deformation.straighten(seen_from_map.T_map_group * middle));
    const SplineWeights at_to =
        to.sheet.weights_at(seen_to.deformation.straighten(seen_to.T_map_group * middle));
    const double far = (gap.x * gap.x + gap.y * gap.y) / (usual * usual);
    WallTie one;
    one.at_first = to_is_first ? at_to : at_from;
    one.at_second = to_is_first ? at_from : at_to;
    one.gap = to_is_first ? Point2{-gap.x, -gap.y} : gap;
    one.normal = {sum.x / length, sum.y / length};
    one.across = weight / (sd * sd) / ((1.0 + far) * (1.0 + far));
    one.along = kAlong * one.across;
    ties.push_back(one);
  }
}

double half_misfit(double cell) {
  return std::max(kHalfMisfit, kCellsOfHalfMisfit * cell);
}

/// Adds how far walls of `from` lie from those of `to`.
void add_misfit(const ElasticMember& from, const ElasticMember& to, const SeenMap& seen_to, double cell,
                const WallFold& fold, PairMisfit& misfit) {
  const std::vector<ElasticWall>& walls = from.walls.walls();
  const std::size_t count = std::min(kWalls, walls.size());
  const double reach = kMisfitReach * half_misfit(cell);
  for (std::size_t i = 0; i < count; ++i) {
    const ElasticWall& wall = walls[drawn(i, count, walls.size())];
    const FloorSquare square = square_of(from, wall, fold);
    if (!fold.has(square)) continue;
    const ElasticWall there = seen_in(seen_to, from, wall);
    const ElasticWall* const nearest = to.walls.nearest(there, reach);
    double& sum = misfit.on[square];
    if (nearest == nullptr) {
      sum += 1.0;
      continue;
    }
    const Point2 gap{there.position.x - nearest->position.x, there.position.y - nearest->position.y};
    const double across = nearest->normal.x * gap.x + nearest->normal.y * gap.y;
    sum += misfit_of_gap(across, cell);
    misfit.met += 1.0;
  }
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> pairs_that_meet(const std::vector<ElasticMember>& members,
                                                                 double reach) {
  const std::vector<SeenMap> seen = see_all(members);
  struct Meeting {
    std::size_t first, second;
    double share;
  };
  std::vector<Meeting> meetings;
  for (std::size_t a = 0; a < members.size(); ++a) {
    for (std::size_t b = a + 1; b < members.size(); ++b) meetings.push_back({a, b, 0.0});
  }
  const auto share_met = [&](std::size_t from, std::size_t to) {
    const std::vector<ElasticWall>& walls = members[from].walls.walls();
    const std::size_t count = std::min(kFirstWalls, walls.size());
    double met = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const ElasticWall wall = seen_in(seen[to], members[from], walls[drawn(i, count, walls.size())]);
      met += members[to].walls.nearest(wall, reach) != nullptr ? 1.0 : 0.0;
    }
    return count == 0 ? 0.0 : met / static_cast<double>(count);
  };
  parallel_for(meetings.size(), [&](std::size_t i) {
    Meeting& meeting = meetings[i];
    if (members[meeting.first].held && members[meeting.second].held) return;
    meeting.share =
        std::max(share_met(meeting.first, meeting.second), share_met(meeting.second, meeting.first));
  });
  std::stable_sort(meetings.begin(), meetings.end(),
                   [](const Meeting& a, const Meeting& b) { return a.share > b.share; });
  std::vector<std::size_t> drawn_to(members.size(), 0);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Meeting& meeting : meetings) {
    if (meeting.share < kLeastMet) break;
    if (drawn_to[meeting.first] >= kDrawnTo && drawn_to[meeting.second] >= kDrawnTo) continue;
    ++drawn_to[meeting.first];
    ++drawn_to[meeting.second];
    pairs.emplace_back(meeting.first, meeting.second);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<TiedPair> tie_walls(const std::vector<ElasticMember>& members,
                                const std::vector<std::pair<std::size_t, std::size_t>>& pairs, double reach,
                                double cell, const WallFold& fold) {
  const std::vector<SeenMap> seen = see_all(members);
  std::vector<double> count(members.size(), 0.0);
  for (const auto& [first, second] : pairs) {
    count[first] += 1.0;
    count[second] += 1.0;
  }
  std::vector<TiedPair> tied(pairs.size());
  parallel_for(pairs.size(), [&](std::size_t i) {
    TiedPair& pair = tied[i];
    std::tie(pair.first, pair.second) = pairs[i];
    const ElasticMember &first = members[pair.first], &second = members[pair.second];
    tie(first, second, seen[pair.first], seen[pair.second], reach, cell, fold, false, pair.ties);
    tie(second, first, seen[pair.second], seen[pair.first], reach, cell, fold, true, pair.ties);
    const double share = 1.0 / (count[pair.first] + count[pair.second]);
    for (WallTie& one : pair.ties) {
      one.across *= share;
      one.along *= share;
    }
  });
  return tied;
}

double misfit_of_gap(double gap, double cell) {
  const double by_half = gap / half_misfit(cell);
  return by_half * by_half / (1.0 + by_half * by_half);
}

std::vector<PairMisfit> misfits_of(const std::vector<ElasticMember>& members,
                                   const std::vector<std::pair<std::size_t, std::size_t>>& pairs, double cell,
                                   const WallFold& fold) {
  const std::vector<SeenMap> seen = see_all(members);
  std::vector<PairMisfit> misfits(pairs.size());
  parallel_for(pairs.size(), [&](std::size_t i) {
    const auto& [first, second] = pairs[i];
    add_misfit(members[first], members[second], seen[second], cell, fold, misfits[i]);
    add_misfit(members[second], members[first], seen[first], cell, fold, misfits[i]);
  });
  return misfits;
}

}  // namespace gridmerge::internal
