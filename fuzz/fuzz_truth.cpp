// SPDX-License-Identifier: Apache-2.0
// One input for all three kinds of truth file; at most one of the readers takes it.
#include <cmath>

#include "evaluate/parse_truth.hpp"
#include "fuzz_target.hpp"
#include "gridmerge/io/file_error.hpp"

using namespace gridmerge::internal;

namespace {

using namespace gridmerge;

// The rows that `parse` makes of the text, none where it refuses it.
template <typename Parse>
auto rows_of(const Parse& parse, std::string_view text) -> decltype(parse("folder/truth.tsv", text)) {
  try {
    return parse("folder/truth.tsv", text);
  } catch (const FileError&) {
    return {};
  }
}

void require_sound(const SE2& T, double tolerance) {
  fuzz::require(std::isfinite(T.x) && std::isfinite(T.y) && std::isfinite(T.theta) && tolerance > 0.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::as_bytes(data, size);
  for (const TruePair& pair : rows_of(parse_pairs, text)) {
    require_sound(pair.T_fixed_moving, pair.tolerance);
    fuzz::require(!pair.fixed.name.empty() && !pair.moving.name.empty());
  }
  for (const NegativePair& pair : rows_of(parse_negatives, text)) {
    fuzz::require(!pair.fixed.name.empty() && !pair.moving.name.empty());
  }
  for (const TrueSet& set : rows_of(parse_sets, text)) {
    fuzz::require(set.members.size() >= 2);
    for (const TrueMember& member : set.members) require_sound(member.T_set_map, member.tolerance);
  }
  return 0;
}
