// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_span.hpp"

#include <vector>

namespace gridmerge::internal {

std::optional<Eigen::MatrixXd> span_of(const ElasticSheet& sheet, MapTransform transform) {
  if (transform == MapTransform::elastic) return std::nullopt;
  // What p, seen from the lattice's middle, is shifted by. About the middle these are orthogonal.
  std::vector<Affine> shifts{{0.0, 0.0, 0.0, 0.0, {1.0, 0.0}}, {0.0, 0.0, 0.0, 0.0, {0.0, 1.0}}};
  if (transform == MapTransform::affine) {
    for (int entry = 0; entry < 4; ++entry)
      shifts.push_back({entry == 0 ? 1.0 : 0.0,
                        entry == 1 ? 1.0 : 0.0,
                        entry == 2 ? 1.0 : 0.0,
                        entry == 3 ? 1.0 : 0.0,
                        {}});
  } else {
    shifts.push_back({0.0, -1.0, 1.0, 0.0, {}});
    if (transform == MapTransform::similarity) shifts.push_back({1.0, 0.0, 0.0, 1.0, {}});
  }
  Eigen::MatrixXd span(2 * static_cast<Eigen::Index>(sheet.size()), static_cast<Eigen::Index>(shifts.size()));
  for (Eigen::Index column = 0; column < span.cols(); ++column) {
    for (Eigen::Index point = 0; point < span.rows() / 2; ++point) {
      const Eigen::Index x = point % sheet.columns(), y = point / sheet.columns();
      const Point2 p{static_cast<double>(x) - 0.5 * (sheet.columns() - 1),
                     static_cast<double>(y) - 0.5 * (sheet.rows() - 1)};
      const Point2 shift = shifts[static_cast<std::size_t>(column)] * p;
      span(2 * point, column) = shift.x;
      span(2 * point + 1, column) = shift.y;
    }
    span.col(column).normalize();
  }
  return span;
}

}  // namespace gridmerge::internal
