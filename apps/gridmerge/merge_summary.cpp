// SPDX-License-Identifier: Apache-2.0
#include "merge_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <system_error>

#include "console.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "match/rounded_down.hpp"
#include "merge/consistent_set.hpp"
#include "merge/doubled_walls.hpp"
#include "merge/fused_windows.hpp"
#include "merge/joins.hpp"
#include "shown_command.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

/// What is asked of a pair.
const char* figure_name(const SearchOptions& search) {
  return search.random_walk() ? "acceptance index" : "probability";
}

/// Where to look for what keeps two maps apart.
std::string try_match(const AskedMerge& asked, const Join& join) {
  return fmt::format("try: {}{}   (how these two may lie, and why it is not believed)\n",
                     match_command(asked.names[join.fixed], asked.names[join.moving], asked.load),
                     asked.search.random_walk() ? " --search random-walk" : "");
}

/// What to do about maps that a merged map does without: of the first that was compared.
std::string describe_remedy(const AskedMerge& asked, const MergeResult& result) {
  std::string text;
  for (const LeftOut& one : result.left_out) {
    const Join* const likeliest = likeliest_join(one.map, result.joins);
    if (likeliest == nullptr || one.reason == Reason::nothing_to_compare) continue;
    text = try_match(asked, *likeliest);
    break;
  }
  const bool is_over_budget = std::any_of(result.joins.begin(), result.joins.end(),
                                          [](const Join& join) { return join.over_budget; });
  return is_over_budget ? text + "     a higher --max-false-joins asks for less\n" : text;
}

/// Its probability, which given poses may have made another one than the maps' own.
double likeliest_open_way(const MergeResult& result) {
  double likeliest = 0.0;
  for (const OpenWay& way : result.open_ways) likeliest = std::max(likeliest, way.probability);
  return likeliest;
}

/// The likeliest of maps that can be compared; null if there is none.
const Join* nearest_join(const MergeResult& result) {
  const Join* nearest = nullptr;
  for (const Join& join : result.joins) {
    if (join.reason() != Reason::nothing_to_compare &&
        (nearest == nullptr || join.probability > nearest->probability))
      nearest = &join;
  }
  return nearest;
}

/// The head of a result that holds no merged map. What became of known poses comes first: who gives them
/// wants them used.
std::string describe_nothing(const AskedMerge& asked, const MergeResult& result,
                             const std::string& unused_poses) {
  std::string text = fmt::format("nothing was merged: no two of the {} maps fit together surely enough\n{}",
                                 asked.names.size(), unused_poses);
  const char* const poses =
      "     --init TABLE and --fix MAP take poses that you know; the page lays maps by hand\n";
  const Join* const nearest = nearest_join(result);
  if (nearest == nullptr && !result.joins.empty()) return text + poses;  // nobody asks too much
  if (nearest != nullptr) {
    fmt::format_to(std::back_inserter(text), "nearest to it: {} and {}, {} {:.4f}{}\n",
                   escape_controls(asked.names[nearest->fixed]),
                   escape_controls(asked.names[nearest->moving]), figure_name(asked.search),
                   rounded_down(nearest->probability),
                   unused_poses.empty() ? "" : " without the given poses");
    text += try_match(asked, *nearest);
  }
  if (asked.search.up_the_tree()) return text + "     a lower --accept asks for less\n";
  text += asked.names.size() == 2 && nearest != nullptr
              ? what_asks_for_less(asked, std::max(nearest->probability, likeliest_open_way(result)),
                                   "this join alone")
              : "     a lower --accept or a higher --max-false-joins asks for less\n";
  return text + poses;
}

/// How maps that lie apart may lie together, the most probable ways.
std::string describe_open_ways(const std::vector<std::string>& names, const MergeResult& result) {
  constexpr std::size_t kMaxTold = 6;
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < std::min(result.open_ways.size(), kMaxTold); ++i) {
    const OpenWay& way = result.open_ways[i];
    fmt::format_to(out, "perhaps: {} in the frame of {} at {} (probability {:.2f})\n",
                   escape_controls(names[way.moving]), escape_controls(names[way.fixed]),
                   describe_pose(way.T_fixed_moving), rounded_down(way.probability, 2));
  }
  if (result.open_ways.size() > kMaxTold)
    fmt::format_to(out, "perhaps: {} more, see transforms.json\n", result.open_ways.size() - kMaxTold);
  return text;
}

