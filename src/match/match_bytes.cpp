// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "gridmerge/match/stored_match.hpp"
#include "match/pair_pose_bytes.hpp"

namespace gridmerge {

using namespace internal;

namespace {

std::size_t bytes_of_a_hypothesis() {
  return 8 * (6 + pose_figures().size());
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
  match.verdict = static_cast<Verdict>(reader.byte());
  match.reason = static_cast<Reason>(reader.byte());
  match.seconds = reader.number();
  match.scale = reader.number();
  match.hypotheses.resize(reader.count(bytes_of_a_hypothesis()));
  for (Hypothesis& one : match.hypotheses) {
    one.T_fixed_moving = reader.pose();
    one.score = reader.number();
    one.probability = reader.number();
    one.scale = reader.number();
    for (const PoseFigure& figure : pose_figures()) one.figures.*figure.value = reader.number();
  }
  if (!reader.is_at_end()) throw std::invalid_argument("holds more than a match");
  if (const char* flaw = flaw_of(match)) throw std::invalid_argument(flaw);
  return match;
}

}  // namespace gridmerge
