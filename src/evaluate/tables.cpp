// SPDX-License-Identifier: Apache-2.0
#include "evaluate/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "evaluate/count.hpp"
#include "gridmerge/io/file_error.hpp"
#include "match/rounded_down.hpp"
#include "match/verdict.hpp"

namespace gridmerge::internal {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPairRow = "{:<12} {:>6} {:>10} {:>10} {:>10} {:>10}\n";

std::string pair_row(const std::string& name, const PairCounts& counts) {
  return fmt::format(kPairRow, name, counts.total, counts.accepted_correct, counts.accepted_wrong,
                     counts.refused, counts.best_correct);
}

std::string pair_rows(const std::vector<MatchOutcome>& matches) {
  std::string text = fmt::format(kPairRow, "", "", "accepted", "accepted", "", "best");
  text += fmt::format(kPairRow, "", "total", "correct", "wrong", "refused", "correct");
  text += pair_row("pairs", count_pairs(matches));
  for (const auto& [tier, counts] : count_tiers(matches))
    text += pair_row("  " + escape_controls(tier), counts);
  const NegativeCounts negatives = count_negatives(matches);
  text += fmt::format(kPairRow, "negatives", negatives.total, "", negatives.accepted,
                      negatives.total - negatives.accepted, "");
  return text;
}

std::string set_rows(const std::vector<SetOutcome>& sets) {
  const SetCounts counts = count_sets(sets);
  constexpr const char* kRow = "{:<12} {:>6} {:>10} {:>10} {:>10} {:>10} {:>10}\n";
  std::string text = fmt::format(kRow, "", "", "", "", "maps", "maps", "maps");
  text += fmt::format(kRow, "", "total", "complete", "maps", "correct", "wrong", "left out");
  text += fmt::format(kRow, "sets", counts.total, counts.complete, counts.maps, counts.maps_correct,
                      counts.maps_wrong, counts.maps_left_out);
  return text;
}

std::string threshold_rows(const std::vector<MatchOutcome>& matches, double accept_probability) {
  std::vector<double> thresholds = {0.0, 0.25, 0.5, 0.75, 0.8, 0.9, 0.95, 0.99, 0.999, 0.9999};
  if (std::find(thresholds.begin(), thresholds.end(), accept_probability) == thresholds.end()) {
    thresholds.insert(std::lower_bound(thresholds.begin(), thresholds.end(), accept_probability),
                      accept_probability);
  }
  constexpr const char* kRow = "{:<12} {:>6} {:>10} {:>10} {:>10}\n";
  std::string text = fmt::format(kRow, "probability", "", "correct", "wrong", "negatives");
  text += fmt::format(kRow, "at least", "", "accepted", "accepted", "accepted");
  for (const ThresholdCounts& counts : sweep_thresholds(matches, thresholds)) {
    text += fmt::format(kRow, counts.threshold, counts.threshold == accept_probability ? "used" : "",
                        counts.correct, counts.wrong, counts.negatives);
  }
  const double area = roc_area(matches);
  if (!std::isnan(area)) text += fmt::format("area under the ROC of the probability: {:.4f}\n", area);
  return text;
}

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json case_json(const MatchOutcome& match) {
  return {{"fixed", match.fixed},
          {"moving", match.moving},
          {"verdict", name_of(match.verdict)},
          {"probability", match.probability},
          {"error", or_null(match.error)},
          {"tolerance", or_null(match.tolerance)},
          {"correct", match.negative() ? Json(nullptr) : Json(match.correct())},
          {"seconds", match.seconds}};
}

}  // namespace

std::string summary_table(const Evaluation& evaluation, double accept_probability) {
  std::string text;
  if (!evaluation.matches.empty()) {
    const TimeSummary seconds = summarize_times(evaluation.matches);
    text += pair_rows(evaluation.matches);
    text += fmt::format("\nseconds per match: median {:.3f}, 90 % {:.3f}, max {:.3f}\n\n", seconds.median,
                        seconds.p90, seconds.max);
    text += threshold_rows(evaluation.matches, accept_probability);
  }
  if (!evaluation.sets.empty()) {
    if (!text.empty()) text += '\n';
    text += set_rows(evaluation.sets);
  }
  return text.empty() ? "nothing to evaluate\n" : text;
}