/// A line for each join whose outcome is not what its two maps say by themselves. Of many maps most joins may
/// be such, so the first ones of each kind are told.
std::string describe_joins(const std::vector<std::string>& names, const MergeResult& result) {
  constexpr std::size_t kMaxTold = 10;
  std::map<std::string_view, std::vector<std::string>> lines;  // by kind
  const auto tell = [&](std::string_view kind, const Join& join, std::string_view why) {
    const std::string said = join.outcome == JoinOutcome::known
                                 ? std::string{}
                                 : fmt::format("{:.3f} by themselves, ", rounded_down(join.probability, 3));
    lines[kind].push_back(fmt::format("{}: {} and {}, {}{}\n", kind, escape_controls(names[join.fixed]),
                                      escape_controls(names[join.moving]), said, why));
  };
  for (const Join& join : result.joins) {
    if (join.outcome == JoinOutcome::rescued)
      tell("rescued", join, "but the other maps or known poses agree");
    if (join.over_budget) tell("over budget", join, "which --max-false-joins has no room for");
    if (join.outcome == JoinOutcome::rejected)
      tell("rejected", join, "but other maps or fixed poses contradict");
    if (join.outcome == JoinOutcome::known) tell("known", join, "from their initial poses");
  }
  std::string text;
  for (const auto& [kind, all] : lines) {
    for (std::size_t i = 0; i < std::min(all.size(), kMaxTold); ++i) text += all[i];
    if (all.size() > kMaxTold)
      text += fmt::format("{}: {} more, see transforms.json\n", kind, all.size() - kMaxTold);
  }
  return text;
}

/// How far a map's known cells are shifted at most, by some of them [m].
double most_bent(const OccupancyGrid& map, const Deformation& deformation) {
  constexpr int kLookedAt = 200;  // along a side
  const int step = std::max(1, std::max(map.width, map.height) / kLookedAt);
  double most = 0.0;
  for (int row = 0; row < map.height; row += step) {
    for (int column = 0; column < map.width; column += step) {
      if (map.at(column, row) == Cell::unknown) continue;
      const Point2 straight = map.cell_centre(column, row), bent = deformation.bend(straight);
      most = std::max(most, std::hypot(bent.x - straight.x, bent.y - straight.y));
    }
  }
  return most;
}

/// What was done to a map before it was placed; "" if nothing was.
std::string describe_change(const OccupancyGrid& map, const Deformation& deformation) {
  const std::optional<Affine> affine = deformation.affine();
  switch (deformation.kind()) {
    case MapTransform::rigid:
      break;
    case MapTransform::similarity:
      return fmt::format(", scale {:.4f}", affine->scale());
    case MapTransform::affine: {
      // By how much more it is stretched along one direction than across it (singular values).
      const double mean = std::hypot(affine->xx + affine->yy, affine->yx - affine->xy) / 2.0;
      const double apart = std::hypot(affine->xx - affine->yy, affine->yx + affine->xy) / 2.0;
      return fmt::format(", scale {:.4f} ({:.4f} to {:.4f} by direction)", affine->scale(), mean - apart,
                         mean + apart);
    }
    case MapTransform::elastic:
      return fmt::format(", bent by up to {:.1f} m", most_bent(map, deformation));
  }
  return {};
}

/// Whether --fix holds all maps of a component.
bool holds_all(const AskedMerge& asked, const Component& component) {
  return std::all_of(component.members.begin(), component.members.end(), [&](const Member& member) {
    const std::optional<KnownPose>& known = asked.known_poses[member.map];
    return known && known->fixed;
  });
}

/// What of a component the plan alone has joined.
enum class JoinedByPlan { nothing, some, all };

JoinedByPlan joined_by_plan(const MergeResult& result, const Component& component) {
  if (!result.plan) return JoinedByPlan::nothing;
  std::size_t parts = 0;
  bool is_any_joined = false;
  for (const PlanPart& part : result.plan->parts) {
    const bool is_here =
        part.on_plan() && std::any_of(component.members.begin(), component.members.end(),
                                      [&](const Member& member) { return member.map == part.maps.front(); });
    if (!is_here) continue;
    ++parts;
    is_any_joined = is_any_joined || part.maps.size() > 1;
  }
  if (parts < 2) return JoinedByPlan::nothing;
  return is_any_joined ? JoinedByPlan::some : JoinedByPlan::all;
}

/// Why no map was changed although that was asked for.
std::string explain_no_change(const AskedMerge& asked, const MergeResult& result) {
  const bool is_bending = asked.transform == MapTransform::elastic;
  if (std::all_of(result.components.begin(), result.components.end(), [&](const Component& component) {
        return joined_by_plan(result, component) == JoinedByPlan::all;
      }))
    return fmt::format("no map is {}: maps that the plan alone joins stay as they are\n",
                       is_bending ? "bent" : "stretched");
  if (std::all_of(result.components.begin(), result.components.end(),
                  [&](const Component& component) { return holds_all(asked, component); }))
    return fmt::format("no map is {}: --fix holds all of them as they are\n",
                       is_bending ? "bent" : "stretched");
  return is_bending ? "no map is bent: by what they say, bending would bring their walls no nearer\n"
                    : "no map is stretched: by what they say, scales of their own would bring their walls no "
                      "nearer\n";
}

}  // namespace

std::string what_asks_for_less(const AskedMerge& asked, double probability, const char* what) {
  const bool is_below = probability < asked.search.accept_from();
  const double doubt = 1.0 - probability;
  if (doubt <= false_joins_allowed(asked.max_false_joins, asked.names.size()))
    return is_below ? "     a lower --accept asks for less\n" : "";
  return fmt::format("     {}a higher --max-false-joins asks for less: {} is false with probability {:.3f}\n",
                     is_below ? "a lower --accept with " : "", what, doubt);
}

