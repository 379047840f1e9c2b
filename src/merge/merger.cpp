// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merger.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "merge/candidates.hpp"
#include "merge/group_match.hpp"
#include "merge/joins.hpp"
#include "merge/map_store.hpp"
#include "merge/pair_choice.hpp"
#include "merge/pair_looks.hpp"
#include "merge/solution.hpp"

namespace gridmerge {

using namespace internal;

namespace {

MergeOptions checked(MergeOptions options) {
  validate(options);
  options.match.progress = nullptr;
  options.match.max_hypotheses = std::max(options.match.max_hypotheses, kKeptHypotheses);
  return options;
}

/// Throws std::invalid_argument for poses that the joint solution could not weigh: it divides by deviations.
void require_weighable(const MatchResult& match) {
  constexpr double kLeast = 1e-9, kMost = 1e9;  // [m]
  for (const CandidateJoin& candidate : candidate_joins(match)) {
    if (!(candidate.sd >= kLeast && candidate.sd <= kMost))
      throw std::invalid_argument("the match holds a likely pose without a `sigma` that walls can have");
  }
}

std::unique_ptr<const MapStore::Input> prepare(OccupancyGrid map) {
  return std::make_unique<const MapStore::Input>(std::make_shared<const OccupancyGrid>(std::move(map)));
}

}  // namespace

class __attribute__((visibility("hidden"))) Merger::State {  // or it is as public as Merger
 public:
  explicit State(MergeOptions options)
      : options_(checked(std::move(options))),
        looks_(options_.match),
        groups_(options_.match),
        choice_(options_.max_missed) {}

  MapId add(std::unique_ptr<const MapStore::Input> input, const std::optional<KnownPose>& known_pose) {
    const MapId id = store_.add(std::move(input), known_pose);
    first_.reset();
    return id;
  }

  void grow(MapId id, std::shared_ptr<const OccupancyGrid> map) {
    store_.require(id);
    first_.reset();
    looks_.forget_found(id);
    choice_.outdate(id);
    store_.replace(id, std::move(map));
  }

  void search_again(MapId id) {
    store_.require(id);
    first_.reset();
    groups_.forget();
    looks_.outdate(id);
    choice_.forget(id);
  }

  void forget(MapId id) {
    search_again(id);
    looks_.forget(id);
  }

  void set_known_pose(MapId id, std::optional<KnownPose> known_pose) {
    first_.reset();
    store_.set_known_pose(id, known_pose);
  }

  void remove(MapId id) {
    forget(id);
    store_.remove(id);
  }

  bool is_complete() const { return is_complete_; }

  std::vector<MapId> ids() const { return store_.ids(); }

  const MergeOptions& options() const { return options_; }

  std::optional<KnownPose> known_pose(MapId id) const {
    store_.require(id);
    return store_.known_pose(id);
  }

  std::vector<std::string> contents() const {
    std::vector<std::string> contents;
    with_threads(options_.match.threads, [&] { contents = store_.contents_of(store_.ids()); });
    return contents;
  }

  ComparisonStore keep_comparisons(ComparisonStore store) {
    return choice_.keep_comparisons(std::move(store));
  }

  MatchOptions match_options(SearchMethod search) const { return looks_.match_options(search); }

  std::vector<DueMatch> due() {
    std::vector<DueMatch> due;
    with_threads(options_.match.threads, [&] {
      const std::vector<MapId> maps = maps_that_count();
      SearchMethod search = looks_.first_search();
      std::vector<Pair> pairs;
      if (!first_) first_ = find_first(maps, &pairs);
      if (first_ && looks_.looks_twice()) {
        search = looks_.second_search();
        pairs = looks_.due_for_a_second_look(pairs_for_a_second_look(maps, *first_));
      }
      for (const Pair& pair : pairs) due.push_back({pair.first, pair.second, search});
    });
    return due;
  }

  MatchResult make(const DueMatch& due) const {
    store_.require(due.fixed);
    store_.require(due.moving);
    return match(store_.at(due.fixed).prepared, store_.at(due.moving).prepared, match_options(due.search));
  }

  std::vector<std::pair<DueMatch, MatchResult>> matches() const { return looks_.matches(); }

  void hand_in(const DueMatch& made, MatchResult match) {
    store_.require(made.fixed);
    store_.require(made.moving);
    if (made.fixed == made.moving) throw std::invalid_argument("a map is not matched with itself");
    validate(match);
    require_weighable(match);
    looks_.hand_in({made.fixed, made.moving}, made.search, std::move(match));
    if (made.search == looks_.first_search()) first_.reset();
  }

