// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bindings.hpp"
#include "gridmerge/similarity/image_similarity.hpp"

namespace gridmerge::python {

/// The bytes of an array of numbers, for numpy.frombuffer().
template <typename Number>
nb::bytes to_bytes(const std::vector<Number>& numbers) {
  return nb::bytes(numbers.data(), numbers.size() * sizeof(Number));
}

/// A row of _measure._POSE_COLUMNS. Counts are whole numbers below 2^53, which a double holds.
inline void append_figures(std::vector<double>& table, const SE2& T, const ImageSimilarity& similarity) {
  table.insert(table.end(),
               {T.x, T.y, T.theta, similarity.psi(), static_cast<double>(similarity.agreement),
                static_cast<double>(similarity.disagreement), static_cast<double>(similarity.omega),
                similarity.acceptance_index(), static_cast<double>(similarity.undefined_terms())});
}

}  // namespace gridmerge::python
