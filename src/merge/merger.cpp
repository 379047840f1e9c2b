// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merger.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "candidates.hpp"
#include "component.hpp"
#include "gridmerge/grid/parallel.hpp"
#include "gridmerge/match/prepared_map.hpp"
#include "gridmerge/merge/arrangement.hpp"
#include "gridmerge/merge/coverage.hpp"
#include "joins.hpp"
#include "prior.hpp"

namespace gridmerge {

namespace {

/// A map with all that does not depend on the others.
struct Input {
  explicit Input(std::shared_ptr<const OccupancyGrid> map)
      : grid(std::move(map)), prepared(*grid), coverage(prepared.known()) {}

  std::shared_ptr<const OccupancyGrid> grid;
  PreparedMap prepared;
  Coverage coverage;
};

JoinOutcome outcome_of(const MatchResult& match, bool is_used) {
  if (match.verdict == Verdict::accepted) return is_used ? JoinOutcome::accepted : JoinOutcome::rejected;
  return is_used ? JoinOutcome::rescued : JoinOutcome::refused;
}

}  // namespace

class Merger::State {
 public:
  explicit State(MergeOptions options) : options_(std::move(options)) {
    validate(options_.match);
    validate_merge({}, options_.resolution);
    options_.match.progress = nullptr;
    options_.match.guesses.clear();
    options_.match.max_hypotheses = std::max(options_.match.max_hypotheses, kKeptHypotheses);
  }

  MapId add(std::shared_ptr<const OccupancyGrid> map, std::optional<KnownPose> known_pose) {
    if (known_pose) validate_known_pose(*known_pose);
    inputs_.emplace(next_, std::move(map));  // throws for an invalid map
    if (known_pose) known_poses_[next_] = *known_pose;
    return next_++;
  }

  void update(MapId id, std::shared_ptr<const OccupancyGrid> map) {
    require(id);
    Input changed(std::move(map));
    forget(id);
    inputs_.erase(id);
    inputs_.emplace(id, changed.grid);
  }

  void set_known_pose(MapId id, std::optional<KnownPose> known_pose) {
    require(id);
    if (known_pose) validate_known_pose(*known_pose);
    known_poses_.erase(id);
    if (known_pose) known_poses_[id] = *known_pose;
  }

  void remove(MapId id) {
    require(id);
    forget(id);
    inputs_.erase(id);
    known_poses_.erase(id);
  }

  std::vector<MapId> ids() const {
    std::vector<MapId> ids;
    for (const auto& [id, input] : inputs_) ids.push_back(id);
    return ids;
  }

  MergeResult result() {
    MergeResult result;
    with_threads(options_.match.threads, [&] {
      match_new_pairs();
      const ArrangementProblem problem = make_problem();
      const Arrangement arrangement = arrange(problem, options_.match.accept_probability);
      result.joins = make_joins(problem, arrangement);
      add_components(problem, arrangement, result);
    });
    return result;
  }

 private:
  using Pair = std::pair<MapId, MapId>;  // the lower id first

  void require(MapId id) const {
    if (!inputs_.contains(id)) throw std::out_of_range("there is no map " + std::to_string(id));
  }

  void forget(MapId id) {
    std::erase_if(matches_,
                  [&](const auto& match) { return match.first.first == id || match.first.second == id; });
  }

  void match_new_pairs() {
    std::vector<Pair> pairs;
    for (auto a = inputs_.begin(); a != inputs_.end(); ++a) {
      for (auto b = std::next(a); b != inputs_.end(); ++b) {
        const Pair pair{a->first, b->first};
        if (!matches_.contains(pair)) pairs.push_back(pair);
      }
    }
    std::vector<MatchResult> results(pairs.size());
    std::mutex reporting;
    std::size_t done = 0;
    parallel_for(pairs.size(), [&](std::size_t i) {
      const auto [a, b] = pairs[i];
      results[i] = match(inputs_.at(a).prepared, inputs_.at(b).prepared, options_.match);
      const std::lock_guard lock(reporting);
      ++done;
      if (options_.progress) options_.progress(done, pairs.size());
    });
    for (std::size_t i = 0; i < pairs.size(); ++i) matches_[pairs[i]] = std::move(results[i]);
  }

  std::vector<std::optional<KnownPose>> known_poses() const {
    std::vector<std::optional<KnownPose>> poses;
    for (const auto& [id, input] : inputs_) {
      const auto known = known_poses_.find(id);
      poses.push_back(known == known_poses_.end() ? std::nullopt : std::optional(known->second));
    }
    return poses;
  }