  MergeResult solve(std::size_t most_thorough) {
    MergeResult result;
    bool are_all_looked_at = false;
    is_complete_ = false;  // whatever ends this early
    with_threads(options_.match.threads, [&] {
      const std::vector<MapId> all = store_.in_canonical_order();
      const std::vector<Copy> copies = store_.find_copies(all);
      const std::vector<MapId> maps = store_.those_that_count(all, copies);
      const Solution solution = find_best_solution(maps, most_thorough, are_all_looked_at);
      result = make_result(store_, maps, copies, looks_, solution, options_);
      result.not_compared = not_compared(maps, solution);
    });
    is_complete_ = are_all_looked_at;
    return result;
  }

 private:
  using Pair = PairLooks::Pair;

  std::vector<MapId> maps_that_count() const {
    const std::vector<MapId> all = store_.in_canonical_order();
    return store_.those_that_count(all, store_.find_copies(all));
  }

  /// What the first look says.
  struct First {
    std::vector<Pair> chosen;  // the pairs that were looked at
    Solution solution;
  };

  /// Looks at pairs as PairChoice chooses them; at all where it takes all. With `due`, makes no match: gives
  /// the first ones that are missing, and nothing else if there are any.
  std::optional<First> find_first(const std::vector<MapId>& maps, std::vector<Pair>* due) {
    First first;
    std::set<Pair> chosen;
    const bool takes_all = choice_.takes_all(maps.size());
    if (!takes_all) {
      choice_.prepare(store_, maps);
      first.solution = find_solution(maps, {}, {});
    }
    for (std::size_t round = 0;; ++round) {
      std::vector<Pair> more;
      if (takes_all) {
        more = PairLooks::choose_pairs(maps);
      } else {
        more = choice_.next(round, store_, chosen, first.solution.consistent_set);
        if (more.empty()) return first;
      }
      if (std::vector<Pair> missing = looks_.due_for_the_first_look(more); !missing.empty()) {
        if (due != nullptr) {
          *due = std::move(missing);
          return std::nullopt;
        }
        looks_.look(missing, store_, options_.progress);
      }
      chosen.insert(more.begin(), more.end());
      first.chosen.insert(first.chosen.end(), more.begin(), more.end());
      first.solution = find_solution(maps, first.chosen, {});
      if (takes_all) return first;
    }
  }

  std::vector<Pair> pairs_for_a_second_look(const std::vector<MapId>& maps, const First& first) const {
    std::vector<Pair> apart = pairs_apart(first.chosen, maps, first.solution.consistent_set);
    if (choice_.takes_all(maps.size())) return apart;
    return choice_.worth_a_second_look(apart, looks_, first.solution.consistent_set);
  }

  /// Looks at the chosen pairs quickly, and again at those whose maps that leaves apart: maps that lie in one
  /// component gain little by one more join.
  /// At most so many pairs are looked at again now; says whether that was all.
  Solution find_best_solution(const std::vector<MapId>& maps, std::size_t most_thorough,
                              bool& are_all_looked_at) {
    First first = first_ ? *std::exchange(first_, std::nullopt) : *find_first(maps, nullptr);
    are_all_looked_at = !looks_.looks_twice();
    if (are_all_looked_at) return hear_groups(maps, std::move(first.solution));
    const std::vector<Pair> apart = pairs_for_a_second_look(maps, first);
    std::vector<Pair> due = looks_.due_for_a_second_look(apart);
    are_all_looked_at = due.size() <= most_thorough;
    due.resize(std::min(due.size(), most_thorough));
    looks_.look_again(due, store_, options_.progress);
    std::set<Pair> again = looks_.seen_again(apart);
    Solution solution =
        again.empty() ? std::move(first.solution) : find_solution(maps, first.chosen, std::move(again));
    return are_all_looked_at && !apart.empty() ? hear_groups(maps, std::move(solution)) : solution;
  }

  /// What the choice of pairs has left out. A pair for which a group speaks is compared, too.
  std::optional<NotCompared> not_compared(const std::vector<MapId>& maps, const Solution& solution) const {
    if (choice_.takes_all(maps.size())) return std::nullopt;
    std::set<Pair> compared;
    for (const PairCandidates& pair : solution.problem.pairs) {
      const auto [a, b] = std::minmax(pair.fixed, pair.moving);
      compared.emplace(maps[a], maps[b]);
    }
    const NotCompared left = choice_.left(compared, solution.consistent_set);
    return left.pairs == 0 ? std::nullopt : std::optional(left);
  }

