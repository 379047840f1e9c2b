// SPDX-License-Identifier: Apache-2.0
#include "merge/plan_ways.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "match/scaled_pose.hpp"
#include "merge/candidates.hpp"
#include "merge/join_weights.hpp"

namespace gridmerge::internal {

namespace {

/// Scales that are looked at, those of the most probable hypotheses first.
constexpr std::size_t kMostScales = 20;

/// Steps of a scale towards what voices near it say, at most. Most settle after two or three.
constexpr int kScaleSteps = 5;

/// A hypothesis of a voice and the plan, where the plan has another scale: the middle of the voice stays.
SE2 at_scale(const Hypothesis& hypothesis, double scale, const Point2& middle) {
  const SE2& T = hypothesis.T_fixed_moving;
  const double ratio = scale / hypothesis.scale;
  return {middle.x - ratio * (middle.x - T.x), middle.y - ratio * (middle.y - T.y), T.theta};
}

bool is_same_scale(double a, double b) {
  return std::abs(std::log(a / b)) <= kSameScale;
}

bool is_new(double scale, const std::vector<double>& scales) {
  return std::none_of(scales.begin(), scales.end(),
                      [&](double other) { return is_same_scale(scale, other); });
}

/// What the hypotheses of the same scale as this one say on average: the mean shift of Fukunaga and Hostetler
/// (1975), with probabilities as weights, of logarithms. Members that lie on both sides of the surest of
/// them, which alone would leave some of them out, are heard together so.
double middle_scale(double scale, const std::vector<const Hypothesis*>& all) {
  for (int step = 0; step < kScaleSteps; ++step) {
    double sum = 0.0, weight = 0.0;
    for (const Hypothesis* one : all) {
      if (!is_same_scale(one->scale, scale)) continue;
      sum += one->probability * std::log(one->scale);
      weight += one->probability;
    }
    if (weight > 0.0) scale = std::exp(sum / weight);
  }
  return scale;
}

/// The distinct scales that voices propose, the most probable ones, each the middle of those near it. Each
/// hypothesis is of the same scale as one of them, unless there are more than kMostScales.
std::vector<double> scales_of(const MergePart& part) {
  std::vector<const Hypothesis*> all;
  for (const PlanVoice& voice : part.voices) {
    for (const Hypothesis& one : voice.match.hypotheses) {
      if (one.probability >= kMinCandidateProbability) all.push_back(&one);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Hypothesis* a, const Hypothesis* b) { return a->probability > b->probability; });
  std::vector<double> scales;
  for (const Hypothesis* one : all) {
    if (scales.size() == kMostScales) break;
    if (!is_new(one->scale, scales)) continue;
    const double middle = middle_scale(one->scale, all);
    const bool is_a_scale_of_its_own = is_new(middle, scales) && is_same_scale(middle, one->scale);
    scales.push_back(is_a_scale_of_its_own ? middle : one->scale);
  }
  return scales;
}

/// The plan at one scale and the voices of parts, as maps of which find_consistent_set() speaks: the plan is
/// the first.
class PlanProblem {
 public:
  PlanProblem(const PreparedMap& plan, double scale)
      : scale_(scale),
        plan_(scaled(plan.known(), scale)),
        problem_{.maps = {{plan_.extent(), &plan_}}, .pairs = {}, .is_of_a_plan = true} {}
  PlanProblem(const PlanProblem&) = delete;  // the problem points into it
  PlanProblem& operator=(const PlanProblem&) = delete;

  static NodeGroup plan() { return {{0, {}}}; }

  /// With those hypotheses of its voices whose scale is this one, as `is_of_scale` says.
  template <typename IsOfScale>
  NodeGroup add(const MergePart& part, const IsOfScale& is_of_scale) {
    NodeGroup group;
    for (const PlanVoice& voice : part.voices) {
      const std::size_t node = problem_.maps.size();
      if (voice.map) node_of_[*voice.map] = node;
      group.push_back({node, voice.T_part_voice});
      problem_.maps.push_back({voice.input->coverage.extent(), &voice.input->coverage});
      MatchResult said;
      for (const Hypothesis& one : voice.match.hypotheses) {
        if (one.probability >= kMinCandidateProbability && is_of_scale(one.scale))
          said.hypotheses.push_back(one);
      }
      said_.push_back({&voice, said.hypotheses});
      for (Hypothesis& one : said.hypotheses)
        one.T_fixed_moving = inverse(at_scale(one, scale_, voice.input->coverage.extent().centre));
      problem_.pairs.push_back({0, node, candidate_joins(said)});
    }
    return group;
  }

  /// What merge() knows of the maps of different ones of these parts.
  void add(const std::vector<Join>& joins, const std::vector<const MergePart*>& parts) {
    std::map<std::size_t, std::size_t> part_of;  // by map
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (const Member& member : parts[i]->members) part_of[member.map] = i;
    }
    for (const Join& join : joins) {
      const auto fixed = node_of_.find(join.fixed), moving = node_of_.find(join.moving);
      if (fixed == node_of_.end() || moving == node_of_.end()) continue;
      if (part_of.at(join.fixed) == part_of.at(join.moving)) continue;
      const bool in_order = fixed->second < moving->second;
      const auto [first, second] = std::minmax(fixed->second, moving->second);
      problem_.pairs.push_back({first, second, candidate_joins(in_order ? join.match : inverse(join.match))});
    }
  }

  const JoinProblem& problem() const { return problem_; }

