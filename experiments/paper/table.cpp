// SPDX-License-Identifier: Apache-2.0
#include "table.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <vector>

#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/match/random_walk_match.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/tree.hpp"
#include "runs.hpp"

namespace gridmerge::paper {

namespace {

const Method kWalk0{"walk, c_lock 0", {0.0}, 1};
const Method kWalk{"walk, c_lock 7.5", {7.5}, 1};
/// As the paper did for its hard pair: more walks, first with the one c_lock, then with the other.
const Method kManyWalks{"32 walks, c_lock 0 and 7.5 in turn", {0.0, 7.5}, 32};
const Method kEngine{"engine", {}, 1};

/// A row of table I: two maps, and how they are merged.
struct Row {
  std::size_t fixed;
  std::size_t moving;
  std::vector<Method> methods;
};

const std::vector<Row>& rows() {
  static const std::vector<Row> all{
      {1, 2, {kWalk0, kWalk, kEngine}}, {3, 4, {kWalk0, kWalk, kManyWalks, kEngine}},
      {5, 6, {kWalk, kEngine}},         {6, 7, {kWalk, kEngine}},
      {7, 8, {kWalk, kEngine}},         {5, 8, {kWalk, kEngine}}};
  return all;
}

std::string row_of(std::span<const Draw> draws, std::size_t fixed, std::size_t moving, const Method& method) {
  std::vector<Run> runs;
  std::string name;
  for (const Draw& draw : draws) {
    const Pair pair = pair_of(draw, fixed, moving);
    name = pair.name;
    runs.push_back(merge_two(pair, method, draw.seed));
    std::fprintf(stderr, "  %s, %s, draw %zu of %zu: %.1f s\n", name.c_str(), method.name.c_str(),
                 runs.size(), draws.size(), runs.back().seconds);
  }
  return runs_row(name, method, runs);
}

/// Of maps that were merged: how many lie together with others, and how many of these lie where they should
/// relative to the first one of their component.
struct Placed {
  std::size_t maps = 0;
  std::size_t right = 0;
  std::size_t whole = 0;  ///< draws in which all maps came into one
};

void add(Placed& placed, const MergeResult& result, const std::vector<RobotMap>& robots, std::size_t first) {
  for (const Component& component : result.components) {
    const RobotMap& frame = robots[first + component.members.front().map];
    for (const Member& member : component.members) {
      const RobotMap& robot = robots[first + member.map];
      const SE2 truth = inverse(frame.T_building_map) * robot.T_building_map;
      placed.right += rms_displacement(robot.map, member.T_component_map, truth) <= kTolerance ? 1 : 0;
      ++placed.maps;
    }
  }
  placed.whole += result.components.size() == 1 && result.left_out.empty() ? 1 : 0;
}

/// "3to8": m3 to m8 into one map.
std::string row_of_many(std::span<const Draw> draws, const std::string& name,
                        const std::function<MergeResult(const std::vector<OccupancyGrid>&)>& merger) {
  constexpr std::size_t kFirst = 2;  // m3
  Placed placed;
  std::size_t all = 0;
  for (const Draw& draw : draws) {
    std::vector<OccupancyGrid> maps;
    for (std::size_t i = kFirst; i < draw.robots.size(); ++i) maps.push_back(draw.robots[i].map);
    all += maps.size();
    add(placed, merger(maps), draw.robots, kFirst);
    std::fprintf(stderr, "  m3 to m8, %s, draw %zu\n", name.c_str(), static_cast<std::size_t>(draw.seed));
  }
  return fmt::format("| 3to8 | {} | {} of {} | {} of {} | {} |\n", name, placed.maps, all, placed.right,
                     placed.maps, placed.whole);
}

MatchResult walk_up(const OccupancyGrid& fixed, const OccupancyGrid& moving) {
  RandomWalkMatchOptions options;
  options.c_locks = {0.0, 7.5};
  options.restarts = 4;
  options.threads = 1;
  options.accept_acceptance_index = kAcceptanceIndex;
  return match_by_random_walk(fixed, moving, options);
}

}  // namespace

std::vector<Draw> make_draws(int side, int draws) {
  std::vector<Draw> made;
  for (int seed = 1; seed <= draws; ++seed) made.push_back(make_draw(side, static_cast<std::uint64_t>(seed)));
  return made;
}

std::string table_one(std::span<const Draw> draws) {
  std::string table = kRunsHead;
  for (const Row& row : rows()) {
    for (const Method& method : row.methods) table += row_of(draws, row.fixed, row.moving, method);
  }
  table += "\n| maps | method | placed | of these right | draws with all in one |\n|---|---|---|---|---|\n";
  table += row_of_many(draws, "up the tree, 4 walks, c_lock 0 and 7.5 in turn",
                       [](const auto& maps) { return merge_up_tree(maps, walk_up); });
  table += row_of_many(draws, "engine, jointly", [](const auto& maps) { return merge(maps); });
  return table;
}

std::string hard_pair_measures(std::span<const Draw> draws) {
  const Method method{"8 walks, c_lock 7.5", {7.5}, 8};
  std::string table =
      "| draw | Δ at the truth | Δ found | ω at the truth | ω found | ai at the truth | ai found | error [m] "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const Draw& draw : draws) {
    const Run run = merge_two(pair_of(draw, 3, 4), method, draw.seed);
    std::fprintf(stderr, "  hard pair, draw %zu of %zu: %.1f s\n", static_cast<std::size_t>(draw.seed),
                 draws.size(), run.seconds);
    table +=
        fmt::format("| {} | {:.0f} | {:.0f} | {} | {} | {:.3f} | {:.3f} | {:.2f} |\n", draw.seed,
                    run.truth.delta(run.c_lock), run.found.delta(run.c_lock), run.truth.omega,
                    run.found.omega, run.truth.acceptance_index(), run.found.acceptance_index(), run.error);
  }
  return table;
}

std::string shared_cells(std::span<const Draw> draws) {
  std::string table =
      "| draw | maps | shared, of the first | of the second | occupied in both | free in both | "
      "contradicting |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const Draw& draw : draws) {
    for (const Row& row : rows()) {
      const Pair pair = pair_of(draw, row.fixed, row.moving);
      const SharedCells shared = measure_shared(pair);
      table += fmt::format("| {} | {} | {:.2f} % | {:.2f} % | {} | {} | {} |\n", draw.seed, pair.name,
                           100.0 * shared.of_fixed, 100.0 * shared.of_moving, shared.common.occupied_occupied,
                           shared.common.free_free, shared.common.contradicting);
    }
  }
  return table;
}

std::string larger_maps(std::span<const Draw> draws) {
  std::string table = kRunsHead;
  for (const Method& method : {kWalk0, kWalk, kEngine}) table += row_of(draws, 1, 2, method);
  return table;
}

}  // namespace gridmerge::paper
