// SPDX-License-Identifier: Apache-2.0
// The experiments of A. Birk and S. Carpin, "Merging occupancy grid maps from multiple robots" (2006), made
// again on maps of our own that are like theirs, and the same with the exhaustive search.
//
// usage: gridmerge_paper DIR
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "gridmerge/evaluate/displacement.hpp"
#include "gridmerge/io/atomic_file.hpp"
#include "gridmerge/match/random_walk_match.hpp"
#include "gridmerge/merge/tree.hpp"
#include "maps.hpp"

namespace {

using namespace gridmerge;
using gridmerge::paper::Pair;
using gridmerge::paper::RobotMap;

constexpr double kTolerance = 1.0;         // [m]: a larger error is a wrong pose
constexpr double kAcceptanceIndex = 0.98;  // the paper's

struct Run {
  std::size_t steps = 0;
  std::size_t accepted_steps = 0;
  double acceptance_index = 0.0;
  double seconds = 0.0;
  double error = 0.0;  // [m]
  bool accepted = false;
  SE2 T_fixed_moving;

  bool correct() const { return error <= kTolerance; }
};

double error_of(const Pair& pair, const SE2& T_fixed_moving) {
  return rms_displacement(pair.moving->map, T_fixed_moving, pair.truth());
}

/// How often walks are made, and under which c_lock.
struct Walks {
  double c_lock;
  int restarts;
};

Run walk(const Pair& pair, const Walks& walks, std::uint64_t seed) {
  Run run;
  RandomWalkMatchOptions options;
  options.walk.seed = seed;
  options.c_locks = {walks.c_lock};
  options.restarts = walks.restarts;
  options.accept_acceptance_index = kAcceptanceIndex;
  options.threads = 1;
  options.on_walk = [&](int, double, const RandomWalkResult& walked) {
    run.steps += walked.proposals;
    run.accepted_steps += walked.accepted;
  };
  const MatchResult result = match_by_random_walk(pair.fixed->map, pair.moving->map, options);
  run.acceptance_index = result.acceptance_index;
  run.seconds = result.seconds;
  run.error = error_of(pair, result.T_fixed_moving);
  run.accepted = result.verdict == Verdict::accepted;
  run.T_fixed_moving = result.T_fixed_moving;
  return run;
}

Run search(const Pair& pair) {
  MatchOptions options;
  options.threads = 1;
  const MatchResult result = match(pair.fixed->map, pair.moving->map, options);
  return {0,
          0,
          result.acceptance_index,
          result.seconds,
          error_of(pair, result.T_fixed_moving),
          result.verdict == Verdict::accepted,
          result.T_fixed_moving};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

template <typename Value>
double median_of(const std::vector<Run>& runs, Value Run::*value) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const Run& run : runs) values.push_back(static_cast<double>(run.*value));
  return median(values);
}

std::string row(const std::string& pair, const std::string& method, const std::vector<Run>& runs) {
  const auto count = [&](auto condition) { return std::count_if(runs.begin(), runs.end(), condition); };
  const auto [low, high] = std::minmax_element(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return a.acceptance_index < b.acceptance_index;
  });
  const bool walked = runs.front().steps > 0;
  return fmt::format(
      "| {} | {} | {} | {} | {:.4f} ({:.4f}–{:.4f}) | {:.3f} | {:.2f} | {} of {} | {} | {} |\n", pair, method,
      walked ? fmt::format("{:.0f}", median_of(runs, &Run::steps)) : "–",
      walked ? fmt::format("{:.0f}", median_of(runs, &Run::accepted_steps)) : "–",
      median_of(runs, &Run::acceptance_index), low->acceptance_index, high->acceptance_index,
      median_of(runs, &Run::seconds), median_of(runs, &Run::error),
      count([](const Run& run) { return run.correct(); }), runs.size(),
      count([](const Run& run) { return run.accepted && run.correct(); }),
      count([](const Run& run) { return run.accepted && !run.correct(); }));
}

constexpr const char* kHead =
    "| maps | method | steps | of them accepted | ai: median (least–most) | seconds | error [m] | right "
    "poses | "
    "accepted, right | accepted, wrong |\n|---|---|---|---|---|---|---|---|---|---|\n";

