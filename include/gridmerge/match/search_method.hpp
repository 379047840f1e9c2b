// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace gridmerge {

/// How match() searches the poses of a pair.
enum class SearchMethod {
  exhaustive,   ///< the quick look; the thorough one as well where that leaves the pair undecided
  quick,        ///< search_all_poses(): finds what overlaps much
  thorough,     ///< search_thoroughly(): finds what overlaps little too, in a few times the time
  random_walk,  ///< match_by_random_walk(): as Birk & Carpin (2006), with their acceptance index
};

/// A method: the one place where its name and meaning stand.
struct SearchMethodName {
  SearchMethod method;
  const char* name;     ///< as the command line, Python and outputs spell it
  const char* meaning;  ///< in a few words
};

/// All of them.
std::span<const SearchMethodName> search_methods();

/// "exhaustive", ...
const char* name_of(SearchMethod method);

/// The method of that name; none if there is none.
std::optional<SearchMethod> search_method(std::string_view name);

}  // namespace gridmerge
