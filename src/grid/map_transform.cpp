// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include "gridmerge/grid/deformation.hpp"

namespace gridmerge {

std::span<const MapTransformName> map_transforms() {
  static constexpr std::array kTransforms{
      MapTransformName{MapTransform::rigid, "rigid", "maps are turned and shifted"},
      MapTransformName{MapTransform::similarity, "similarity", "each map has a scale of its own, too"},
      MapTransformName{MapTransform::affine, "affine", "each map has scales along two axes, and shear"},
      MapTransformName{MapTransform::elastic, "elastic", "maps are bent"}};
  return kTransforms;
}

const char* name_of(MapTransform transform) {
  return map_transforms()[static_cast<std::size_t>(transform)].name;
}

std::optional<MapTransform> map_transform(std::string_view name) {
  for (const MapTransformName& one : map_transforms()) {
    if (name == one.name) return one.transform;
  }
  return std::nullopt;
}

}  // namespace gridmerge
