// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/deformation.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>

#include <array>
#include <optional>
#include <utility>

#include "bindings.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

using Points = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using NewPoints = nb::ndarray<nb::numpy, double, nb::ndim<2>>;

/// An array that owns its values.
NewPoints to_numpy(std::vector<Point2> points) {
  auto values = std::make_unique<std::vector<double>>();
  values->reserve(2 * points.size());
  for (const Point2& point : points) values->insert(values->end(), {point.x, point.y});
  double* data = values->data();
  const nb::capsule owner(values.release(), [](void* owned) noexcept {
    std::unique_ptr<std::vector<double>>(static_cast<std::vector<double>*>(owned)).reset();
  });
  return {data, {points.size(), std::size_t{2}}, owner};
}

std::vector<Point2> to_points(const Points& array) {
  std::vector<Point2> points;
  points.reserve(array.shape(0));
  for (std::size_t i = 0; i < array.shape(0); ++i) points.push_back({array(i, 0), array(i, 1)});
  return points;
}

template <typename Change>
NewPoints changed(const Points& array, const Change& change) {
  std::vector<Point2> points = to_points(array);
  {
    const OthersRun meanwhile;
    for (Point2& point : points) point = change(point);
  }
  return to_numpy(std::move(points));
}

}  // namespace

void bind_deformation(nb::module_& module) {
  nb::class_<Deformation>(module, "Deformation")
      .def(
          "__init__",
          [](Deformation* made, const Pose& frame, double spacing, int columns, int rows,
             const Points& shifts) {
            new (made) Deformation(to_se2(frame), spacing, columns, rows, to_points(shifts));
          },
          nb::arg("frame"), nb::arg("spacing"), nb::arg("columns"), nb::arg("rows"), nb::arg("shifts"))
      .def_prop_ro("is_identity", &Deformation::is_identity)
      .def_prop_ro("frame", [](const Deformation& one) { return to_pose(one.T_map_lattice()); })
      .def_prop_ro("spacing", &Deformation::spacing)
      .def_prop_ro("columns", &Deformation::columns)
      .def_prop_ro("rows", &Deformation::rows)
      .def_prop_ro(
          "shifts", [](const Deformation& one) { return to_numpy(one.shifts()); },
          nb::rv_policy::move)  // it owns its values
      .def_prop_ro("kind", [](const Deformation& one) { return name_of(one.kind()); })
      .def_prop_ro("matrix",
                   [](const Deformation& one) -> std::optional<std::array<double, 6>> {
                     const std::optional<Affine> affine = one.affine();
                     if (!affine) return std::nullopt;
                     return std::array{affine->xx, affine->xy, affine->shift.x,
                                       affine->yx, affine->yy, affine->shift.y};
                   })
      .def_prop_ro("scale",
                   [](const Deformation& one) -> std::optional<double> {
                     const std::optional<Affine> affine = one.affine();
                     return affine ? std::optional(affine->scale()) : std::nullopt;
                   })
      .def_prop_ro("strain_bound", &Deformation::strain_bound)
      .def(
          "bend",
          [](const Deformation& one, const Points& points) {
            return changed(points, [&](const Point2& point) { return one.bend(point); });
          },
          nb::arg("points"))
      .def(
          "straighten",
          [](const Deformation& one, const Points& points) {
            return changed(points, [&](const Point2& point) { return one.straighten(point); });
          },
          nb::arg("points"));
}

}  // namespace gridmerge::python
