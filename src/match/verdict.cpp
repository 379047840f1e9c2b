// SPDX-License-Identifier: Apache-2.0
#include "match/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/logistic.hpp"
#include "match/verdict_model.hpp"

namespace gridmerge::internal {

namespace {

double logarithm(double value, double least) {
  return std::log(std::max(value, least));
}

}  // namespace

double missing(double share, double floor) {
  return -std::log(std::max(0.0, 1.0 - share) + floor);
}

double how_held(const PoseFigures& f) {
  constexpr double kMin = 0.03;
  return logarithm(std::max(f.held, 0.0) / std::max(f.held_most, 1.0), kMin);
}

namespace {

/// Things are few: their share counts as that of so many metres more, of which every third meets by chance.
double things_share(const PoseFigures& f) {
  constexpr double kMetres = 4.0, kByChance = 1.0 / 3.0;
  return (f.things_met * f.seen_things + kByChance * kMetres) / (f.seen_things + kMetres);
}

constexpr double kSlides = -2.0;  // of how_held(): less than an eighth

/// Of bent maps few walls can meet, even at the right pose. There a margin of the score tells that no pose of
/// unrelated maps has: as far as the errors are those of bent maps, since of crisp ones of a symmetric floor
/// the wrong half leads as well.
double far_ahead_though_bent(const PoseFigures& f) {
  constexpr double kFar = 30.0, kAllOfIt = 20.0;  // sqrt(nats)
  constexpr double kCrisp = 0.1, kBent = 0.25;    // [m]
  const double ahead = std::clamp((f.score_margin - kFar) / kAllOfIt, 0.0, 1.0);
  const double bent =
      std::clamp(std::log(std::max(f.sigma, kCrisp) / kCrisp) / std::log(kBent / kCrisp), 0.0, 1.0);
  return ahead * bent;
}

/// How much better walls meet patch by patch. Few walls find others by chance when they may shift, so a bend
/// explains little of them.
double bend_explains(const PoseFigures& f) {
  constexpr double kMany = 150.0;  // [m]
  const double better = missing(f.walls_met_locally, 0.05) - missing(f.walls_met, 0.05);
  return better * std::clamp(f.seen_walls / kMany, 0.0, 1.0);
}

/// Two maps of one empty room agree in 99 of 100 cells, whichever way they lie: more tells nothing.
double cells_agree(double acceptance_index) {
  constexpr double kNearlyAll = 0.99;
  return missing(std::min(acceptance_index, kNearlyAll), 0.01);
}

/// At the true pose two maps hardly contradict each other. A wrong pose that overlaps much may agree in as
/// large a share of the cells, and yet contradict in a larger area.
double uncontradicted(const PoseFigures& f) {
  constexpr double kAlwaysDiffers = 0.5;  // [m^2]: of two scans of one place
  return -std::log(std::max(0.0, 1.0 - f.acceptance_index) * f.common_area + kAlwaysDiffers);
}

}  // namespace

double VerdictTerm::operator()(const PoseFigures& figures) const {
  return std::clamp(raw(figures), least, most);
}

std::span<const VerdictTerm> verdict_terms() {
  using F = PoseFigures;
  constexpr TermKind kAmount = TermKind::amount, kQuality = TermKind::quality;
  static constexpr std::array kTerms{
      VerdictTerm{"tells apart", "-ln(1 + exp(-3 (wall_lines - 3.5)))", kAmount, -12.0, 0.0,
                  [](const F& f) { return -std::log1p(std::exp(-3.0 * (f.wall_lines - 3.5))); }},
      VerdictTerm{"held", "ln(held / held_most)", kAmount, -3.5, 0.0, how_held},
      VerdictTerm{"stands out", "stands_out", TermKind::rivals, 0.0, 6.0,
                  [](const F& f) { return f.stands_out; }},
      VerdictTerm{"far ahead, bent",
                  "(score_margin - 30) / 20 within [0, 1], times ln(sigma / 0.1 m) / ln(2.5) within [0, 1]",
                  TermKind::excuse, 0.0, 1.0, far_ahead_though_bent},
      VerdictTerm{"met locally", "-ln(1.05 - walls_met_locally)", kQuality, 0.0, 2.5,
                  [](const F& f) { return missing(f.walls_met_locally, 0.05); }},
      VerdictTerm{
          "bend explains",
          "ln((1.05 - walls_met) / (1.05 - walls_met_locally)), times seen_walls / 150 m within [0, 1]",
          kQuality, 0.0, 2.0, bend_explains},
      VerdictTerm{"cells agree", "-ln(1.01 - min(acceptance_index, 0.99))", kQuality, 1.0, 3.92,
                  [](const F& f) { return cells_agree(f.acceptance_index); }},
      VerdictTerm{"things met", "-ln(1.05 - share), the share of things met drawn towards 1/3 by 4 m",
                  kQuality, 0.05, 2.5, [](const F& f) { return missing(things_share(f), 0.05); }},
      VerdictTerm{"explained", "-ln(outliers + 0.05)", kQuality, 0.6, 2.65,
                  [](const F& f) { return -logarithm(f.outliers + 0.05, 0.05); }}};
  static_assert(kTerms.size() == kVerdictWeights.size(), "each term has its weight in verdict_model.hpp");
  return kTerms;
}

std::span<const RankTerm> rank_terms() {
  using F = PoseFigures;
  static constexpr std::array kTerms{
      RankTerm{"evidence", "ln(score)", [](const F& f) { return logarithm(f.score, 1.0); }},
      RankTerm{"uncontradicted", "-ln((1 - acceptance_index) common_area + 0.5 m^2)", uncontradicted},
      RankTerm{"cells", "-ln(1.01 - acceptance_index)",
               [](const F& f) { return missing(f.acceptance_index, 0.01); }},
      RankTerm{"lines", "ln(wall_lines + 0.5)", [](const F& f) { return std::log(f.wall_lines + 0.5); }},
      RankTerm{"held", "as \"held\"", how_held},
      RankTerm{"things", "as \"things met\"", [](const F& f) { return missing(things_share(f), 0.05); }},
      RankTerm{"tolerance", "ln(sigma)", [](const F& f) { return logarithm(f.sigma, 0.03); }}};
  static_assert(kTerms.size() == kRankWeights.size(), "each term has its weight in verdict_model.hpp");
  return kTerms;
}

const VerdictModel& rigid_model() {
  static const VerdictModel model{rank_terms(), kRankWeights, verdict_terms(), kVerdictWeights, kVerdictBias};
  return model;
}

double rank_of(const PoseFigures& figures, const VerdictModel& model) {
  double sum = 0.0;
  for (std::size_t i = 0; i < model.rank_terms.size(); ++i)
    sum += model.rank_weights[i].weight * model.rank_terms[i].value(figures);
  return sum;
}

double log_odds_of(const PoseFigures& figures, const VerdictModel& model) {
  double sum = model.bias;
  for (std::size_t i = 0; i < model.terms.size(); ++i)
    sum += model.weights[i].weight * model.terms[i](figures);
  return sum;
}

namespace {

/// Nothing stands out more: also what has no rivals.
constexpr double kMaxStandingOut = 20.0;  // nats

}  // namespace

void compare_rivals(std::span<PoseFigures> hypotheses,
                    const std::function<bool(std::size_t, std::size_t)>& are_near,
                    const VerdictModel& model) {
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    PoseFigures& one = hypotheses[i];
    const double rank = rank_of(one, model);
    double next_score = 0.0, others = std::exp(-kMaxStandingOut);
    for (std::size_t j = 0; j < hypotheses.size(); ++j) {
      const PoseFigures& other = hypotheses[j];
      if (j == i || (other.score < one.score && are_near && are_near(i, j))) continue;
      next_score = std::max(next_score, other.score);
      others += std::exp(rank_of(other, model) - rank);
    }
    one.score_margin = one.score > 0.0 ? (one.score - next_score) / std::sqrt(one.score) : 0.0;
    one.stands_out = -std::log(others);
  }
}

