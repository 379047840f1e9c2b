// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/resample.hpp"
#include "preselect/signature.hpp"

namespace gridmerge::test {

/// As of a prepared map: cropped to its known cells.
inline internal::Signature signature_of(const OccupancyGrid& map) {
  return internal::make_signature(crop_to_known(map));
}

}  // namespace gridmerge::test
