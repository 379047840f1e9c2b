// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/dds/ros_node.hpp>
#include <stdexcept>

int main() {
  gridmerge::RosNodeOptions options;
  options.patterns = {"/*/map"};
  gridmerge::validate(options);
  options.world_frame.clear();
  try {
    gridmerge::validate(options);
  } catch (const std::invalid_argument&) {
    return 0;
  }
  return 1;
}
