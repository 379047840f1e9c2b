// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "grid/equal_grids.hpp"
#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/merge/plan.hpp"
#include "match/drawing.hpp"
#include "match/prepared_map.hpp"
#include "merge/consistent_set.hpp"
#include "merge/joins.hpp"
#include "merge/on_plan.hpp"
#include "merge/plan_ways.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// All that match() judges: poses of the scale that is known in the end may be none of the first.
constexpr std::size_t kJudgedPoses = 16;

MatchOptions plan_match_options(const MergeOptions& options, const ScaleRange& scales) {
  MatchOptions match = options.match;
  match.progress = nullptr;
  match.max_hypotheses = std::max(match.max_hypotheses, kJudgedPoses);
  match.scales = scales;
  validate(match);
  return match;
}

void check(const std::vector<OccupancyGrid>& maps, const MergeResult& merged) {
  std::vector<int> places(maps.size());
  const auto count = [&](std::size_t map) {
    if (map >= maps.size()) throw std::invalid_argument("the result is not one of these maps");
    ++places[map];
  };
  for (const Component& component : merged.components) {
    if (component.in_world_frame)
      throw std::invalid_argument("poses are fixed in the world's frame: maps on a plan are in the plan's");
    for (const Member& member : component.members) count(member.map);
  }
  for (const LeftOut& one : merged.left_out) count(one.map);
  if (std::any_of(places.begin(), places.end(), [](int times) { return times != 1; }))
    throw std::invalid_argument("the result is not one of these maps");
}

/// Finds which parts hang on the plan, and where.
class Hanger {
 public:
  Hanger(const PreparedMap& plan, const MergeResult& merged, const MergeOptions& options,
         const PlanOptions& plan_options, std::vector<MergePart>& parts)
      : plan_(plan), merged_(merged), options_(options), plan_options_(plan_options), parts_(parts) {
    std::size_t maps = 0;
    for (const MergePart& part : parts) maps += part.members.size();
    budget_ = false_joins_allowed(options.max_false_joins, maps);
  }

  /// By part; none of those that nothing is said of.
  std::vector<std::optional<PlanWay>> find() {
    hear(parts_, plan_, plan_match_options(options_, plan_options_.scales), plan_options_.progress);
    ways_.resize(parts_.size());
    parallel_for(parts_.size(), [&](std::size_t i) { ways_[i] = best_way(parts_[i], plan_); });
    hung_.assign(parts_.size(), false);
    const std::optional<std::size_t> surest = find_surest();
    if (!surest || !hang(*surest)) return std::move(ways_);
    hang_others(ways_[*surest]->scale);
    return std::move(ways_);
  }

  bool is_hung(std::size_t part) const { return hung_[part]; }
  double doubt() const { return doubt_; }

 private:
  std::optional<std::size_t> find_surest() const {
    std::optional<std::size_t> surest;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (hung_[i] || !ways_[i]) continue;
      if (!surest || is_surer(i, *surest)) surest = i;
    }
    return surest;
  }

  /// Of equally sure ones it is the one that knows more, whatever the order of the maps.
  bool is_surer(std::size_t part, std::size_t other) const {
    const double a = ways_[part]->probability, b = ways_[other]->probability;
    if (a != b) return a > b;
    return is_smaller(parts_[other].voices.front().input->prepared,
                      parts_[part].voices.front().input->prepared);
  }

  /// If it is sure enough.
  bool hang(std::size_t part) {
    const double doubt = 1.0 - ways_[part]->probability;
    if (ways_[part]->probability < options_.match.accept_probability || doubt_ + doubt > budget_)
      return false;
    doubt_ += doubt;
    hung_[part] = true;
    return true;
  }

  /// One after another: what hangs already has a say.
  void hang_others(double scale) {
    for (MergePart& part : parts_) know_scale(part, scale, plan_options_.scales);
    while (true) {
      std::vector<HungPart> hung;
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (hung_[i]) hung.push_back({&parts_[i], ways_[i]->T_plan_part});
      }
      parallel_for(parts_.size(), [&](std::size_t i) {
        if (!hung_[i]) ways_[i] = best_way_beside(parts_[i], hung, scale, plan_, merged_.joins);
      });
      const std::optional<std::size_t> next = find_surest();
      if (!next || !hang(*next)) return;
    }
  }

  const PreparedMap& plan_;
  const MergeResult& merged_;
  const MergeOptions& options_;
  const PlanOptions& plan_options_;
  std::vector<MergePart>& parts_;
  std::vector<std::optional<PlanWay>> ways_;
  std::vector<bool> hung_;
  double budget_ = 0.0;  // of its own: merge() makes joins until its budget is used up
  double doubt_ = 0.0;
};

