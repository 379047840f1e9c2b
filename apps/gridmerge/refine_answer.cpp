// SPDX-License-Identifier: Apache-2.0
#include "refine_answer.hpp"

#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "merge/refine_member.hpp"
#include "report/refine_request.hpp"

namespace gridmerge::cli {

using namespace internal;

std::string answer_refine(const std::string& body,
                          const std::function<ShownMaps(const std::string& merge)>& maps_of, int threads) {
  ShownMaps maps;
  const RefineRequest request = parse_refine_request(body, [&](const std::string& merge) {
    maps = maps_of(merge);
    return maps.size();
  });
  const auto placed = [&](const LaidMap& laid) { return PlacedMap{maps[laid.map].get(), laid.T_page_map}; };
  std::vector<PlacedMap> fixed;
  for (const LaidMap& laid : request.fixed) fixed.push_back(placed(laid));
  RefinedPose refined;
  with_threads(threads, [&] { refined = refine_member(fixed, placed(request.moving)); });
  return refined_pose_json(refined);
}

}  // namespace gridmerge::cli
