// SPDX-License-Identifier: Apache-2.0
#include "match/scaled_verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "match/hypotheses.hpp"
#include "match/scaled_verdict_model.hpp"

namespace gridmerge::internal {

namespace {

using F = PoseFigures;

/// So many levels the model was fitted to: those of 0.5:2.
constexpr double kFittedLevels = 48.0;

constexpr std::array kRankTerms{
    RankTerm{"evidence", "ln(score)", [](const F& f) { return std::log(std::max(f.score, 1.0)); }},
    RankTerm{"seen", "ln(seen_walls)", [](const F& f) { return std::log(std::max(f.seen_walls, 1.0)); }},
    RankTerm{"lines", "ln(wall_lines + 0.5)", [](const F& f) { return std::log(f.wall_lines + 0.5); }}};
static_assert(kRankTerms.size() == kScaledRankWeights.size(), "each term has its weight");

constexpr std::array kTerms{
    VerdictTerm{"tells apart", "ln(wall_lines + 0.5)", TermKind::amount, 0.0, 3.0,
                [](const F& f) { return std::log(f.wall_lines + 0.5); }},
    VerdictTerm{"held", "ln(held / held_most)", TermKind::amount, -3.5, 0.0, how_held},
    VerdictTerm{"stands out", "stands_out", TermKind::rivals, 0.0, 6.0,
                [](const F& f) { return f.stands_out; }},
    VerdictTerm{"met locally", "-ln(1.05 - walls_met_locally)", TermKind::quality, 0.0, 2.5,
                [](const F& f) { return missing(f.walls_met_locally, 0.05); }}};
static_assert(kTerms.size() == kScaledWeights.size(), "each term has its weight");

}  // namespace

VerdictModel scaled_model(std::size_t levels) {
  const double freedom = std::max(0.0, std::log(static_cast<double>(levels) / kFittedLevels));
  return {kRankTerms, kScaledRankWeights, kTerms, kScaledWeights, kScaledBias - freedom, true};
}

void weigh_scaled(std::vector<Hypothesis>& hypotheses, std::size_t levels,
                  const std::function<bool(const Hypothesis&, const Hypothesis&)>& are_near) {
  const VerdictModel model = scaled_model(levels);
  std::vector<PoseFigures> figures = figures_of(hypotheses);
  compare_rivals(
      figures, [&](std::size_t a, std::size_t b) { return are_near(hypotheses[a], hypotheses[b]); }, model);
  weigh_by(model, figures, hypotheses);
}

}  // namespace gridmerge::internal