std::string case_table(const Evaluation& evaluation) {
  std::string text;
  for (const MatchOutcome& match : evaluation.matches) {
    const std::string truth = match.negative()  ? "unrelated"
                              : match.correct() ? "correct"
                              : match.error     ? fmt::format("off by {:.2f} m", *match.error)
                                                : "no hypothesis";
    fmt::format_to(std::back_inserter(text), "{:<8} {:.4f}  {:<18} {:.3f} s  {} {}\n", name_of(match.verdict),
                   rounded_down(match.probability), truth, match.seconds, escape_controls(match.fixed),
                   escape_controls(match.moving));
  }
  for (const SetOutcome& set : evaluation.sets) {
    fmt::format_to(std::back_inserter(text), "set {}: {} maps, {} correct, {} wrong, {} left out\n",
                   escape_controls(set.name), set.maps, set.correct, set.wrong, set.left_out);
  }
  return text;
}

std::string features_table(const Evaluation& evaluation) {
  std::string text = "fixed\tmoving\ttier\thypothesis\ttruth\terror\tx\ty\ttheta";
  for (const PoseFigure& figure : pose_figures()) text += fmt::format("\t{}", figure.name);
  for (const VerdictTerm& term : verdict_terms()) text += fmt::format("\tterm: {}", term.name);
  for (const RankTerm& term : rank_terms()) text += fmt::format("\trank: {}", term.name);
  text += '\n';
  for (const MatchOutcome& match : evaluation.matches) {
    for (std::size_t i = 0; i < match.hypotheses.size(); ++i) {
      const auto& [hypothesis, error] = match.hypotheses[i];
      const char* truth = !error ? "negative" : *error <= *match.tolerance ? "right" : "wrong";
      const SE2& T = hypothesis.T_fixed_moving;
      fmt::format_to(std::back_inserter(text), "{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}", match.fixed,
                     match.moving, match.tier, i + 1, truth, error.value_or(-1.0), T.x, T.y, T.theta);
      for (const PoseFigure& figure : pose_figures())
        fmt::format_to(std::back_inserter(text), "\t{}", hypothesis.figures.*figure.value);
      for (const VerdictTerm& term : verdict_terms())
        fmt::format_to(std::back_inserter(text), "\t{}", term(hypothesis.figures));
      for (const RankTerm& term : rank_terms())
        fmt::format_to(std::back_inserter(text), "\t{}", term.value(hypothesis.figures));
      text += '\n';
    }
  }
  return text;
}

std::string evaluation_json(const Evaluation& evaluation) {
  const PairCounts pairs = count_pairs(evaluation.matches);
  const NegativeCounts negatives = count_negatives(evaluation.matches);
  const SetCounts sets = count_sets(evaluation.sets);
  const TimeSummary seconds = summarize_times(evaluation.matches);
  Json cases = Json::array();
  for (const MatchOutcome& match : evaluation.matches) cases.push_back(case_json(match));

  Json json;
  json["pairs"] = {{"total", pairs.total},
                   {"accepted_correct", pairs.accepted_correct},
                   {"accepted_wrong", pairs.accepted_wrong},
                   {"refused", pairs.refused},
                   {"best_correct", pairs.best_correct}};
  json["negatives"] = {{"total", negatives.total}, {"accepted", negatives.accepted}};
  json["sets"] = {{"total", sets.total},
                  {"maps", sets.maps},
                  {"maps_correct", sets.maps_correct},
                  {"maps_wrong", sets.maps_wrong},
                  {"maps_left_out", sets.maps_left_out},
                  {"complete", sets.complete}};
  json["seconds"] = {{"median", seconds.median}, {"p90", seconds.p90}, {"max", seconds.max}};
  json["cases"] = std::move(cases);
  // A file name need not be UTF-8, which JSON text must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace gridmerge::internal
