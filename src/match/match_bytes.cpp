// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match_bytes.hpp"

#include <stdexcept>

#include "match/pair_pose_bytes.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::uint8_t kLastVerdict = static_cast<std::uint8_t>(Verdict::accepted);
constexpr std::uint8_t kLastReason = static_cast<std::uint8_t>(Reason::contradicts_others);

std::size_t bytes_of_a_hypothesis() {
  return 8 * (5 + pose_figures().size());
}

}  // namespace

std::string to_bytes(const MatchResult& match) {
  ByteWriter writer;
  write_pair_pose(match, writer);
  writer.byte(static_cast<std::uint8_t>(match.verdict));
  writer.byte(static_cast<std::uint8_t>(match.reason));
  writer.number(match.seconds);
  writer.whole(match.hypotheses.size());
  for (const Hypothesis& one : match.hypotheses) {
    writer.pose(one.T_fixed_moving);
    writer.number(one.score);
    writer.number(one.probability);
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
  match.hypotheses.resize(reader.count(bytes_of_a_hypothesis()));
  for (Hypothesis& one : match.hypotheses) {
    one.T_fixed_moving = reader.pose();
    one.score = reader.number();
    one.probability = reader.number();
    check_pose(one.T_fixed_moving, one.probability);
    for (const PoseFigure& figure : pose_figures()) one.figures.*figure.value = reader.number();
  }
  if (!reader.is_at_end()) throw std::invalid_argument("holds more than a match");
  return match;
}

}  // namespace gridmerge
