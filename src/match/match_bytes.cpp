// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "gridmerge/match/stored_match.hpp"
#include "match/pair_pose_bytes.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::uint8_t kLastVerdict = static_cast<std::uint8_t>(Verdict::accepted);
constexpr std::uint8_t kLastReason = static_cast<std::uint8_t>(Reason::contradicts_others);

std::size_t bytes_of_a_hypothesis() {
  return 8 * (6 + pose_figures().size());
}

/// Throws std::invalid_argument for what no match can have found.
void check_scale(double scale) {
  if (!(std::isfinite(scale) && scale > 0.0)) throw std::invalid_argument("holds a scale that no match has");
}

void check_figures(double score, const PoseFigures& figures) {
  const std::span<const PoseFigure> all = pose_figures();
  const bool are_sound =
      std::isfinite(score) && figures.sigma >= 0.0 &&
      std::all_of(all.begin(), all.end(), [&](const auto& one) { return std::isfinite(figures.*one.value); });
  if (!are_sound) throw std::invalid_argument("holds a figure that no match has");
}

}  // namespace

std::string to_bytes(const MatchResult& match) {
  ByteWriter writer;
  write_pair_pose(match, writer);
  writer.byte(static_cast<std::uint8_t>(match.verdict));
  writer.byte(static_cast<std::uint8_t>(match.reason));
  writer.number(match.seconds);
  writer.number(match.scale);
  writer.whole(match.hypotheses.size());
  for (const Hypothesis& one : match.hypotheses) {
    writer.pose(one.T_fixed_moving);
    writer.number(one.score);
    writer.number(one.probability);
    writer.number(one.scale);
    for (const PoseFigure& figure : pose_figures()) writer.number(one.figures.*figure.value);
  }
  return writer.take();
}

MatchResult match_from_bytes(std::string_view bytes) {
  ByteReader reader(bytes);
  MatchResult match;
  read_pair_pose(reader, match);
  const std::uint8_t verdict = reader.byte(), reason = reader.byte();
  if (verdict > kLastVerdict || reason > kLastReason)
    throw std::invalid_argument("holds a verdict that no match has");
  match.verdict = static_cast<Verdict>(verdict);
  match.reason = static_cast<Reason>(reason);
  match.seconds = reader.number();
  match.scale = reader.number();
  check_scale(match.scale);
  match.hypotheses.resize(reader.count(bytes_of_a_hypothesis()));
  for (Hypothesis& one : match.hypotheses) {
    one.T_fixed_moving = reader.pose();
    one.score = reader.number();
    one.probability = reader.number();
    check_pose(one.T_fixed_moving, one.probability);
    one.scale = reader.number();
    check_scale(one.scale);
    for (const PoseFigure& figure : pose_figures()) one.figures.*figure.value = reader.number();
    check_figures(one.score, one.figures);
  }
  if (!reader.is_at_end()) throw std::invalid_argument("holds more than a match");
  return match;
}

}  // namespace gridmerge