std::string compare(const Pair& pair, int seeds, const std::filesystem::path& folder) {
  std::string table;
  std::vector<Walks> settings{{0.0, 1}, {7.5, 1}};
  if (pair.fixed->map.width <= 400) settings.push_back({7.5, 4});  // on large maps this takes minutes
  for (const Walks& walks : settings) {
    const std::string method =
        fmt::format("walk, c_lock {}{}", walks.c_lock,
                    walks.restarts > 1 ? fmt::format(", {} restarts", walks.restarts) : "");
    std::vector<Run> runs;
    for (int seed = 1; seed <= seeds; ++seed) {
      runs.push_back(walk(pair, walks, static_cast<std::uint64_t>(seed)));
      fmt::print(stderr, "  {}, {}, seed {} of {}: {:.1f} s\n", pair.name, method, seed, seeds,
                 runs.back().seconds);
    }
    table += row(pair.name, method, runs);
    const auto best = std::max_element(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
      return a.acceptance_index < b.acceptance_index;
    });
    write_file_atomically(folder / fmt::format("{}_walk_{}_{}.png", pair.name, walks.c_lock, walks.restarts),
                          draw_merged(pair, best->T_fixed_moving));
  }
  const Run exhaustive = search(pair);
  write_file_atomically(folder / (pair.name + "_exhaustive.png"),
                        draw_merged(pair, exhaustive.T_fixed_moving));
  return table + row(pair.name, "exhaustive", {exhaustive});
}

/// How many maps are placed, and how many of them lie where they should relative to their component's first
/// one, which gives the frame.
std::string describe_merge(const std::vector<RobotMap>& maps, const std::string& method,
                           const MergeResult& result, double seconds) {
  std::size_t right = 0;
  std::size_t placed = 0;
  for (const Component& component : result.components) {
    const RobotMap& frame = maps[component.members.front().map];
    for (const Member& member : component.members) {
      const RobotMap& robot = maps[member.map];
      const SE2 truth = inverse(frame.T_building_map) * robot.T_building_map;
      right += rms_displacement(robot.map, member.T_component_map, truth) <= kTolerance ? 1 : 0;
      ++placed;
    }
  }
  return fmt::format("| {} | {} | {} | {} | {:.1f} |\n", method, result.components.size(), placed, right,
                     seconds);
}

std::string merge_all(const std::vector<RobotMap>& robots) {
  std::vector<OccupancyGrid> maps;
  maps.reserve(robots.size());
  for (const RobotMap& robot : robots) maps.push_back(robot.map);
  std::string table =
      "| method | components | maps placed | of them right | seconds |\n|---|---|---|---|---|\n";
  const auto add = [&](const std::string& method, const Matcher& matcher) {
    double seconds = 0.0;
    const MergeResult result =
        merge_up_tree(maps, [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
          MatchResult match = matcher(fixed, moving);
          seconds += match.seconds;
          return match;
        });
    table += describe_merge(robots, method, result, seconds);
  };
  for (const std::vector<double>& c_locks : {std::vector<double>{0.0}, std::vector<double>{0.0, 7.5}}) {
    add(c_locks.size() == 1 ? "walk, c_lock 0, 3 restarts" : "walk, c_lock 0 and 7.5 in turn, 4 restarts",
        [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
          RandomWalkMatchOptions options;
          options.c_locks = c_locks;
          options.restarts = c_locks.size() == 1 ? 3 : 4;
          options.threads = 1;
          return match_by_random_walk(fixed, moving, options);
        });
  }
  add("exhaustive", [](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    MatchOptions options;
    options.threads = 1;
    return match(fixed, moving, options);
  });
  return table;
}

std::string describe(const Pair& pair) {
  const auto shared = measure_shared(pair);
  const ImageSimilarity truth = measure_similarity(pair.fixed->map, pair.moving->map, pair.truth());
  double least = truth.psi();
  for (const MeasuredPose& start : measure_start_poses(pair.fixed->map, pair.moving->map))
    least = std::min(least, start.similarity.psi());
  return fmt::format(
      "- {}: {:.2f} % of the fixed map's known cells and {:.2f} % of the moving map's are known in both; at "
      "the truth psi "
      "is {:.1f} and ai {:.4f}; the least psi there and at the start poses is {:.1f}\n",
      pair.name, 100.0 * shared.of_fixed, 100.0 * shared.of_moving, truth.psi(), truth.acceptance_index(),
      least);
}

void run(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::vector<RobotMap> small = paper::make_maps(400);
  const std::vector<RobotMap> large = paper::make_maps(1000);
  for (std::size_t i = 0; i < small.size(); ++i)
    write_file_atomically(folder / fmt::format("m{}.png", i + 1), paper::draw(small[i].map));
  const std::vector<std::pair<Pair, int>> experiments{{{"m1_m2", &small[0], &small[1]}, 10},
                                                      {{"m3_m4", &small[2], &small[3]}, 10},
                                                      {{"m1_m2_1000", &large[0], &large[1]}, 3}};
  std::string report = "# The paper's experiments, made again\n\n";
  for (const auto& [pair, seeds] : experiments) report += describe(pair);
  report += std::string("\n") + kHead;
  for (const auto& [pair, seeds] : experiments) report += compare(pair, seeds, folder);
  report += "\nSix maps of 400 x 400 cells up the binary tree:\n\n" + merge_all(small);
  write_file_atomically(folder / "report.md", report);
  std::fputs(report.c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: gridmerge_paper DIR\n", stderr);
    return 2;
  }
  try {
    run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gridmerge_paper: %s\n", error.what());
    return 1;
  }
  return 0;
}
