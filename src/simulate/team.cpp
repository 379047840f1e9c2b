// SPDX-License-Identifier: Apache-2.0
#include "simulate/team.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "grid/parallel.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kUnlimited = 1e6;  // [m]

/// With few digits, for messages.
std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// For every cell the way to the nearest of `starts` [m].
std::vector<double> ways_from(const FloorPlan& plan, PathSearch& search, const std::vector<int>& starts) {
  std::vector<double> ways(static_cast<std::size_t>(plan.cells()), std::numeric_limits<double>::infinity());
  for (const int start : starts) {
    search.search(start, kUnlimited, [&](int cell, double way) {
      double& least = ways[static_cast<std::size_t>(cell)];
      least = std::min(least, way);
      return false;
    });
  }
  return ways;
}

/// Starts far from each other, each the farthest of a few random cells.
std::vector<int> spread_starts(const FloorPlan& plan, int robots, Random& random) {
  constexpr int kTries = 6;
  PathSearch search(plan);
  const auto any = [&] {
    return plan.free_cells()[static_cast<std::size_t>(random.pick(0, plan.count_free() - 1))];
  };
  std::vector<int> starts{any()};
  std::vector<double> ways = ways_from(plan, search, starts);
  while (static_cast<int>(starts.size()) < robots) {
    int farthest = any();
    for (int i = 1; i < kTries; ++i) {
      const int cell = any();
      if (ways[static_cast<std::size_t>(cell)] > ways[static_cast<std::size_t>(farthest)]) farthest = cell;
    }
    starts.push_back(farthest);
    const std::vector<double> further = ways_from(plan, search, {farthest});
    for (std::size_t i = 0; i < ways.size(); ++i) ways[i] = std::min(ways[i], further[i]);
  }
  return starts;
}

std::vector<int> given_starts(const FloorPlan& plan, const std::vector<Point2>& points) {
  constexpr double kNear = 0.5;  // [m]
  std::vector<int> starts;
  for (const Point2& p : points) {
    starts.push_back(plan.free_cell_near(p, kNear));
    if (starts.back() < 0) {
      throw std::invalid_argument("no robot can stand at " + to_text(p.x) + "," + to_text(p.y) +
                                  ": it is in a wall, in furniture or outside, or cannot be reached");
    }
  }
  return starts;
}

/// The mean over the robots of the largest share of the smaller coverage that two have in common.
double mean_overlap(const std::vector<Exploration>& explorations) {
  double sum = 0.0;
  for (std::size_t i = 0; i < explorations.size(); ++i) {
    double largest = 0.0;
    for (std::size_t k = 0; k < explorations.size(); ++k) {
      if (i == k) continue;
      const SeenFloor &a = explorations[i].drawn, &b = explorations[k].drawn;
      largest = std::max(
          largest, count_common(a, b) / static_cast<double>(std::max(1, std::min(a.count(), b.count()))));
    }
    sum += largest;
  }
  return sum / static_cast<double>(explorations.size());
}

std::vector<Exploration> explore_all(const Team& team, double reach) {
  std::vector<std::optional<Exploration>> found(team.errands.size());
  parallel_for(found.size(), [&](std::size_t i) {
    Errand errand = team.errands[i];
    errand.reach = reach;
    found[i] = explore(team.visits[i].plan, team.visits[i].caster, errand);
  });
  std::vector<Exploration> explorations;
  explorations.reserve(found.size());
  for (std::optional<Exploration>& one : found) explorations.push_back(std::move(*one));
  return explorations;
}

/// How far robots go, and what overlap they have then.
struct Reach {
  double metres = kUnlimited;
  double overlap = std::numeric_limits<double>::infinity();
};

/// The reach, the same for all, at which the robots' overlap is nearest to the wanted one: it grows with the
/// reach, so it is bisected.
Reach find_reach(double wanted, const Team& team) {
  constexpr int kRounds = 11;
  constexpr double kNearEnough = 0.01;
  Reach best;
  const auto try_reach = [&](double reach) {
    const double overlap = mean_overlap(explore_all(team, reach));
    const double off = std::abs(overlap - wanted), least = std::abs(best.overlap - wanted);
    if (off < least || (overlap == best.overlap && reach > best.metres)) best = {reach, overlap};
    return overlap;
  };
  if (try_reach(kUnlimited) <= wanted) return best;
  double low = 0.0, high = 0.0;
  PathSearch search(team.visits.front().plan);
  search.search(team.errands.front().start, kUnlimited, [&](int, double way) {
    high = std::max(high, way);
    return false;
  });
  for (int round = 0; round < kRounds; ++round) {
    const double reach = 0.5 * (low + high);
    const double overlap = try_reach(reach);
    if (std::abs(overlap - wanted) < kNearEnough && wanted > 0.0) break;
    (overlap > wanted ? high : low) = reach;
  }
  return best;
}

Team gather(const SimulateOptions& options, const Building& building, const FloorPlan& plan,
            const std::vector<int>& starts, Random& random) {
  Team team;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    Errand errand;
    errand.start = starts[i];
    if (!options.headings.empty()) errand.heading = options.headings[i];
    errand.reach = kUnlimited;
    errand.longest_way = options.longest_way > 0.0 ? options.longest_way : kUnlimited;
    errand.sensor = options.sensor;
    errand.scan_every = options.scan_every;
    team.errands.push_back(errand);
    team.visits.push_back(
        make_visit(building.edges, plan, options.robot_radius, starts[i], options.clutter, random));
  }
  return team;
}

}  // namespace

bool is_near_enough(double overlap, double wanted) {
  return wanted == 0.0 ? overlap == 0.0 : std::abs(overlap - wanted) <= std::max(0.03, 0.12 * wanted);
}

std::invalid_argument no_such_overlap(double wanted, double nearest) {
  return std::invalid_argument("an overlap of " + to_text(wanted) +
                               " cannot be had in this building from these starts and ways: the nearest is " +
                               to_text(nearest));
}

Team plan_team(const SimulateOptions& options, const Building& building, const FloorPlan& plan,
               Random& random) {
  if (!options.overlap) {
    const std::vector<int> starts = options.starts.empty() ? spread_starts(plan, options.robots, random)
                                                           : given_starts(plan, options.starts);
    return gather(options, building, plan, starts, random);
  }
  const double wanted = *options.overlap;
  const int tries = options.starts.empty() ? 6 : 1;
  Reach nearest;
  for (int i = 0; i < tries; ++i) {
    const std::vector<int> starts = options.starts.empty() ? spread_starts(plan, options.robots, random)
                                                           : given_starts(plan, options.starts);
    Team team = gather(options, building, plan, starts, random);
    const Reach reach = find_reach(wanted, team);
    if (std::abs(reach.overlap - wanted) < std::abs(nearest.overlap - wanted)) nearest = reach;
    if (!is_near_enough(reach.overlap, wanted)) continue;
    for (Errand& errand : team.errands) errand.reach = reach.metres;
    return team;
  }
  throw no_such_overlap(wanted, nearest.overlap);
}

}  // namespace gridmerge::internal
