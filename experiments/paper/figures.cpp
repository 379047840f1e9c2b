// SPDX-License-Identifier: Apache-2.0
#include "figures.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "gridmerge/search/random_walk.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "io/atomic_file.hpp"
#include "pictures.hpp"
#include "report/distance_picture.hpp"
#include "runs.hpp"

namespace gridmerge::paper {

using namespace internal;

namespace {

constexpr int kSide = 400;
constexpr std::uint64_t kShownDraw = 1;

using Folder = std::filesystem::path;

std::string save(const Folder& folder, const std::string& name, const std::string& png,
                 const std::string& what) {
  write_file_atomically(folder / name, png);
  return fmt::format("- {}: {}\n", name, what);
}

/// A small map: a wall with a corner, and a box.
OccupancyGrid small_map() {
  OccupancyGrid map = make_grid(12, 9, 0.25, {});
  for (Cell& cell : map.cells) cell = Cell::free;
  for (int column = 1; column < 8; ++column) map.at(column, 6) = Cell::occupied;
  for (int row = 3; row < 7; ++row) map.at(1, row) = Cell::occupied;
  map.at(9, 2) = Cell::occupied;
  return map;
}

std::string figure_1(const Folder& folder) {
  const OccupancyGrid map = small_map();
  const DistanceMap distances = make_distance_map(map, Cell::occupied);
  return save(folder, "fig1_map.png", draw(map), "a small map") +
         save(folder, "fig1_dmap.png", distance_map_png(distances),
              "its d-map of occupied: each cell's Manhattan distance to the nearest occupied one");
}

std::string figure_2(const Folder& folder) {
  const DistanceMapPasses passes = trace_distance_map(small_map(), Cell::occupied);
  const auto show = [&](const DistanceMap& distances, const std::string& name, const std::string& what) {
    return save(folder, "fig2_" + name + ".png", distance_map_png(distances), what);
  };
  return show(passes.start, "start", "0 at occupied cells, infinity (a dot) elsewhere") +
         show(passes.forward, "forward", "after the pass from the upper left corner") +
         show(passes.backward, "backward", "after the pass from the lower right corner: the d-map");
}

/// What the paper measures along a cut through the truth: the moving map is shifted along x.
std::string figure_3(const Folder& folder) {
  constexpr int kReach = 120;  // cells on either side
  const Draw draw = make_draw(kSide, kShownDraw);
  std::string about;
  for (const auto& [fixed, moving] : {std::pair<std::size_t, std::size_t>{1, 2}, {3, 4}}) {
    const Pair pair = pair_of(draw, fixed, moving);
    std::vector<SE2> cut;
    for (int shift = -kReach; shift <= kReach; ++shift) {
      cut.push_back(pair.truth());
      cut.back().x += shift * pair.fixed->map.resolution;
    }
    std::string table = "shift [cells]\tpsi\tagr - dis\tomega\tdelta, c_lock 0\tdelta, c_lock 7.5\n";
    int shift = -kReach;
    for (const MeasuredPose& pose : measure_poses(pair.fixed->map, pair.moving->map, cut)) {
      const ImageSimilarity& measured = pose.similarity;
      fmt::format_to(std::back_inserter(table), "{}\t{}\t{}\t{}\t{}\t{}\n", shift++, measured.psi(),
                     measured.agreement - measured.disagreement, measured.omega, measured.delta(0.0),
                     measured.delta(7.5));
    }
    const std::string name = fmt::format("fig3_m{}_m{}.tsv", fixed, moving);
    write_file_atomically(folder / name, table);
    about += fmt::format("- {}: {} along x through the truth\n", name, pair.name);
  }
  return about;
}

std::string figure_4(const Folder& folder) {
  const Draw shown = make_draw(kSide, kShownDraw);
  const OccupancyGrid plan = draw_building(shown.building, 0.25);
  std::vector<PlacedMap> placed;
  for (const RobotMap& robot : shown.robots) placed.push_back({&robot.map, robot.T_building_map});
  return save(folder, "fig4_plan.png", draw(plan), "the floor plan") +
         save(folder, "fig4_truth.png", draw_placed(placed), "the eight maps where they belong");
}

std::string show_maps(const Folder& folder, int figure, std::size_t first, std::size_t last) {
  const Draw shown = make_draw(kSide, kShownDraw);
  std::string about;
  for (std::size_t robot = first; robot <= last; ++robot) {
    about += save(folder, fmt::format("fig{}_m{}.png", figure, robot), draw(shown.robots[robot - 1].map),
                  fmt::format("m{}", robot));
  }
  return about;
}

std::string show_merge(const Folder& folder, const std::string& name, const Pair& pair,
                       const Method& method) {
  const Run run = merge_two(pair, method, kShownDraw);
  return save(folder, name, draw_merged(pair, run.T_fixed_moving),
              fmt::format("{} by {}: ai {:.4f}, {:.2f} m off the truth, {}", pair.name, method.name,
                          run.found.acceptance_index(), run.error, run.accepted ? "accepted" : "refused"));
}

std::string show_merges(const Folder& folder, int figure, std::size_t fixed, std::size_t moving) {
  const Draw shown = make_draw(kSide, kShownDraw);
  const Pair pair = pair_of(shown, fixed, moving);
  return save(folder, fmt::format("fig{}_truth.png", figure), draw_merged(pair, pair.truth()), "the truth") +
         show_merge(folder, fmt::format("fig{}_c_lock_0.png", figure), pair, {"a walk, c_lock 0", {0.0}, 1}) +
         show_merge(folder, fmt::format("fig{}_c_lock_7.5.png", figure), pair,
                    {"a walk, c_lock 7.5", {7.5}, 1}) +
         show_merge(folder, fmt::format("fig{}_engine.png", figure), pair, {"the engine", {}, 1});
}

std::string figure_10(const Folder& folder) {
  const Draw shown = make_draw(kSide, kShownDraw);
  std::string about;
  for (const auto& [fixed, moving] : {std::pair<std::size_t, std::size_t>{5, 6}, {6, 7}, {7, 8}, {5, 8}}) {
    about += show_merge(folder, fmt::format("fig10_m{}_m{}.png", fixed, moving),
                        pair_of(shown, fixed, moving), {"a walk, c_lock 7.5", {7.5}, 1});
  }
  return about;
}

std::string figure_11(const Folder& folder) {
  const Draw shown = make_draw(kSide, kShownDraw);
  std::vector<OccupancyGrid> maps;
  for (std::size_t i = 2; i < shown.robots.size(); ++i) maps.push_back(shown.robots[i].map);
  const MergeResult result = merge(maps);
  std::string about;
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    about += save(folder, fmt::format("fig11_{}.png", i + 1), draw(result.components[i].fused.grid),
                  fmt::format("{} of m3 to m8, merged by the engine", result.components[i].members.size()));
  }
  return about;
}

}  // namespace

std::string make_figure(int number, const Folder& folder) {
  static const std::array<std::function<std::string(const Folder&)>, kLastFigure> kFigures{
      figure_1,
      figure_2,
      figure_3,
      figure_4,
      [](const Folder& to) { return show_maps(to, 5, 1, 2); },
      [](const Folder& to) { return show_merges(to, 6, 1, 2); },
      [](const Folder& to) { return show_maps(to, 7, 3, 4); },
      [](const Folder& to) { return show_merges(to, 8, 3, 4); },
      [](const Folder& to) { return show_maps(to, 9, 5, 8); },
      figure_10,
      figure_11};
  if (number < kFirstFigure || number > kLastFigure)
    throw std::invalid_argument(fmt::format("figures are {} to {}", kFirstFigure, kLastFigure));
  return fmt::format("## Figure {}\n\n", number) +
         kFigures[static_cast<std::size_t>(number) - kFirstFigure](folder);
}

}  // namespace gridmerge::paper
