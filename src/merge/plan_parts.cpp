// SPDX-License-Identifier: Apache-2.0
#include "merge/plan_parts.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "match/match_at_scales.hpp"
#include "match/prepared_map.hpp"
#include "merge/copies.hpp"
#include "merge/joins.hpp"

namespace gridmerge::internal {

namespace {

/// More maps of one part say little that these have not said.
constexpr std::size_t kMostMembers = 16;

std::shared_ptr<const MapStore::Input> input_of(OccupancyGrid grid) {
  return std::make_shared<const MapStore::Input>(std::make_shared<const OccupancyGrid>(std::move(grid)));
}

/// The members that know most, without copies: in an order that depends on the maps alone.
std::vector<Member> speakers(const std::vector<Member>& members, const PlanInputs& inputs) {
  std::vector<Member> chosen;
  for (const Member& member : members) {
    const PreparedMap& map = inputs[member.map]->prepared;
    if (map.counts().occupied == 0) continue;
    const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const Member& other) {
      return is_copy(map, inputs[other.map]->prepared);
    });
    if (is_new) chosen.push_back(member);
  }
  std::stable_sort(chosen.begin(), chosen.end(), [&](const Member& a, const Member& b) {
    return is_smaller(inputs[b.map]->prepared, inputs[a.map]->prepared);
  });
  if (chosen.size() > kMostMembers) chosen.resize(kMostMembers);
  return chosen;
}

/// All maps of a component as one, seen from `first`: from the member that says most it is the same map
/// whichever comes first. Copies count once.
OccupancyGrid all_as_one(const Component& component, const Member& first, const PlanInputs& inputs) {
  const SE2 T_first_component = inverse(first.T_component_map);
  std::vector<PlacedInput> all;
  for (const Member& member : component.members) {
    const SE2 T_first_map = member.map == first.map ? SE2{} : T_first_component * member.T_component_map;
    all.push_back({&inputs[member.map]->prepared, T_first_map});
  }
  std::vector<PlacedMap> placed;
  std::vector<Deformation> deformations;
  for (const std::size_t place : without_copies(all)) {
    const Member& member = component.members[place];
    placed.push_back({inputs[member.map]->grid.get(), all[place].T_output_map});
    deformations.push_back(member.deformation);
  }
  const double resolution = fitting_resolution(component.fused.grid.resolution, placed, deformations);
  return fuse(placed, resolution, deformations).grid;
}

}  // namespace

std::vector<MergePart> parts_of(const MergeResult& merged, const PlanInputs& inputs) {
  std::vector<MergePart> parts;
  for (std::size_t i = 0; i < merged.components.size(); ++i)
    parts.push_back({i, merged.components[i].members, {}});
  for (const LeftOut& one : merged.left_out)
    parts.push_back({std::nullopt, {{one.map, {}, 1.0, {}, {}}}, {}});
  std::sort(parts.begin(), parts.end(), [](const MergePart& a, const MergePart& b) {
    return a.members.front().map < b.members.front().map;
  });
  for (MergePart& part : parts) {
    // Walls of one may be outvoted by what others say, or bent away: what has none left says nothing.
    const auto add = [&](PlanVoice voice) {
      if (voice.input->prepared.counts().occupied > 0) part.voices.push_back(std::move(voice));
    };
    const std::vector<Member> members = speakers(part.members, inputs);
    if (members.size() > 1) {
      const Member& first = members.front();
      add({{},
           first.T_component_map,
           input_of(all_as_one(merged.components[*part.component], first, inputs)),
           {}});
    }
    for (const Member& member : members) {
      const auto& straight = inputs[member.map];
      const bool is_bent = !member.deformation.is_identity();
      add({member.map,
           member.T_component_map,
           is_bent ? input_of(bent_map(*straight->grid, member.deformation)) : straight,
           {}});
    }
  }
  return parts;
}

void hear(std::vector<MergePart>& parts, const PreparedMap& plan, const MatchOptions& options,
          const std::function<void(std::size_t, std::size_t)>& progress) {
  std::vector<PlanVoice*> voices;
  for (MergePart& part : parts) {
    for (PlanVoice& voice : part.voices) voices.push_back(&voice);
  }
  std::mutex telling;
  std::size_t done = 0;
  if (progress && !voices.empty()) progress(0, voices.size());
  parallel_tasks(voices.size(), [&](std::size_t i) {
    voices[i]->match = match_at_scales(voices[i]->input->prepared, plan, options);
    const std::scoped_lock lock(telling);
    ++done;
    if (progress) progress(done, voices.size());
  });
}

}  // namespace gridmerge::internal