std::vector<double> probabilities_of(std::span<const PoseFigures> hypotheses, const VerdictModel& model) {
  if (hypotheses.empty()) return {};
  std::vector<double> odds;
  for (const PoseFigures& figures : hypotheses) odds.push_back(rank_of(figures, model));
  const auto best = std::max_element(odds.begin(), odds.end());
  const PoseFigures& figures = hypotheses[static_cast<std::size_t>(best - odds.begin())];
  const double belief = logistic(log_odds_of(figures, model)), share = logistic(figures.stands_out);
  const double most = *best;
  double others = 0.0;
  for (auto one = odds.begin(); one != odds.end(); ++one) {
    *one = std::exp(*one - most);
    if (one != best) others += *one;
  }
  std::vector<double> probabilities;
  for (auto one = odds.begin(); one != odds.end(); ++one) {
    const double of_others = others > 0.0 ? *one / others : 0.0;
    probabilities.push_back(belief * (one == best ? share : (1.0 - share) * of_others));
  }
  return probabilities;
}

bool slides(const PoseFigures& figures) {
  return how_held(figures) < kSlides;
}

bool stands_out(const PoseFigures& figures, double accept_probability) {
  return logistic(figures.stands_out) >= accept_probability;
}

bool is_near_rival(double best, double next, double accept_probability) {
  return 1.0 - next / (best + next) < accept_probability;
}

