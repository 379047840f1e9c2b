// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>

#include "gridmerge/evaluate/evaluate.hpp"

namespace gridmerge {

namespace {

const std::string& cell(const std::string& text) {
  if (text.empty() || text.find_first_of(std::string("\t\r\n\0", 4)) != std::string::npos)
    throw std::invalid_argument("a name in a table must not be empty or hold tabs or line breaks");
  return text;
}

double finite(double number) {
  if (!std::isfinite(number)) throw std::invalid_argument("a number in a table must be finite");
  return number;
}

}  // namespace

std::string format_pairs(const std::vector<TruePair>& pairs) {
  const bool has_tiers =
      std::any_of(pairs.begin(), pairs.end(), [](const TruePair& pair) { return !pair.tier.empty(); });
  std::string text = fmt::format("fixed\tmoving\tx\ty\ttheta\ttolerance\t{}overlap\tshared_wall\n",
                                 has_tiers ? "tier\t" : "");
  for (const TruePair& pair : pairs) {
    const SE2& T = pair.T_fixed_moving;
    fmt::format_to(std::back_inserter(text), "{}\t{}\t{}\t{}\t{}\t{}\t{}{}\t{}\n", cell(pair.fixed.name),
                   cell(pair.moving.name), finite(T.x), finite(T.y), finite(T.theta), finite(pair.tolerance),
                   has_tiers ? cell(pair.tier) + '\t' : "", finite(pair.overlap), finite(pair.shared_wall));
  }
  return text;
}

std::string format_negatives(const std::vector<NegativePair>& negatives) {
  std::string text = "fixed\tmoving\n";
  for (const NegativePair& pair : negatives)
    fmt::format_to(std::back_inserter(text), "{}\t{}\n", cell(pair.fixed.name), cell(pair.moving.name));
  return text;
}

std::string format_sets(const std::vector<TrueSet>& sets) {
  std::string text = "set\tmap\tx\ty\ttheta\ttolerance\n";
  for (const TrueSet& set : sets) {
    for (const TrueMember& member : set.members) {
      const SE2& T = member.T_set_map;
      fmt::format_to(std::back_inserter(text), "{}\t{}\t{}\t{}\t{}\t{}\n", cell(set.name),
                     cell(member.map.name), finite(T.x), finite(T.y), finite(T.theta),
                     finite(member.tolerance));
    }
  }
  return text;
}

}  // namespace gridmerge
