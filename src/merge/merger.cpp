// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/match/prepared_map.hpp"
#include "merge/arrangement.hpp"
#include "merge/candidates.hpp"
#include "merge/component.hpp"
#include "merge/copies.hpp"
#include "merge/coverage.hpp"
#include "merge/group_match.hpp"
#include "merge/joins.hpp"
#include "merge/pair_matches.hpp"
#include "merge/prior.hpp"
#include "similarity/agreement.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// A map with all that does not depend on the others.
struct Input {
  explicit Input(std::shared_ptr<const OccupancyGrid> map)
      : grid(std::move(map)), prepared(*grid), coverage(prepared.known()) {
    // What somebody painted black would hide what others have seen there.
    if (is_mostly_painted(*grid)) grid = std::make_shared<const OccupancyGrid>(without_painted(*grid));
  }

  std::shared_ptr<const OccupancyGrid> grid;
  PreparedMap prepared;
  Coverage coverage;
};

/// The figures of a join whose pose is not the pair's best hypothesis.
void count_common(const PreparedMap& fixed, const PreparedMap& moving, Join& join) {
  // As match() does it, so that they do not depend on which map is called fixed.
  const bool swapped = is_smaller(fixed, moving);
  const OccupancyGrid &larger = (swapped ? moving : fixed).known(),
                      &smaller = (swapped ? fixed : moving).known();
  const AgreementCounts counts =
      count_agreement(larger, smaller, swapped ? inverse(join.T_fixed_moving) : join.T_fixed_moving);
  join.acceptance_index = counts.acceptance_index();
  join.agreement = counts.agreement;
  join.disagreement = counts.disagreement;
  join.overlap = measure_overlap(larger, smaller, counts);
}

}  // namespace

class __attribute__((visibility("hidden"))) Merger::State {  // or it is as public as Merger
 public:
  explicit State(MergeOptions options) : options_(std::move(options)), groups_(options_.match) {
    validate(options_.match);
    if (options_.match.search == SearchMethod::random_walk)
      throw std::invalid_argument(
          "joint merging needs several hypotheses for each pair, with probabilities: a random walk has none "
          "(merge_up_tree() takes it)");
    validate_merge({}, options_.resolution);
    if (!(options_.max_false_joins >= 0.0) || !std::isfinite(options_.max_false_joins))
      throw std::invalid_argument("max_false_joins must be a number from 0 on");
    options_.match.progress = nullptr;
    options_.match.max_hypotheses = std::max(options_.match.max_hypotheses, kKeptHypotheses);
  }

  MapId add(std::shared_ptr<const OccupancyGrid> map, std::optional<KnownPose> known_pose) {
    if (known_pose) validate(*known_pose);
    auto input = std::make_unique<const Input>(std::move(map));  // throws for an invalid map
    const MapId id = next_++;
    inputs_.emplace(id, std::move(input));
    if (known_pose) known_poses_[id] = *known_pose;
    return id;
  }

  void grow(MapId id, std::shared_ptr<const OccupancyGrid> map) {
    require(id);
    inputs_.at(id) = std::make_unique<const Input>(std::move(map));
  }

  void search_again(MapId id) {
    require(id);
    groups_.forget();
    quick_.outdate(id);
    thorough_.outdate(id);
  }

  void forget(MapId id) {
    search_again(id);
    quick_.forget(id);
    thorough_.forget(id);
  }

  void set_known_pose(MapId id, std::optional<KnownPose> known_pose) {
    require(id);
    if (known_pose) validate(*known_pose);
    known_poses_.erase(id);
    if (known_pose) known_poses_[id] = *known_pose;
  }

  void remove(MapId id) {
    forget(id);
    inputs_.erase(id);
    known_poses_.erase(id);
  }

  bool is_complete() const { return is_complete_; }

  std::vector<MapId> ids() const {
    std::vector<MapId> ids;
    for (const auto& [id, input] : inputs_) ids.push_back(id);
    return ids;
  }

  MergeResult solve(std::size_t most_thorough) {
    MergeResult result;
    with_threads(options_.match.threads, [&] {
      const std::vector<MapId> all = in_canonical_order();
      const std::vector<Copy> copies = find_copies(all);
      const std::vector<MapId> maps = those_that_count(all, copies);
      const auto [problem, arrangement, again] = arrange_all(maps, most_thorough);
      result.expected_false_joins = expected_false_joins(arrangement);
      result.joins = make_joins(maps, problem, arrangement, again);
      result.open_ways = make_open_ways(places_of(maps), problem, arrangement);
      add_components(maps, problem, arrangement, result);
      std::vector<const OccupancyGrid*> grids;
      for (const auto& [id, input] : inputs_) grids.push_back(input->grid.get());
      add_copies(copies, grids, options_.resolution, result);
      sort_components(result);
    });
    return result;
  }

