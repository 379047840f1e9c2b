// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "gridmerge/export.hpp"

namespace gridmerge {

/// What may be done to a map so that it fits others.
enum class MapTransform {
  rigid,       ///< it is turned and shifted
  similarity,  ///< it has a scale of its own, too
  affine,      ///< it has scales along two axes, and shear
  elastic,     ///< it is bent
};

/// A transform: the one place where its name and meaning stand.
struct MapTransformName {
  MapTransform transform;  ///< which one
  const char* name;        ///< as the command line, Python and outputs spell it
  const char* meaning;     ///< in a few words
};

/// All of them, each with more freedom than the one before it.
GRIDMERGE_EXPORT std::span<const MapTransformName> map_transforms();

/// "rigid", ...
GRIDMERGE_EXPORT const char* name_of(MapTransform transform);

/// The transform of that name; none if there is none.
GRIDMERGE_EXPORT std::optional<MapTransform> map_transform(std::string_view name);

}  // namespace gridmerge
