// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic.hpp"

#include <algorithm>
#include <cstddef>

#include "grid/parallel.hpp"
#include "match/drawn_walls.hpp"
#include "merge/elastic_choice.hpp"
#include "merge/elastic_mean.hpp"

namespace gridmerge::internal {

std::vector<BentMember> bend(const std::vector<RigidMember>& maps, double sd) {
  const double cell = common_cell(maps), spacing = choose_spacing(maps);
  std::vector<ElasticMember> members;
  std::vector<std::vector<Point2>> known(maps.size());
  std::vector<SE2> straight;
  for (const RigidMember& one : maps) {
    members.push_back({ElasticSheet(one.map->known(), spacing, one.T_group_map),
                       ElasticWalls(DrawnWalls::of(*one.map, cell)), one.held});
    straight.push_back(one.T_group_map);
  }
  parallel_for(maps.size(), [&](std::size_t i) { known[i] = sample_known(maps[i].map->known()); });

  ElasticFit options;
  options.pairs = pairs_that_meet(members, first_reach(sd));
  options.sd = sd;
  options.cell = cell;
  const std::vector<bool> gains = find_gains(options, members);
  for (std::size_t i = 0; i < members.size(); ++i) members[i].held = members[i].held || !gains[i];
  const std::vector<bool> is_tied = fit(options, members);

  const bool is_anchored =
      std::any_of(members.begin(), members.end(), [](const ElasticMember& one) { return one.held; });
  const Affine change = is_anchored ? Affine{} : without_mean_strain(members, known, straight);
  std::vector<BentMember> bent;
  for (std::size_t i = 0; i < members.size(); ++i) {
    ElasticSheet& sheet = members[i].sheet;
    if (members[i].held || !is_tied[i] || known[i].empty()) {
      bent.push_back({maps[i].T_group_map, {}});
      continue;
    }
    sheet.move(sheet.T_group_map(), change);
    sheet.move(rigid_part(sheet, known[i]), {});
    bent.push_back({sheet.T_group_map(), sheet.deformation()});
  }
  return bent;
}

}  // namespace gridmerge::internal