  /// Maps that still lie alone are matched with each group, as long as that places more of them.
  Solution hear_groups(const std::vector<MapId>& maps, Solution solution) {
    const std::vector<MergeInput> inputs = store_.inputs_of(maps);
    GroupMatches::WorthMeeting worth_meeting;
    if (!choice_.takes_all(maps.size()))
      worth_meeting = [&](const auto& groups, const auto& meetings) {
        return choice_.worth_meeting(groups, meetings, solution.consistent_set.used.size());
      };
    while (true) {
      JoinProblem problem = groups_.heard(solution.problem, solution.consistent_set, inputs, worth_meeting);
      ConsistentSet consistent_set =
          find_consistent_set_within(problem, options_.match.accept_probability,
                                     false_joins_allowed(options_.max_false_joins, maps.size()));
      if (count_alone(consistent_set) >= count_alone(solution.consistent_set)) return solution;
      solution.problem = std::move(problem);
      solution.consistent_set = std::move(consistent_set);
    }
  }

  static std::ptrdiff_t count_alone(const ConsistentSet& consistent_set) {
    return std::count_if(consistent_set.groups.begin(), consistent_set.groups.end(),
                         [](const NodeGroup& group) { return group.size() == 1; });
  }

  /// By the chosen pairs, with the second look at those in `again`.
  Solution find_solution(const std::vector<MapId>& maps, const std::vector<Pair>& chosen,
                         std::set<Pair> again) const {
    Solution solution{make_problem(store_, maps, chosen, looks_, again), {}, std::move(again)};
    solution.consistent_set =
        find_consistent_set_within(solution.problem, options_.match.accept_probability,
                                   false_joins_allowed(options_.max_false_joins, maps.size()));
    return solution;
  }

  MergeOptions options_;
  MapStore store_;
  PairLooks looks_;
  GroupMatches groups_;
  PairChoice choice_;
  std::optional<First> first_;  // while due() knows it
  bool is_complete_ = true;
};

Merger::Merger(MergeOptions options) : state_(std::make_unique<State>(std::move(options))) {}
Merger::~Merger() = default;
Merger::Merger(Merger&&) noexcept = default;
Merger& Merger::operator=(Merger&&) noexcept = default;

Merger::MapId Merger::add(OccupancyGrid map, std::optional<KnownPose> known_pose) {
  return state_->add(prepare(std::move(map)), known_pose);
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

const MergeOptions& Merger::options() const {
  return state_->options();
}

std::optional<KnownPose> Merger::known_pose(MapId id) const {
  return state_->known_pose(id);
}

std::vector<std::string> Merger::contents() const {
  return state_->contents();
}

ComparisonStore Merger::keep_comparisons(ComparisonStore store) {
  if (!(store.begin >= 0.0 && store.begin < 1.0))
    throw std::invalid_argument("a store of comparisons begins at a share in [0, 1)");
  if (static_cast<bool>(store.find) != static_cast<bool>(store.keep))
    throw std::invalid_argument("a store of comparisons needs both find and keep");
  return state_->keep_comparisons(std::move(store));
}

std::vector<DueMatch> Merger::due() {
  return state_->due();
}

void Merger::hand_in(const DueMatch& made, MatchResult match) {
  state_->hand_in(made, std::move(match));
}

MatchResult Merger::make(const DueMatch& due) const {
  return state_->make(due);
}

std::vector<std::pair<DueMatch, MatchResult>> Merger::matches() const {
  return state_->matches();
}

MatchOptions Merger::match_options(SearchMethod search) const {
  return state_->match_options(search);
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

Merger::Merger(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
               const std::vector<std::optional<KnownPose>>& known_poses)
    : Merger(options) {
  if (known_poses.size() > maps.size()) throw std::invalid_argument("there are more known poses than maps");
  std::vector<std::unique_ptr<const MapStore::Input>> inputs(maps.size());
  std::vector<std::string> faults(maps.size());
  with_threads(options.match.threads, [&] {
    parallel_for(maps.size(), [&](std::size_t i) {
      try {
        inputs[i] = prepare(maps[i]);
      } catch (const std::invalid_argument& error) {
        faults[i] = error.what();
      }
    });
  });
  for (std::size_t i = 0; i < maps.size(); ++i) {
    try {
      if (!inputs[i]) throw std::invalid_argument(faults[i]);
      state_->add(std::move(inputs[i]), i < known_poses.size() ? known_poses[i] : std::nullopt);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("map " + std::to_string(i) + ": " + error.what());
    }
  }
}

}  // namespace gridmerge
