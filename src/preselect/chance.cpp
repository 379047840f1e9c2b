// SPDX-License-Identifier: Apache-2.0
#include "preselect/chance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/logistic.hpp"

namespace gridmerge::internal {

namespace {

/// Logistic regression (calibration/fit_preselection.py).
// fitted: begin
constexpr std::array<double, 9> kWeights{1.541, 9.527, 0.0, -0.4243, 2.684, -1.862, 0.3186, -0.4701, -6.307};
constexpr double kBias = -10.69;
constexpr double kFittedShare = 0.002372;
constexpr double kLookBias = -5.37, kLookSignature = 0.02, kLookMatch = 2.10;
// fitted: end

double logit(double p) {
  return std::log(p / (1.0 - p));
}

}  // namespace

double log_odds_of_joining(const SignatureMatch& match, const Signature& fixed, const Signature& moving) {
  const double seen = match.seen, walls = std::min(fixed.wall_length, moving.wall_length);
  const std::array<double, kWeights.size()> terms{
      (match.met - match.chance) / std::sqrt(seen + 10.0),
      match.met / (seen + 5.0),
      match.open / (seen + 5.0),
      std::log(seen + 5.0),
      std::sqrt(match.votes),
      std::sqrt(match.next_votes),
      match.likeness,
      std::log(walls + 5.0),
      seen / (walls + 5.0),
  };
  double sum = kBias;
  for (std::size_t i = 0; i < terms.size(); ++i) sum += kWeights[i] * terms[i];
  return sum;
}

double shift_to_this_set(const std::vector<float>& log_odds) {
  if (log_odds.empty()) return 0.0;
  const double least = 0.1 / static_cast<double>(log_odds.size());  // there may always be a pair
  double share = kFittedShare, shift = 0.0;
  for (int step = 0; step < 100; ++step) {
    shift = logit(share) - logit(kFittedShare);
    double sum = 0.0;
    for (const float one : log_odds) sum += logistic(one + shift);
    const double next = std::clamp(sum / static_cast<double>(log_odds.size()), least, 0.9);
    if (std::abs(next - share) < 1e-6 * share) break;
    share = next;
  }
  return shift;
}

double log_odds_after_a_look(double log_odds, double probability) {
  const double p = std::clamp(probability, 1e-4, 0.999);
  return kLookBias + kLookSignature * log_odds + kLookMatch * logit(p);
}

}  // namespace gridmerge::internal
