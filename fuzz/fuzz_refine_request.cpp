// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <set>
#include <stdexcept>

#include "fuzz_target.hpp"
#include "report/refine_request.hpp"

using namespace gridmerge::internal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  constexpr std::size_t kMaps = 4;
  RefineRequest request;
  try {
    request = parse_refine_request(fuzz::as_bytes(data, size), [](const std::string&) { return kMaps; });
  } catch (const std::invalid_argument&) {
    return 0;
  }
  fuzz::require(!request.fixed.empty());
  std::vector<LaidMap> laid = request.fixed;
  laid.push_back(request.moving);
  std::set<std::size_t> maps;
  for (const LaidMap& one : laid) {
    const SE2& T = one.T_page_map;
    fuzz::require(std::isfinite(T.x) && std::isfinite(T.y) && std::isfinite(T.theta));
    fuzz::require(one.map < kMaps && maps.insert(one.map).second);
  }
  return 0;
}