  /// A way, put as the surest voice says that speaks for it: that of all maps as one, if it does. It is as
  /// probable as the surest of them says at most, unless maps of `hung`, which has the plan first, speak for
  /// it too: how often members of one part agree by chance on a plan that is small beside them is not known.
  PlanWay settled(const WeighedJoin& way, const NodeGroup& hung, const NodeGroup& part,
                  bool at_own_scale) const {
    const JoinWeights weights(problem_);
    PlanWay settled{way.T_a_b, scale_, way.probability, 0.0};
    NodeGroup together = hung;
    for (const PlacedNode& node : part) together.push_back({node.map, way.T_a_b * node.T_group_map});
    const auto is_of_part = [&](std::size_t map) {
      return std::any_of(part.begin(), part.end(), [&](const PlacedNode& node) { return node.map == map; });
    };
    double most = -1.0, surest = 0.0;
    bool others_agree = false;
    for (const UsedCandidate& used : weights.used_in(together)) {
      const PairCandidates& pair = problem_.pairs[used.pair];
      if (!is_of_part(pair.fixed) && !is_of_part(pair.moving)) continue;
      if (pair.fixed != 0) others_agree = true;
      if (pair.fixed != 0) continue;
      const auto& [voice, hypotheses] = said_[pair.moving - 1];
      const Hypothesis& said = hypotheses[used.candidate];
      surest = std::max(surest, said.probability);
      const double sureness = voice->map ? said.probability : 2.0;
      if (sureness <= most) continue;
      most = sureness;
      const SE2 T_plan_voice =
          at_own_scale ? inverse(said.T_fixed_moving) : pair.candidates[used.candidate].T_fixed_moving;
      settled.T_plan_part = T_plan_voice * inverse(voice->T_part_voice);
      settled.scale = at_own_scale ? said.scale : scale_;
      settled.sd = pair.candidates[used.candidate].sd;
    }
    if (!others_agree) settled.probability = std::min(settled.probability, surest);
    return settled;
  }

 private:
  struct Said {
    const PlanVoice* voice;
    std::vector<Hypothesis> hypotheses;  // in the order of the candidates that they became
  };

  double scale_;
  Coverage plan_;
  JoinProblem problem_;
  std::vector<Said> said_;                      // of the maps from 1 on
  std::map<std::size_t, std::size_t> node_of_;  // by input map
};

std::vector<WeighedJoin>::const_iterator most_probable(const std::vector<WeighedJoin>& ways) {
  return std::max_element(ways.begin(), ways.end(), [](const WeighedJoin& a, const WeighedJoin& b) {
    return a.probability < b.probability;
  });
}

}  // namespace

std::optional<PlanWay> best_way(const MergePart& part, const PreparedMap& plan) {
  const std::vector<double> scales = scales_of(part);
  const auto add_at = [&](double scale, PlanProblem& problem) {
    return problem.add(part, [&](double said) {
      const double off = std::abs(std::log(said / scale));
      return off <= kSameScale && std::none_of(scales.begin(), scales.end(), [&](double other) {
               return std::abs(std::log(said / other)) < off;
             });
    });
  };
  std::vector<WeighedJoin> ways;
  std::vector<double> scale_of_way;
  for (const double scale : scales) {
    PlanProblem problem(plan, scale);
    const NodeGroup group = add_at(scale, problem);
    const JoinWeights weights(problem.problem());
    for (const WeighedJoin& way : weights.ways_by_worth(PlanProblem::plan(), group)) {
      ways.push_back(way);
      scale_of_way.push_back(scale);
    }
  }
  if (ways.empty()) return std::nullopt;
  weigh_against_each_other(ways);
  const auto best = most_probable(ways);
  PlanProblem problem(plan, scale_of_way[static_cast<std::size_t>(best - ways.cbegin())]);
  const NodeGroup group = add_at(scale_of_way[static_cast<std::size_t>(best - ways.cbegin())], problem);
  return problem.settled(*best, PlanProblem::plan(), group, true);
}

void know_scale(MergePart& part, double scale, const ScaleRange& scales) {
  const double range = std::log(scales.most / scales.least);
  const double left = std::min(1.0, 2.0 * kSameScale / std::max(range, 2.0 * kSameScale));
  for (PlanVoice& voice : part.voices) {
    std::vector<Hypothesis>& hypotheses = voice.match.hypotheses;
    double none = 1.0;
    for (const Hypothesis& one : hypotheses) none -= one.probability;
    std::erase_if(hypotheses, [&](const Hypothesis& one) { return !is_same_scale(one.scale, scale); });
    double sum = left * std::max(none, 0.0);
    for (const Hypothesis& one : hypotheses) sum += one.probability;
    for (Hypothesis& one : hypotheses) one.probability /= std::max(sum, kMinCandidateProbability);
  }
}

std::optional<PlanWay> best_way_beside(const MergePart& part, const std::vector<HungPart>& hung, double scale,
                                       const PreparedMap& plan, const std::vector<Join>& joins) {
  PlanProblem problem(plan, scale);
  const auto any = [](double) { return true; };
  NodeGroup together = PlanProblem::plan();
  std::vector<const MergePart*> parts;
  for (const HungPart& one : hung) {
    for (const PlacedNode& node : problem.add(*one.part, any))
      together.push_back({node.map, one.T_plan_part * node.T_group_map});
    parts.push_back(one.part);
  }
  const NodeGroup group = problem.add(part, any);
  parts.push_back(&part);
  problem.add(joins, parts);
  const JoinWeights weights(problem.problem());
  const std::vector<WeighedJoin> ways = weights.ways_by_worth(together, group);
  if (ways.empty()) return std::nullopt;
  return problem.settled(*most_probable(ways), together, group, false);
}

}  // namespace gridmerge::internal
