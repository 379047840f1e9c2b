// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "verdict_model.hpp"

namespace gridmerge {

double find_lead(const std::vector<double>& scores) {
  if (scores.empty() || scores[0] <= 0.0) return 0.0;
  const double second = scores.size() > 1 ? std::max(0.0, scores[1]) : 0.0;
  return (scores[0] - second) / std::sqrt(scores[0]);
}

double probability_of(const VerdictFeatures& features) {
  const auto logistic = [](double logit) { return 1.0 / (1.0 + std::exp(-logit)); };
  // What the fitted model cannot know, because simulated cases hold too little of it: of two hypotheses that
  // fit, the better one is the true one with a probability that starts at a half, and a lead counts in units
  // of what chance moves a score by; and maps that agree on the two walls of a corner, or the four of a plain
  // room, fit every corner and every room, however clean and long the walls.
  const double best_of_two = logistic(features.lead);
  const double tells_places_apart = logistic(3.0 * (features.wall_lines - 3.5));
  return logistic(verdict_logit(features)) * best_of_two * tells_places_apart;
}

double probability_among(const VerdictFeatures& features, double best, double next) {
  VerdictFeatures among = features;
  among.lead = find_lead({best, next});
  return probability_of(among);
}

Reason explain_refusal(const VerdictFeatures& features, double accept_probability) {
  if (probability_of(features) >= accept_probability) return Reason::none;
  // What a pair beyond doubt has.
  const auto would_do = [&](void (*mend)(VerdictFeatures&)) {
    VerdictFeatures better = features;
    mend(better);
    return probability_of(better) >= accept_probability;
  };
  if (would_do([](VerdictFeatures& f) { f.lead = std::max(f.lead, 30.0); })) return Reason::ambiguous;
  if (would_do([](VerdictFeatures& f) {
        f.walls_met = std::max(f.walls_met, 0.95);
        f.walls_met_locally = std::max(f.walls_met_locally, 0.95);
      }))
    return Reason::contradiction;
  if (would_do([](VerdictFeatures& f) { f.wall_lines = std::max(f.wall_lines, 10.0); }))
    return Reason::too_little_overlap;
  return Reason::several;
}

const char* name_of(Verdict verdict) {
  return verdict == Verdict::accepted ? "accepted" : "refused";
}

const char* name_of(Reason reason) {
  switch (reason) {
    case Reason::nothing_to_compare:
      return "nothing_to_compare";
    case Reason::ambiguous:
      return "ambiguous";
    case Reason::contradiction:
      return "contradiction";
    case Reason::too_little_overlap:
      return "too_little_overlap";
    case Reason::several:
      return "several";
    case Reason::contradicts_others:
      return "contradicts_others";
    case Reason::none:
      break;
  }
  return "none";
}

}  // namespace gridmerge
