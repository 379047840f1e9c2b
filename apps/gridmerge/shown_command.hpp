// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gridmerge/io/map_file.hpp"

namespace gridmerge::cli {

/// The name of a file as people type it in a shell: in quotes if need be, and never an option.
std::string typed_file(const std::string& name);

/// "gridmerge match FIXED MOVING", with the options by which the maps were read. bash runs it as it is
/// printed.
std::string match_command(const std::string& fixed, const std::string& moving, const LoadOptions& load);

}  // namespace gridmerge::cli
