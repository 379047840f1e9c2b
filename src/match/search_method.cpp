// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include "gridmerge/match/match.hpp"

namespace gridmerge {

std::span<const SearchMethodName> search_methods() {
  static constexpr std::array kMethods{
      SearchMethodName{SearchMethod::exhaustive, "exhaustive",
                       "a quick look at every pose, then a thorough one if that decides nothing"},
      SearchMethodName{SearchMethod::quick, "quick", "the quick look alone"},
      SearchMethodName{SearchMethod::thorough, "thorough", "the thorough look alone"},
      SearchMethodName{SearchMethod::random_walk, "random-walk", "the walk of Birk & Carpin (2006)"}};
  return kMethods;
}

const char* name_of(SearchMethod method) {
  return search_methods()[static_cast<std::size_t>(method)].name;
}

std::optional<SearchMethod> search_method(std::string_view name) {
  for (const SearchMethodName& one : search_methods()) {
    if (name == one.name) return one.method;
  }
  return std::nullopt;
}

}  // namespace gridmerge
