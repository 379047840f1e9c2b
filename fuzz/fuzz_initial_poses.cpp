// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz_target.hpp"
#include "gridmerge/io/initial_poses.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  std::vector<InitialPose> poses;
  try {
    poses = parse_initial_poses("folder/poses.tsv", fuzz::as_bytes(data, size));
  } catch (const FileError&) {
    return 0;
  }
  for (const InitialPose& pose : poses) {
    const SE2& T = pose.T_world_map;
    fuzz::require(std::isfinite(T.x) && std::isfinite(T.y) && std::isfinite(T.theta));
    fuzz::require(pose.sd_position > 0.0 && pose.sd_theta > 0.0 && !pose.name.empty());
  }
  return 0;
}