std::string describe_joins(const AskedMerge& asked, const MergeResult& result) {
  const std::vector<std::string>& names = asked.names;
  std::string text;
  for (const Join& join : result.joins) {
    fmt::format_to(std::back_inserter(text), "{:<8} {} {:.4f}, {:.3f} s: {} and {}\n", name_of(join.outcome),
                   figure_name(asked.search), rounded_down(join.probability), join.match.seconds,
                   escape_controls(names[join.fixed]), escape_controls(names[join.moving]));
  }
  return text;
}

namespace {

/// A merged map that does not fit in the cells of its finest map.
std::string describe_coarser(const std::vector<OccupancyGrid>& maps, const Component& component) {
  const OccupancyGrid& grid = component.fused.grid;
  double finest = grid.resolution;
  for (const Member& member : component.members) finest = std::min(finest, maps[member.map].resolution);
  if (finest == grid.resolution) return {};
  const double ratio = grid.resolution / finest, columns = ratio * grid.width, rows = ratio * grid.height;
  const LatticeLimits& limits = FusedWindows::kLimits;
  const bool is_for_geotiff = columns * rows <= limits.cells && std::max(columns, rows) <= limits.side;
  return fmt::format(
      "  in cells of {:g} m, since 2^28 of {:g} m, as those of its finest map, may not be enough{}\n",
      grid.resolution, finest, is_for_geotiff ? "; --export geotiff has these" : "");
}

}  // namespace

std::string describe_merge(const AskedMerge& asked, const std::vector<OccupancyGrid>& maps,
                           const MergeResult& result, const std::string& unused_poses) {
  const std::vector<std::string>& names = asked.names;
  // Of one map there is nothing to tell but how it lies on the plan.
  const bool is_single = names.size() == 1;
  std::string text;
  if (result.components.empty())
    text = is_single ? unused_poses : describe_nothing(asked, result, unused_poses);
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    const Component& component = result.components[i];
    fmt::format_to(out, "{}: {} of {} maps\n", component_file(i), component.members.size(), names.size());
    if (!asked.is_resolution_asked) text += describe_coarser(maps, component);
    for (const Member& member : component.members) {
      fmt::format_to(out, "  {}: {}{}\n", escape_controls(names[member.map]),
                     describe_pose(member.T_component_map),
                     describe_change(maps[member.map], member.deformation));
    }
  }
  if (asked.transform != MapTransform::rigid && !result.components.empty() && !is_any_bent(result))
    text += explain_no_change(asked, result);
  if (result.expected_false_joins && !result.components.empty())
    fmt::format_to(out, "of these joins, {:.3f} are expected to be false\n", *result.expected_false_joins);
  if (result.not_compared)
    fmt::format_to(out, "not compared: {} pairs, which may hide {:.1f} more joins (--max-missed)\n",
                   result.not_compared->pairs, result.not_compared->expected_joins);
  for (const LeftOut& one : result.left_out) {
    if (!is_single)
      fmt::format_to(out, "left out: {}: {}\n", escape_controls(names[one.map]), explain(result, one));
  }
  if (!result.components.empty()) text += describe_remedy(asked, result);
  text += describe_open_ways(names, result);
  text += describe_joins(names, result);
  if (!result.components.empty()) text += unused_poses;
  return text;
}

namespace {

std::string what_may_help(MapTransform asked, JoinedByPlan by_plan, bool rests_on_initial_poses) {
  std::string help = rests_on_initial_poses ? "; an initial pose may be wrong, or" : ";";
  help += " --elastic bends maps so that they fit better";
  if (asked == MapTransform::rigid) help += ", and --transform similarity mends a false scale";
  if (by_plan == JoinedByPlan::some) help += ", but not maps that the plan alone joins";
  return help;
}

/// Whether maps of the component lie together by their initial poses alone.
bool rests_on_initial_poses(const Component& component, const MergeResult& result) {
  const auto is_member = [&](std::size_t map) {
    return std::any_of(component.members.begin(), component.members.end(),
                       [&](const Member& member) { return member.map == map; });
  };
  return std::any_of(result.joins.begin(), result.joins.end(), [&](const Join& join) {
    return join.outcome == JoinOutcome::known && is_member(join.fixed);
  });
}

}  // namespace

std::string describe_doubled(const AskedMerge& asked, const std::vector<OccupancyGrid>& maps,
                             const MergeResult& result, bool is_asked_for) {
  if (asked.search.up_the_tree()) return {};
  std::string text;
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    const double share = measure_doubled_walls(maps, result.components[i]).share();
    const JoinedByPlan by_plan = joined_by_plan(result, result.components[i]);
    const bool may_help = asked.transform != MapTransform::elastic && share >= kManyDoubled &&
                          by_plan != JoinedByPlan::all && !holds_all(asked, result.components[i]);
    if (!may_help && !is_asked_for) continue;
    const bool is_given = rests_on_initial_poses(result.components[i], result);
    fmt::format_to(std::back_inserter(text), "{}: {:.1f} % of the walls that several maps saw lie double{}\n",
                   component_file(i), 100.0 * share,
                   may_help ? what_may_help(asked.transform, by_plan, is_given) : "");
  }
  return text;
}

}  // namespace gridmerge::cli