 private:
  using Pair = PairMatches::Pair;

  struct Solution {
    ArrangementProblem problem;
    Arrangement arrangement;
    std::set<Pair> again;  // pairs that were looked at a second time: the lower id and the higher one
  };

  /// Looks at every pair quickly, and again at those whose maps that leaves apart: maps that lie in one
  /// component gain little by one more join. What a pair's match is depends on the maps alone, not on when
  /// they came.
  /// At most so many pairs are looked at again now: is_complete_ says whether that was all.
  Solution arrange_all(const std::vector<MapId>& maps, std::size_t most_thorough) {
    is_complete_ = true;
    const bool looks_twice = options_.match.search == SearchMethod::exhaustive;
    look(quick_, all_pairs(maps), looks_twice ? SearchMethod::quick : options_.match.search);
    Solution solution = arrange(maps, {});
    if (!looks_twice) return solution;
    const std::vector<Pair> apart = pairs_apart(maps, solution.arrangement);
    std::vector<Pair> due = due_for_a_second_look(apart);
    is_complete_ = due.size() <= most_thorough;
    due.resize(std::min(due.size(), most_thorough));
    look(thorough_, std::move(due), SearchMethod::exhaustive);
    std::set<Pair> again;
    for (const Pair& pair : apart) {
      if (thorough_.holds(pair.first, pair.second)) again.insert(std::minmax(pair.first, pair.second));
    }
    if (!again.empty()) solution = arrange(maps, std::move(again));
    return is_complete_ && !apart.empty() ? hear_groups(maps, std::move(solution)) : solution;
  }

  /// Those of the pairs whose second look is missing or outdated: first those that had none, then those of
  /// which the first look thinks most.
  std::vector<Pair> due_for_a_second_look(std::vector<Pair> pairs) const {
    std::erase_if(pairs, [&](const Pair& pair) { return thorough_.is_up_to_date(pair.first, pair.second); });
    std::stable_sort(pairs.begin(), pairs.end(), [&](const Pair& a, const Pair& b) {
      const auto key = [&](const Pair& pair) {
        return std::pair(thorough_.holds(pair.first, pair.second),
                         -quick_.between(pair.first, pair.second).probability);
      };
      return key(a) < key(b);
    });
    return pairs;
  }

  /// Maps that still lie alone are matched with each group, as long as that places more of them.
  Solution hear_groups(const std::vector<MapId>& maps, Solution solution) {
    const MergeInputs inputs = inputs_of(maps);
    while (true) {
      ArrangementProblem problem = groups_.heard(solution.problem, solution.arrangement, inputs);
      Arrangement arrangement =
          arrange_within(problem, options_.match.accept_probability, options_.max_false_joins);
      if (count_alone(arrangement) >= count_alone(solution.arrangement)) return solution;
      solution.problem = std::move(problem);
      solution.arrangement = std::move(arrangement);
    }
  }

  static std::ptrdiff_t count_alone(const Arrangement& arrangement) {
    return std::count_if(arrangement.groups.begin(), arrangement.groups.end(),
                         [](const NodeGroup& group) { return group.size() == 1; });
  }

  /// With the second look at the pairs in `again`.
  Solution arrange(const std::vector<MapId>& maps, std::set<Pair> again) const {
    Solution solution{make_problem(maps, again), {}, std::move(again)};
    solution.arrangement =
        arrange_within(solution.problem, options_.match.accept_probability, options_.max_false_joins);
    return solution;
  }

  void require(MapId id) const {
    if (!inputs_.contains(id)) throw std::out_of_range("there is no map " + std::to_string(id));
  }

  /// An order that depends on the maps alone, so that sums are made in the same order whatever order they
  /// came in.
  std::vector<MapId> in_canonical_order() const {
    std::vector<MapId> maps = ids();
    std::stable_sort(maps.begin(), maps.end(), [&](MapId a, MapId b) {
      return is_smaller(inputs_.at(a)->prepared, inputs_.at(b)->prepared);
    });
    return maps;
  }

