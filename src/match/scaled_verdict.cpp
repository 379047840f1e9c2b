// SPDX-License-Identifier: Apache-2.0
#include "match/scaled_verdict.hpp"

#include <algorithm>
#include <cmath>

#include "match/hypotheses.hpp"
#include "match/verdict.hpp"

namespace gridmerge::internal {

void weigh_scaled(std::vector<Hypothesis>& hypotheses, std::size_t levels,
                  const std::function<bool(const Hypothesis&, const Hypothesis&)>& are_near) {
  std::vector<PoseFigures> figures = figures_of(hypotheses);
  compare_rivals(figures, [&](std::size_t a, std::size_t b) { return are_near(hypotheses[a], hypotheses[b]); });
  const auto p = probabilities_of(figures);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) { hypotheses[i].figures = figures[i]; hypotheses[i].probability = p[i]; }
  std::stable_sort(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
}

Reason explain_scaled_refusal(const std::vector<Hypothesis>& hypotheses, double accept_probability) {
  return explain_refusal(figures_of(hypotheses), accept_probability);
}

}  // namespace gridmerge::internal
