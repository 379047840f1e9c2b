// SPDX-License-Identifier: Apache-2.0
#include "report/record_values.hpp"

namespace gridmerge::internal {

double read_share(const JsonReader& json) {
  constexpr double kRounding = 1e-9;
  return json.number_in(-kRounding, 1.0 + kRounding);
}

Reason read_reason(const JsonReader& json) {
  return one_of(json, std::array{Reason::none, Reason::nothing_to_compare, Reason::ambiguous,
                                 Reason::contradiction, Reason::too_little_overlap, Reason::several,
                                 Reason::contradicts_others, Reason::over_budget});
}

}  // namespace gridmerge::internal