namespace {

/// Whether it would be believed if the rest of the smaller map met the other one as what they share does.
bool more_overlap_would_do(PoseFigures figures, double accept_probability, const VerdictModel& model) {
  const double shared = std::clamp(figures.overlap, 0.01, 1.0);
  figures.wall_lines /= shared;
  figures.held += (1.0 - shared) * (figures.held_most - figures.held);
  figures.stands_out = kMaxStandingOut;
  return logistic(log_odds_of(figures, model)) >= accept_probability;
}

}  // namespace

Reason explain_refusal(std::span<const PoseFigures> hypotheses, double accept_probability,
                       const VerdictModel& model) {
  if (hypotheses.empty()) return Reason::nothing_to_compare;
  const std::vector<double> probabilities = probabilities_of(hypotheses, model);
  if (probabilities[0] >= accept_probability) return Reason::none;
  // What the best one would be worth by itself, if all terms of a kind were as good as can be.
  const auto mended = [&](auto is_mended) {
    const auto terms = model.terms;
    double log_odds = log_odds_of(hypotheses[0], model);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      if (is_mended(terms[i].kind))
        log_odds += model.weights[i].weight * (terms[i].most - terms[i](hypotheses[0]));
    }
    return logistic(log_odds);
  };
  const auto with_rivals = [&](auto is_mended) {
    return mended([&](TermKind kind) { return kind == TermKind::rivals || is_mended(kind); }) >=
           accept_probability;
  };
  if (!stands_out(hypotheses[0], accept_probability) && with_rivals([](TermKind) { return false; }))
    return Reason::ambiguous;
  const bool agrees = with_rivals([](TermKind kind) { return kind == TermKind::amount; });
  if (agrees && probabilities.size() > 1 &&
      is_near_rival(probabilities[0], probabilities[1], accept_probability))
    return Reason::ambiguous;
  if (agrees && slides(hypotheses[0])) return Reason::ambiguous;
  const bool contradicts = with_rivals([](TermKind kind) { return kind == TermKind::quality; });
  if (agrees && model.is_scaled && !more_overlap_would_do(hypotheses[0], accept_probability, model))
    return contradicts ? Reason::contradiction : Reason::ambiguous;
  if (agrees) return Reason::too_little_overlap;
  return contradicts ? Reason::contradiction : Reason::several;
}

const char* name_of(TermKind kind) {
  switch (kind) {
    case TermKind::amount:
      return "amount";
    case TermKind::quality:
      return "quality";
    case TermKind::rivals:
      return "rivals";
    case TermKind::excuse:
      break;
  }
  return "excuse";
}

}  // namespace gridmerge::internal
