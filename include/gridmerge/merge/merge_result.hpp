// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/merge/fuse.hpp"

namespace gridmerge {

/// What became of a comparison of two maps.
enum class JoinOutcome {
  refused,   ///< the maps are not said to lie so, by themselves or with the others
  accepted,  ///< believed by itself, and nothing that the other maps say contradicts it
  rescued,   ///< too weak to be believed by itself, but it agrees with what the other maps say
  rejected,  ///< would be believed by itself, but contradicts what the other maps say
  known,     ///< the maps lie so because it is known beforehand, whatever they say
};

/// As outputs spell it: "refused", "accepted", "rescued", "rejected", "known".
GRIDMERGE_EXPORT const char* name_of(JoinOutcome outcome);

/// A comparison of two maps, or up the tree of two groups of maps: then said of the first map of each. Its
/// pose is the one that was used, or the best hypothesis of a join that was not; the probability is that from
/// these two maps alone.
struct Join : PairPose {
  std::size_t fixed = 0;   ///< index of the input map
  std::size_t moving = 0;  ///< index of the input map
  MatchResult match;       ///< what the two say by themselves, between the frames of these two input maps
  JoinOutcome outcome = JoinOutcome::refused;  ///< what became of it
  /// Refused, and used if MergeOptions::max_false_joins were large enough.
  bool over_budget = false;

  /// Whether the maps lie so in the result.
  bool used() const { return outcome != JoinOutcome::refused && outcome != JoinOutcome::rejected; }
  /// What became of it in the merge, whatever the two say by themselves.
  Verdict verdict() const { return used() ? Verdict::accepted : Verdict::refused; }
  /// Why it was not used; none if it was.
  Reason reason() const {
    if (used()) return Reason::none;
    if (over_budget) return Reason::over_budget;
    if (outcome == JoinOutcome::rejected) return Reason::contradicts_others;
    // Believed by itself, but so is another way to lie.
    return match.verdict == Verdict::accepted ? Reason::ambiguous : match.reason;
  }
};

/// How well a pose is known.
struct PoseDeviation {
  double position = 0.0;  ///< standard deviation of the middle of the map's known cells [m]
  double theta = 0.0;     ///< standard deviation of the direction [rad]
};

/// A map of a component.
struct Member {
  std::size_t map = 0;  ///< index of the input map
  SE2 T_component_map;  ///< takes the map's frame to the component's
  /// That the map lies where it is said to, with all that the other maps say of it. The tree does not know.
  std::optional<double> probability = {};
  /// Relative to what holds the component's frame, which has none. The tree does not know.
  std::optional<PoseDeviation> sd = {};
  /// How the map is bent or stretched, in its own frame, before the transform takes it to the component's:
  /// none unless MergeOptions::transform asks for it. It holds no rigid part, which is all in
  /// T_component_map.
  Deformation deformation = {};

  /// Where a point of the map's frame lies in the component's [m].
  Point2 to_component(const Point2& in_map) const { return T_component_map * deformation.bend(in_map); }
  /// Where a point of the component's frame lies in the map's [m]: the inverse.
  Point2 to_map(const Point2& in_component) const {
    return deformation.straighten(inverse(T_component_map) * in_component);
  }
};

/// Maps that were joined.
struct Component {
  std::vector<Member> members;  ///< ascending
  FusedMap fused;               ///< the map that they make, in the component's frame
  /// The frame is that of the first member, or, where a member's pose is fixed, the world's (see KnownPose),
  /// or a plan's (see MergeResult::plan).
  bool in_world_frame = false;
};

/// A way in which maps that lie apart may lie together, too likely to be passed over and not sure enough to
/// be taken, or one of several among which nothing decides.
struct OpenWay {
  std::size_t fixed = 0;     ///< the first map of its component, or one that was left out
  std::size_t moving = 0;    ///< likewise, apart from `fixed` and after it
  SE2 T_fixed_moving;        ///< between the frames of these two maps
  double probability = 0.0;  ///< with all that the other maps say, kMinOpenProbability or more
};

/// Ways that are less probable are not listed. One of this probability is what keeps another from 0.95, which
/// is usually asked for.
inline constexpr double kMinOpenProbability = 0.05;

/// A map that joined nothing.
struct LeftOut {
  std::size_t map = 0;                         ///< index of the input map
  Reason reason = Reason::nothing_to_compare;  ///< why it joined nothing