  ArrangementProblem make_problem() const {
    ArrangementProblem problem;
    for (const auto& [id, input] : inputs_) {
      problem.coverage.push_back(&input.coverage);
      problem.maps.push_back(input.coverage.extent());
    }
    const std::vector<MapId> by_place = ids();
    const std::vector<std::optional<KnownPose>> known = known_poses();
    for (std::size_t a = 0; a < by_place.size(); ++a) {
      for (std::size_t b = a + 1; b < by_place.size(); ++b) {
        PairCandidates pair{a, b, candidate_joins(matches_.at({by_place[a], by_place[b]}))};
        if (known[a] && known[b])
          apply_known_poses(*known[a], *known[b], problem.maps[a], problem.maps[b], pair);
        problem.pairs.push_back(std::move(pair));
      }
    }
    return problem;
  }

  std::vector<Join> make_joins(const ArrangementProblem& problem, const Arrangement& arrangement) const {
    const std::vector<MapId> by_place = ids();
    std::vector<Join> joins;
    for (const PairCandidates& pair : problem.pairs) {
      Join join =
          make_join(pair.fixed, pair.moving, matches_.at({by_place[pair.fixed], by_place[pair.moving]}));
      join.outcome = outcome_of(join.match, false);
      joins.push_back(std::move(join));
    }
    for (const UsedCandidate& used : arrangement.used) {
      Join& join = joins[used.pair];
      join.T_fixed_moving = problem.pairs[used.pair].candidates[used.candidate].T_fixed_moving;
      bool is_best = join.T_fixed_moving == join.match.T_fixed_moving;
      join.outcome = is_best ? outcome_of(join.match, true) : JoinOutcome::rescued;
      join.probability = 0.0;  // of what is known beforehand the maps say nothing
      for (const Hypothesis& hypothesis : join.match.hypotheses) {
        if (hypothesis.T_fixed_moving == join.T_fixed_moving) join.probability = hypothesis.probability;
      }
    }
    return joins;
  }

  void add_components(const ArrangementProblem& problem, const Arrangement& arrangement,
                      MergeResult& result) const {
    std::vector<const OccupancyGrid*> grids;
    std::vector<const PreparedMap*> prepared;
    for (const auto& [id, input] : inputs_) {
      grids.push_back(input.grid.get());
      prepared.push_back(&input.prepared);
    }
    const std::vector<std::optional<KnownPose>> known = known_poses();
    for (const NodeGroup& group : arrangement.groups) {
      if (group.size() == 1) {
        result.left_out.push_back(group.front().map);
        result.left_out_reasons.push_back(why_left_out(result.joins, group.front().map));
      } else {
        result.components.push_back(
            make_component(group, problem, arrangement, grids, prepared, known, options_.resolution));
      }
    }
    std::stable_sort(
        result.components.begin(), result.components.end(),
        [](const Component& a, const Component& b) { return a.members.size() > b.members.size(); });
  }

  MergeOptions options_;
  MapId next_ = 0;
  std::map<MapId, Input> inputs_;
  std::map<MapId, KnownPose> known_poses_;
  std::map<Pair, MatchResult> matches_;
};

Merger::Merger(MergeOptions options) : state_(std::make_unique<State>(std::move(options))) {}
Merger::~Merger() = default;
Merger::Merger(Merger&&) noexcept = default;
Merger& Merger::operator=(Merger&&) noexcept = default;

Merger::MapId Merger::add(OccupancyGrid map, std::optional<KnownPose> known_pose) {
  return state_->add(std::make_shared<const OccupancyGrid>(std::move(map)), known_pose);
}

void Merger::update(MapId id, OccupancyGrid map) {
  state_->update(id, std::make_shared<const OccupancyGrid>(std::move(map)));
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

MergeResult Merger::result() {
  return state_->result();
}

MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                  const std::vector<std::optional<KnownPose>>& known_poses) {
  validate_merge(maps, options.resolution);
  if (known_poses.size() > maps.size()) throw std::invalid_argument("there are more known poses than maps");
  Merger merger(options);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::optional<KnownPose> known = i < known_poses.size() ? known_poses[i] : std::nullopt;
    try {
      merger.add(maps[i], known);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("map " + std::to_string(i) + ": " + error.what());
    }
  }
  return merger.result();
}

}  // namespace gridmerge
