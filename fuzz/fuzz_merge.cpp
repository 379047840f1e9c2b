// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include "fuzz_target.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merger.hpp"
#include "tiny_maps.hpp"

namespace {

using namespace gridmerge;

using KnownPoses = std::vector<std::optional<KnownPose>>;

KnownPoses draw_known_poses(FuzzedDataProvider& bytes, std::size_t count) {
  KnownPoses poses(bytes.ConsumeBool() ? count : 0);
  for (auto& pose : poses) {
    if (bytes.ConsumeBool()) continue;
    const double sd = bytes.PickValueInArray({0.1, 1e-6, 1e3});
    pose = KnownPose{{bytes.ConsumeIntegralInRange(-9, 9) * 1.0, bytes.ConsumeIntegralInRange(-9, 9) * 1.0,
                      bytes.ConsumeIntegralInRange(-3, 3) * 1.0},
                     sd,
                     sd,
                     bytes.ConsumeBool()};
  }
  return poses;
}

/// Cells of the merged map in which it stays small, wherever the maps lie: of 2^28 cells a run takes minutes.
/// 0, the finest, where that is so anyway.
double draw_resolution(const std::vector<OccupancyGrid>& maps) {
  constexpr double kFarthestPose = 13.0, kMostCellsASide = 1000.0;
  double finest = maps.front().resolution, side = 0.0;
  for (const OccupancyGrid& map : maps) {
    finest = std::min(finest, map.resolution);
    side += 2.0 * (kFarthestPose + std::hypot(map.origin.x, map.origin.y) +
                   std::hypot(map.width, map.height) * map.resolution);
  }
  return side / finest > kMostCellsASide ? std::min(kMaxResolution, side / kMostCellsASide) : 0.0;
}

/// A map has no more freedom than was asked for.
bool is_allowed(const Deformation& deformation, MapTransform asked) {
  const MapTransform kind = deformation.kind();
  return kind <= asked;
}

void require_sound(const MergeResult& result, const std::vector<OccupancyGrid>& maps,
                   const MergeOptions& options) {
  std::set<std::size_t> seen;
  for (const LeftOut& one : result.left_out) seen.insert(one.map);
  fuzz::require(seen.size() == result.left_out.size());
  for (const Component& component : result.components) {
    fuzz::require(!component.members.empty());
    for (const Member& member : component.members) {
      fuzz::require(member.map < maps.size() && seen.insert(member.map).second);
      fuzz::require(is_finite(member.T_component_map));
      fuzz::require(is_allowed(member.deformation, options.transform));
      fuzz::require(member.deformation.strain_bound() <= Deformation::kMostStrain);
      fuzz::require(member.probability && *member.probability >= 0.0 && *member.probability <= 1.0);
      fuzz::require(member.sd && member.sd->position >= 0.0 && member.sd->theta >= 0.0);
      fuzz::require(std::isfinite(member.sd->position) && std::isfinite(member.sd->theta));
    }
    validate(component.fused.grid);
  }
  fuzz::require(seen.size() == maps.size());
  fuzz::require(result.joins.size() == maps.size() * (maps.size() - 1) / 2);
  for (const Join& join : result.joins) {
    fuzz::require_sound(join.match, maps[join.fixed], maps[join.moving], options.match.accept_probability);
    fuzz::require(is_finite(join.T_fixed_moving) && join.probability >= 0.0 && join.probability <= 1.0);
    fuzz::require(join.used() == (join.reason() == Reason::none));
  }
}

bool are_same(const MergeResult& a, const MergeResult& b) {
  const auto same_member = [](const Member& one, const Member& other) {
    return one.map == other.map && one.T_component_map == other.T_component_map &&
           one.deformation == other.deformation && one.probability == other.probability &&
           one.sd->position == other.sd->position && one.sd->theta == other.sd->theta;
  };
  return a.left_out == b.left_out && a.expected_false_joins == b.expected_false_joins &&
         std::ranges::equal(a.components, b.components, [&](const Component& one, const Component& other) {
           return std::ranges::equal(one.members, other.members, same_member) &&
                  one.fused.grid.cells == other.fused.grid.cells;
         });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  MergeOptions options;
  options.match.accept_probability = bytes.PickValueInArray({0.95, 0.0, 0.5});
  options.max_false_joins = bytes.PickValueInArray({0.05, 0.0, 10.0});
  const auto count = bytes.ConsumeIntegralInRange(std::size_t{2}, std::size_t{4});
  const KnownPoses known = draw_known_poses(bytes, count);
  const std::vector<OccupancyGrid> maps = fuzz::draw_maps(bytes, count);
  options.transform = bytes.PickValueInArray(
      {MapTransform::rigid, MapTransform::elastic, MapTransform::similarity, MapTransform::affine});
  options.resolution = draw_resolution(maps);
  options.match.search =
      bytes.PickValueInArray({SearchMethod::exhaustive, SearchMethod::quick, SearchMethod::thorough});
  MergeResult result;
  try {
    result = merge(maps, options, known);
  } catch (const std::invalid_argument&) {  // a merged map of too many cells
    return 0;
  }
  require_sound(result, maps, options);

  // Maps that come one by one give the same, on another number of threads too.
  options.match.threads = 1;
  Merger merger(options);
  for (std::size_t i = 0; i < count; ++i) merger.add(maps[i], i < known.size() ? known[i] : std::nullopt);
  fuzz::require(are_same(merger.solve(), result));
  return 0;
}
