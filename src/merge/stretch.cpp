// SPDX-License-Identifier: Apache-2.0
#include "merge/stretch.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "grid/longer_side.hpp"
#include "grid/parallel.hpp"
#include "match/drawn_walls.hpp"
#include "merge/disjoint_sets.hpp"
#include "merge/elastic_choice.hpp"
#include "merge/elastic_mean.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kLatticeByMap = 2.0;  // side of the lattice, by that of the map
constexpr double kLeastLattice = 1.0;  // [m]
constexpr int kMostRoundsOfMean = 20;
constexpr double kNoStretch = 1e-13;

/// Of each map the least map of those that pairs connect it with.
std::vector<std::size_t> parts_of(const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                  std::size_t maps) {
  DisjointSets connected(maps);
  for (const auto& [first, second] : pairs) connected.unite(first, second);
  std::vector<std::size_t> part(maps);
  for (std::size_t map = 0; map < maps; ++map) part[map] = connected.least_of(map);
  return part;
}

/// By how much a sheet is stretched along each direction: the logarithms, in the group's frame.
Eigen::Matrix2d log_stretch(const ElasticSheet& sheet) {
  const std::vector<Point2>& shifts = sheet.shifts();
  const Point2 corner = shifts.front(), right = shifts[static_cast<std::size_t>(sheet.columns() - 1)],
               top = shifts[shifts.size() - static_cast<std::size_t>(sheet.columns())];
  const double along_x = (sheet.columns() - 1) * sheet.spacing(),
               along_y = (sheet.rows() - 1) * sheet.spacing();
  Eigen::Matrix2d linear;
  linear << 1.0 + (right.x - corner.x) / along_x, (top.x - corner.x) / along_y,
      (right.y - corner.y) / along_x, 1.0 + (top.y - corner.y) / along_y;
  linear = Eigen::Rotation2Dd(sheet.direction()).toRotationMatrix() * linear;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> squared(linear * linear.transpose());
  const Eigen::Vector2d logarithms = 0.5 * squared.eigenvalues().array().log();
  return squared.eigenvectors() * logarithms.asDiagonal() * squared.eigenvectors().transpose();
}

/// The maps of a part, whose sheets are changed together.
class Part {
 public:
  Part(std::vector<ElasticMember>& members, const std::vector<std::vector<Point2>>& known)
      : members_(members), known_(known) {}

  void add(std::size_t map) { maps_.push_back(map); }

  /// Makes the mean stretch none. The mean of the logarithms of the determinants is zero after the first
  /// round, that of the logarithms of the stretches, whose directions differ, after a few.
  void take_out_mean_stretch() {
    for (int round = 0; round < kMostRoundsOfMean; ++round) {
      Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
      for (const std::size_t map : maps_)
        mean += log_stretch(members_[map].sheet) / static_cast<double>(maps_.size());
      if (mean.norm() < kNoStretch) return;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(mean);
      const Eigen::Vector2d factors = (-axes.eigenvalues()).array().exp();
      const Eigen::Matrix2d undo =
          axes.eigenvectors() * factors.asDiagonal() * axes.eigenvectors().transpose();
      Affine change{undo(0, 0), undo(0, 1), undo(1, 0), undo(1, 1), {}};
      const Point2 middle = find_middle(), moved = change * middle;
      change.shift = {middle.x - moved.x, middle.y - moved.y};
      for (const std::size_t map : maps_) members_[map].sheet.move(members_[map].sheet.T_group_map(), change);
    }
  }

  bool is_believable() const {
    return std::all_of(maps_.begin(), maps_.end(), [&](std::size_t map) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(log_stretch(members_[map].sheet));
      return axes.eigenvalues().cwiseAbs().maxCoeff() <= std::log(kMostStretch);
    });
  }

 private:
  /// Of the maps' known cells.
  Point2 find_middle() const {
    Point2 sum;
    double count = 0.0;
    for (const std::size_t map : maps_) {
      for (const Point2& p : known_[map]) {
        const Point2 at = members_[map].sheet.to_group(p);
        sum = {sum.x + at.x, sum.y + at.y};
        count += 1.0;
      }
    }
    return {sum.x / count, sum.y / count};
  }

  std::vector<ElasticMember>& members_;
  const std::vector<std::vector<Point2>>& known_;
  std::vector<std::size_t> maps_;
};

}  // namespace

std::vector<BentMember> stretch(const std::vector<RigidMember>& maps, double sd, MapTransform transform) {
  if (transform != MapTransform::similarity && transform != MapTransform::affine)
    throw std::invalid_argument("only similarity and affine stretch maps");
  const double cell = common_cell(maps);
  std::vector<ElasticMember> members;
  std::vector<std::vector<Point2>> known(maps.size());
  for (const RigidMember& one : maps) {
    const OccupancyGrid& map = one.map->known();
    members.push_back(
        {ElasticSheet(map, std::max(kLeastLattice, kLatticeByMap * longer_side(map)), one.T_group_map),
         ElasticWalls(DrawnWalls::of(*one.map, cell)), one.held, transform});
  }
  parallel_for(maps.size(), [&](std::size_t i) { known[i] = sample_known(maps[i].map->known()); });

  ElasticFit options;
  options.pairs = pairs_that_meet(members, first_reach(sd));
  options.sd = sd;
  options.cell = cell;
  const std::vector<std::size_t> part_of = parts_of(options.pairs, maps.size());
  const std::vector<bool> gains = find_parts_that_gain(options, choose_spacing(maps), members, part_of);
  std::vector<bool> is_anchored(maps.size(), false);  // by part
  for (std::size_t i = 0; i < maps.size(); ++i) {
    is_anchored[part_of[i]] = is_anchored[part_of[i]] || maps[i].held;
    members[i].held = maps[i].held || !gains[part_of[i]];
  }
  fit(options, members);

  std::vector<Part> parts(maps.size(), Part(members, known));
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (!members[i].held) parts[part_of[i]].add(i);
  }
  std::vector<bool> is_stretched(maps.size(), false);  // by part, whose least map gives it its number
  std::vector<BentMember> stretched;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (part_of[i] == i && gains[i]) {
      if (!is_anchored[i]) parts[i].take_out_mean_stretch();
      is_stretched[i] = parts[i].is_believable();
    }
    if (members[i].held || !is_stretched[part_of[i]]) {
      stretched.push_back({maps[i].T_group_map, {}});
      continue;
    }
    ElasticSheet& sheet = members[i].sheet;
    sheet.move(rigid_part(sheet, known[i]), {});
    stretched.push_back({sheet.T_group_map(), sheet.deformation()});
  }
  return stretched;
}

}  // namespace gridmerge::internal
