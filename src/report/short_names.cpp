// SPDX-License-Identifier: Apache-2.0
#include "report/short_names.hpp"

#include <algorithm>
#include <cstddef>

namespace gridmerge::internal {

namespace {

/// How much of a name its folders are, with the slash after each.
std::size_t folders_of(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? 0 : slash + 1;
}

}  // namespace

std::vector<std::string> short_names(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  const std::string& first = names.front();
  std::size_t common = folders_of(first);
  for (const std::string& name : names) {
    const std::size_t most = std::min(common, folders_of(name));
    const auto differs =
        std::mismatch(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(most), name.begin());
    common = folders_of(std::string(first.begin(), differs.first));
  }
  if (common == 1) common = 0;  // the slash alone, which tells that the names are whole
  std::vector<std::string> shortened;
  shortened.reserve(names.size());
  for (const std::string& name : names) shortened.push_back(name.substr(common));
  return shortened;
}

}  // namespace gridmerge::internal
