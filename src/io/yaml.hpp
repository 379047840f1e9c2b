// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <string_view>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// The document that a text is. Throws ParseError for what is no YAML, and for what is nested more than 16
/// levels deep: yaml-cpp calls itself for each level.
GRIDMERGE_INTERNAL_EXPORT YAML::Node load_yaml(std::string_view text);

}  // namespace gridmerge::internal