  /// Whether the map and the reason are the same.
  friend bool operator==(const LeftOut&, const LeftOut&) = default;
};

/// How many comparisons were refused for a reason.
struct RefusedCount {
  Reason reason = Reason::nothing_to_compare;  ///< why the two maps are not said to lie together
  std::size_t count = 0;                       ///< of comparisons

  /// Whether reason and count are the same.
  friend bool operator==(const RefusedCount&, const RefusedCount&) = default;
};

/// What a merge made of some maps before it knew of a plan, a component or a map alone, and how it lies
/// there.
struct PlanPart {
  std::vector<std::size_t> maps;  ///< indices of input maps, ascending
  /// Takes the frame of the first of them to the plan's, in metres of the maps: the best way that there is,
  /// and the identity if there is none.
  SE2 T_plan_first;
  double scale = 1.0;                          ///< by which the plan is too small if it lies so
  double probability = 0.0;                    ///< that it lies so
  Reason reason = Reason::nothing_to_compare;  ///< why it is not on the plan; none if it is

  /// Whether it hangs on the plan.
  bool on_plan() const { return reason == Reason::none; }
};

/// An architect's plan, and which maps hang on it: see place_on_plan().
struct PlanPlacement {
  std::string name;  ///< what outputs call the plan
  /// By which the plan is too small: scale * p is where a point p of the plan's frame, in the plan's own
  /// metres, lies in the frame of the component on the plan. 1 if no part is on the plan.
  double scale = 1.0;
  std::vector<PlanPart> parts;  ///< in the order of their first maps
  double resolution = 0.0;  ///< of the plan, in its own metres per cell; 0 = not said by an earlier version

  /// Indices of the input maps that hang on it, part by part.
  std::vector<std::size_t> maps_on_plan() const {
    std::vector<std::size_t> maps;
    for (const PlanPart& part : parts) {
      if (part.on_plan()) maps.insert(maps.end(), part.maps.begin(), part.maps.end());
    }
    return maps;
  }

  /// That of the surest part on the plan, which has decided the scale; 0 if there is none.
  double probability() const {
    double most = 0.0;
    for (const PlanPart& part : parts) {
      if (part.on_plan() && part.probability > most) most = part.probability;
    }
    return most;
  }
};

/// Pairs of maps that MergeOptions::max_missed has left out.
struct NotCompared {
  std::size_t pairs = 0;  ///< of maps that count: copies of a map do not
  /// How many joins of maps that lie apart these pairs may hide, by the signatures of their maps and by what
  /// was found of the pairs that were compared.
  double expected_joins = 0.0;
};

/// What a merge made of its maps.
struct MergeResult {
  std::vector<Component> components;  ///< of two or more maps each, most members first; a team's by number
  std::vector<Join> joins;            ///< every comparison made, whatever its outcome
  std::vector<LeftOut> left_out;      ///< ascending by map
  std::vector<OpenWay> open_ways;     ///< most probable first. The tree knows none
  /// How many joins are expected to be false, of all that were made. The tree does not know.
  std::optional<double> expected_false_joins = {};
  /// Refused comparisons beside `joins`, by reason. A merge has none. A saved merge of many maps keeps no
  /// more than this of most of them.
  std::vector<RefusedCount> refused_more = {};
  /// Pairs of which nothing is known; none if all pairs were compared.
  std::optional<NotCompared> not_compared = {};
  /// What place_on_plan() has found; none without a plan. All parts on the plan are one component, whose
  /// frame is the plan's (see Component::in_world_frame), if they are two maps or more.
  std::optional<PlanPlacement> plan = {};
};

/// Why one of `result.left_out` joined nothing, for people. It goes behind the map's name and a colon: "it
/// fits in more than one way".
GRIDMERGE_EXPORT const char* explain(const MergeResult& result, const LeftOut& one);

/// Why a part that is not on the plan is not, likewise: "the plan has more than one place that fits".
GRIDMERGE_EXPORT const char* explain(const PlanPart& part);

}  // namespace gridmerge
