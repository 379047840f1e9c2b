// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dds/selection.hpp"
#include "gridmerge/dds/ros_node.hpp"

namespace gridmerge::internal {

/// The same, with nothing that still has to be asked for: valid, with a world frame as it is sent, and with
/// functions to call. Throws as validate().
RosNodeOptions completed(RosNodeOptions options);

/// Whom these options hear. Throws as validate().
RobotSelection select(const RosNodeOptions& options);

}  // namespace gridmerge::internal