  /// The first of several equal maps is the one that counts. What is known of a pose tells maps apart.
  /// In canonical order equal ones follow each other.
  std::vector<Copy> find_copies(const std::vector<MapId>& maps) const {
    const std::vector<std::size_t> index = places_of(maps);
    std::vector<Copy> copies;
    std::size_t original = 0;
    for (std::size_t i = 1; i < maps.size(); ++i) {
      const PreparedMap &first = inputs_.at(maps[original])->prepared, &next = inputs_.at(maps[i])->prepared;
      if (known_poses_.contains(maps[i]) || !is_copy(first, next)) {
        original = i;
      } else {
        copies.push_back({index[i], index[original], between_copies(first, next)});
      }
    }
    return copies;
  }

  std::vector<MapId> those_that_count(std::vector<MapId> maps, const std::vector<Copy>& copies) const {
    const std::vector<MapId> order = ids();
    std::erase_if(maps, [&](MapId id) {
      return std::any_of(copies.begin(), copies.end(),
                         [&](const Copy& copy) { return order[copy.map] == id; });
    });
    return maps;
  }

  static std::vector<Pair> all_pairs(const std::vector<MapId>& maps) {
    std::vector<Pair> pairs;
    for (auto a = maps.begin(); a != maps.end(); ++a) {
      for (auto b = std::next(a); b != maps.end(); ++b) pairs.emplace_back(*a, *b);
    }
    return pairs;
  }

  /// The pairs of maps that lie in no common group.
  static std::vector<Pair> pairs_apart(const std::vector<MapId>& maps, const Arrangement& arrangement) {
    std::vector<std::size_t> group_of(maps.size());
    for (std::size_t i = 0; i < arrangement.groups.size(); ++i) {
      for (const PlacedNode& node : arrangement.groups[i]) group_of[node.map] = i;
    }
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < maps.size(); ++a) {
      for (std::size_t b = a + 1; b < maps.size(); ++b) {
        if (group_of[a] != group_of[b]) pairs.emplace_back(maps[a], maps[b]);
      }
    }
    return pairs;
  }

  void look(PairMatches& matches, std::vector<Pair> pairs, SearchMethod search) {
    MatchOptions options = options_.match;
    options.search = search;
    const auto find = [&](MapId id) -> const PreparedMap& { return inputs_.at(id)->prepared; };
    matches.add(std::move(pairs), find, options, options_.progress);
  }

  /// By the last look at the pair.
  MatchResult match_between(MapId fixed, MapId moving, const std::set<Pair>& again) const {
    return (again.contains(std::minmax(fixed, moving)) ? thorough_ : quick_).between(fixed, moving);
  }

  std::optional<KnownPose> known_pose(MapId id) const {
    const auto known = known_poses_.find(id);
    return known == known_poses_.end() ? std::nullopt : std::optional(known->second);
  }

  ArrangementProblem make_problem(const std::vector<MapId>& maps, const std::set<Pair>& again) const {
    ArrangementProblem problem;
    for (const MapId id : maps) {
      problem.coverage.push_back(&inputs_.at(id)->coverage);
      problem.maps.push_back(inputs_.at(id)->coverage.extent());
      const std::optional<KnownPose> known = known_pose(id);
      problem.fixed.push_back(known && known->fixed ? std::optional(known->T_world_map) : std::nullopt);
    }
    for (std::size_t a = 0; a < maps.size(); ++a) {
      for (std::size_t b = a + 1; b < maps.size(); ++b) {
        PairCandidates pair{a, b, candidate_joins(match_between(maps[a], maps[b], again))};
        const std::optional<KnownPose> of_a = known_pose(maps[a]), of_b = known_pose(maps[b]);
        if (of_a && of_b && !(of_a->fixed && of_b->fixed))
          apply_known_poses(*of_a, *of_b, problem.maps[a], problem.maps[b], pair);
        problem.pairs.push_back(std::move(pair));
      }
    }
    return problem;
  }

  /// In the order in which the maps were added.
  std::vector<Join> make_joins(const std::vector<MapId>& maps, const ArrangementProblem& problem,
                               const Arrangement& arrangement, const std::set<Pair>& again) const {
    std::map<std::size_t, std::size_t> used;  // candidate by pair
    for (const UsedCandidate& one : arrangement.used) used[one.pair] = one.candidate;
    std::vector<bool> is_placed(maps.size());
    for (const NodeGroup& group : arrangement.groups) {
      for (const PlacedNode& node : group) is_placed[node.map] = group.size() > 1;
    }
    const std::vector<std::size_t> index = places_of(maps);
    std::vector<Join> joins;
    for (std::size_t i = 0; i < problem.pairs.size(); ++i) {
      const PairCandidates& pair = problem.pairs[i];
      const MatchResult match = match_between(maps[pair.fixed], maps[pair.moving], again);
      const CandidateJoin* candidate = used.contains(i) ? &pair.candidates[used.at(i)] : nullptr;
      const bool is_in_company = is_placed[pair.fixed] || is_placed[pair.moving];
      Join join = make_join(index[pair.fixed], index[pair.moving], match, {candidate, is_in_company});
      if (join.T_fixed_moving != match.T_fixed_moving || match.hypotheses.empty())
        count_common(inputs_.at(maps[pair.fixed])->prepared, inputs_.at(maps[pair.moving])->prepared, join);
      joins.push_back(join.fixed < join.moving ? std::move(join) : inverted(join));
    }
    std::sort(joins.begin(), joins.end(), [](const Join& a, const Join& b) {
      return std::pair(a.fixed, a.moving) < std::pair(b.fixed, b.moving);
    });
    return joins;
  }

  /// Where each of these maps stands among all in the order in which they were added.
  std::vector<std::size_t> places_of(const std::vector<MapId>& maps) const {
    const std::vector<MapId> order = ids();
    std::vector<std::size_t> places;
    places.reserve(maps.size());
    for (const MapId id : maps)
      places.push_back(
          static_cast<std::size_t>(std::lower_bound(order.begin(), order.end(), id) - order.begin()));
    return places;
  }

  MergeInputs inputs_of(const std::vector<MapId>& maps) const {
    MergeInputs inputs;
    inputs.index = places_of(maps);
    for (const MapId id : maps) {
      inputs.grids.push_back(inputs_.at(id)->grid.get());
      inputs.prepared.push_back(&inputs_.at(id)->prepared);
      inputs.known_poses.push_back(known_pose(id));
    }
    return inputs;
  }

  void add_components(const std::vector<MapId>& maps, const ArrangementProblem& problem,
                      const Arrangement& arrangement, MergeResult& result) const {
    const MergeInputs inputs = inputs_of(maps);
    for (const NodeGroup& group : arrangement.groups) {
      if (group.size() == 1) {
        result.left_out.push_back(inputs.index[group.front().map]);
      } else {
        result.components.push_back(make_component(group, problem, arrangement, inputs, options_));
      }
    }
    std::sort(result.left_out.begin(), result.left_out.end());
    for (const std::size_t map : result.left_out)
      result.left_out_reasons.push_back(why_left_out(result.joins, map));
  }

  static void sort_components(MergeResult& result) {
    std::sort(result.components.begin(), result.components.end(), [](const Component& a, const Component& b) {
      const auto key = [](const Component& c) {
        return std::pair(-std::ssize(c.members), c.members.front().map);
      };
      return key(a) < key(b);
    });
  }

  MergeOptions options_;
  MapId next_ = 0;
  std::map<MapId, std::unique_ptr<const Input>> inputs_;
  std::map<MapId, KnownPose> known_poses_;
  PairMatches quick_;     // of the first look
  PairMatches thorough_;  // of the second look
  GroupMatches groups_;
  bool is_complete_ = true;
};

