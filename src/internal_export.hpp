// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/export.hpp"

/// Marks what one component of gridmerge::internal offers to another, or to the command line. Shared
/// libraries need it; no installed header declares it, so it is no promise to anybody.
#define GRIDMERGE_INTERNAL_EXPORT GRIDMERGE_EXPORT