/// Why a part is not on the plan.
Reason reason_of(const MergePart& part, const std::optional<PlanWay>& way, double accept_probability) {
  if (part.voices.empty()) return Reason::nothing_to_compare;
  const Reason own = part.voices.front().match.reason;
  if (own != Reason::none) return own;
  // Believed by itself, but the budget has no room for it; or not with what its members, or other parts, say.
  const bool is_sure = way && way->probability >= accept_probability;
  return is_sure ? Reason::over_budget : Reason::contradicts_others;
}

MergeResult hang_on_plan(const std::vector<OccupancyGrid>& maps, const OccupancyGrid& plan,
                         MergeResult merged, const MergeOptions& options, const PlanOptions& plan_options) {
  const PreparedMap drawn(with_enclosed_free(plan));
  PlanInputs inputs(maps.size());
  parallel_for(maps.size(), [&](std::size_t i) {
    inputs[i] = std::make_shared<const MapStore::Input>(std::make_shared<const OccupancyGrid>(maps[i]));
  });
  std::vector<MergePart> parts = parts_of(merged, inputs);
  Hanger hanger(drawn, merged, options, plan_options, parts);
  const std::vector<std::optional<PlanWay>> ways = hanger.find();
  PlanPlacement placement{plan_options.name, 1.0, {}, plan.resolution};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    PlanPart told;
    for (const Member& member : parts[i].members) told.maps.push_back(member.map);
    if (ways[i]) {
      told.T_plan_first = ways[i]->T_plan_part * parts[i].members.front().T_component_map;
      told.scale = ways[i]->scale;
      told.probability = ways[i]->probability;
    }
    told.reason =
        hanger.is_hung(i) ? Reason::none : reason_of(parts[i], ways[i], options.match.accept_probability);
    if (told.on_plan()) placement.scale = ways[i]->scale;
    placement.parts.push_back(std::move(told));
  }
  std::vector<OnPlan> hung;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (hanger.is_hung(i)) hung.push_back({&parts[i], *ways[i]});
  }
  merged.plan = std::move(placement);
  join_on_plan(hung, inputs, options.resolution, merged);
  return merged;
}

}  // namespace

void validate_plan(const std::vector<OccupancyGrid>& maps, const OccupancyGrid& plan) {
  validate(plan);
  OccupancyGrid drawn = with_enclosed_free(plan);
  if (count_cells(drawn).occupied == 0) throw std::invalid_argument("has no walls to hang maps on");
  if (PreparedMap(std::move(drawn)).counts().occupied == 0)
    throw std::invalid_argument("has no walls to hang maps on: none of what it draws has floor beside it");
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (has_equal_cells(maps[i], plan))
      throw std::invalid_argument("is the same as map " + std::to_string(i) + ", and cannot be its plan");
  }
}

MergeResult place_on_plan(const std::vector<OccupancyGrid>& maps, const OccupancyGrid& plan,
                          MergeResult merged, const MergeOptions& options, const PlanOptions& plan_options) {
  MergeResult placed;
  with_threads(options.match.threads, [&] {
    validate_merge(maps, options.resolution);
    validate_plan(maps, plan);
    check(maps, merged);
    plan_match_options(options, plan_options.scales);
    placed = hang_on_plan(maps, plan, std::move(merged), options, plan_options);
  });
  return placed;
}

}  // namespace gridmerge