Merger::Merger(MergeOptions options) : state_(std::make_unique<State>(std::move(options))) {}
Merger::~Merger() = default;
Merger::Merger(Merger&&) noexcept = default;
Merger& Merger::operator=(Merger&&) noexcept = default;

Merger::MapId Merger::add(OccupancyGrid map, std::optional<KnownPose> known_pose) {
  return state_->add(std::make_shared<const OccupancyGrid>(std::move(map)), known_pose);
}

void Merger::update(MapId id, OccupancyGrid map) {
  grow(id, std::move(map));
  state_->forget(id);
}

void Merger::grow(MapId id, OccupancyGrid map) {
  state_->grow(id, std::make_shared<const OccupancyGrid>(std::move(map)));
}

void Merger::search_again(MapId id) {
  state_->search_again(id);
}

void Merger::set_known_pose(MapId id, std::optional<KnownPose> known_pose) {
  state_->set_known_pose(id, known_pose);
}

void Merger::remove(MapId id) {
  state_->remove(id);
}

std::vector<Merger::MapId> Merger::maps() const {
  return state_->ids();
}

MergeResult Merger::solve() {
  return state_->solve(std::numeric_limits<std::size_t>::max());
}

MergeResult Merger::solve_soon(std::size_t most_thorough) {
  return state_->solve(most_thorough);
}

bool Merger::is_complete() const {
  return state_->is_complete();
}

}  // namespace gridmerge
