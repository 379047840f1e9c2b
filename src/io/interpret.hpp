// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/io/map_file.hpp"
#include "io/image.hpp"
#include "io/map_yaml.hpp"

namespace gridmerge::internal {

/// The map that a picture is under the YAML's rules, which load_map documents, and what is odd about it.
/// `literal_thresholds` as in LoadOptions. O(pixels).
LoadedMap interpret(const MapYaml& yaml, const MapImage& image, bool literal_thresholds = false);

}  // namespace gridmerge::internal
