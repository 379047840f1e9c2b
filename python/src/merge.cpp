// SPDX-License-Identifier: Apache-2.0
#include "merge.hpp"

#include <stdexcept>
#include <utility>

#include "grid_bytes.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/merge/tree.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "merge_bytes.hpp"
#include "rounds.hpp"
#include "worker.hpp"

namespace gridmerge::python {

using namespace internal;

std::vector<OccupancyGrid> grids_of(const std::vector<Map>& maps) {
  std::vector<OccupancyGrid> grids;
  grids.reserve(maps.size());
  for (const Map& map : maps) {
    throw_if_cancelled();
    grids.push_back(*map.grid);
  }
  return grids;
}

namespace {

MergeResult merge_grids(const std::vector<OccupancyGrid>& grids,
                        const std::vector<std::optional<KnownPose>>& known_poses, const MergeOptions& options,
                        bool up_the_tree) {
  if (!up_the_tree) return merge(grids, options, known_poses);
  validate(options.match);
  const auto matcher = [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    return match(fixed, moving, options.match);
  };
  return merge_up_tree(grids, matcher, {options.resolution, options.progress, options.match.threads});
}

Merged merge_maps(std::vector<Map> maps, const std::vector<std::optional<Known>>& known, int threads,
                  std::optional<double> accept, double max_false_joins, double max_missed,
                  double output_resolution, bool up_the_tree, const std::string& transform,
                  const std::string& search, const nb::object& progress) {
  std::vector<std::optional<KnownPose>> known_poses;
  known_poses.reserve(known.size());
  for (const std::optional<Known>& one : known) known_poses.push_back(to_known_pose(one));
  MergeOptions options;
  options.match.threads = threads;
  set_search(options.match, search, accept);
  options.max_false_joins = max_false_joins;
  options.max_missed = max_missed;
  options.resolution = output_resolution;
  options.transform = map_transform(transform).value();
  MergeResult result = compute_in_worker(progress, [&](const Report& report) {
    options.progress = [&, rounds = RoundsShare()](std::size_t done, std::size_t total) mutable {
      report(up_the_tree ? static_cast<double>(done) / static_cast<double>(total) : rounds.of(done, total));
    };
    return merge_grids(grids_of(maps), known_poses, options, up_the_tree);
  });
  return {std::move(maps), std::make_shared<const MergeResult>(std::move(result))};
}

// Shares the result's own grid.
Map grid_of(const std::shared_ptr<const MergeResult>& result, std::size_t component) {
  return {{result, &result->components.at(component).fused.grid}, {}, {}};
}

std::vector<std::string> to_strings(const std::vector<nb::bytes>& names) {
  std::vector<std::string> texts;
  texts.reserve(names.size());
  for (const nb::bytes& name : names) texts.push_back(to_string(name));
  return texts;
}

std::vector<std::filesystem::path> inputs_of(const Merged& merged,
                                             const std::vector<nb::bytes>& more_inputs) {
  std::vector<std::filesystem::path> inputs;
  for (const Map& map : merged.maps) inputs.insert(inputs.end(), map.files.begin(), map.files.end());
  for (const nb::bytes& input : more_inputs) inputs.emplace_back(to_string(input));
  return inputs;
}

void save(const Merged& merged, const nb::bytes& directory, const std::vector<nb::bytes>& names,
          const std::vector<nb::bytes>& more_inputs) {
  const std::vector<std::filesystem::path> inputs = inputs_of(merged, more_inputs);
  const std::vector<std::string> texts = to_strings(names);
  const std::filesystem::path path = to_string(directory);
  const OthersRun meanwhile;
  write_merge_output(path, inputs, {texts, grids_of(merged.maps), *merged.result, merged.plan.get()});
}

void write_exported(const Merged& merged, const std::string& format, const nb::bytes& file,
                    const std::vector<nb::bytes>& names, const std::vector<nb::bytes>& more_inputs) {
  const std::vector<std::filesystem::path> inputs = inputs_of(merged, more_inputs);
  const std::vector<std::string> texts = to_strings(names);
  const std::filesystem::path path = to_string(file);
  const OthersRun meanwhile;
  write_export(export_format(format).value(), path, inputs, {texts, grids_of(merged.maps), *merged.result});
}

// The picture that save() writes.
nb::bytes preview(const Merged& merged, const std::vector<nb::bytes>& names) {
  const std::vector<std::string> texts = to_strings(names);
  const std::string png = [&] {
    const OthersRun meanwhile;
    return preview_png({texts, grids_of(merged.maps), *merged.result, merged.plan.get()});
  }();
  return nb::bytes(png.data(), png.size());
}

void bind_results(nb::module_& module) {
  nb::class_<Join, PairPose>(module, "Join")
      .def_ro("fixed", &Join::fixed)
      .def_ro("moving", &Join::moving)
      .def_ro("match", &Join::match)
      .def_prop_ro("outcome", [](const Join& join) { return name_of(join.outcome); })
      .def_prop_ro("used", &Join::used)
      .def_prop_ro("reason", [](const Join& join) { return name_of(join.reason()); });
  nb::class_<PoseDeviation>(module, "PoseDeviation")
      .def_ro("position", &PoseDeviation::position)
      .def_ro("theta", &PoseDeviation::theta);
  nb::class_<Member>(module, "Member")
      .def_ro("map", &Member::map)
      .def_prop_ro("transform", [](const Member& member) { return to_pose(member.T_component_map); })
      .def_ro("probability", &Member::probability)
      .def_ro("sd", &Member::sd)
      .def_ro("deformation", &Member::deformation);
  nb::class_<OpenWay>(module, "OpenWay")
      .def_ro("fixed", &OpenWay::fixed)
      .def_ro("moving", &OpenWay::moving)
      .def_prop_ro("transform", [](const OpenWay& way) { return to_pose(way.T_fixed_moving); })
      .def_ro("probability", &OpenWay::probability);
  nb::class_<Merged>(module, "Merged")
      .def("__deepcopy__", [](const nb::object& merged, const nb::object& /*memo*/) { return merged; })
      .def_prop_ro("maps", [](const Merged& merged) { return merged.maps; })
      .def_prop_ro("component_count", [](const Merged& merged) { return merged.result->components.size(); })
      .def(
          "grid", [](const Merged& merged, std::size_t i) { return grid_of(merged.result, i); },
          nb::arg("component"))
      .def(
          "members",
          [](const Merged& merged, std::size_t i) { return merged.result->components.at(i).members; },
          nb::arg("component"))
      .def(
          "counts",
          [](const Merged& merged, std::size_t i) {
            const FusedMap& fused = merged.result->components.at(i).fused;
            const auto omega = fused.omega ? std::optional(fused.omega->equal) : std::nullopt;
            return std::tuple(fused.agreeing, fused.conflicting, omega);
          },
          nb::arg("component"))
      .def(
          "is_in_world_frame",
          [](const Merged& merged, std::size_t i) { return merged.result->components.at(i).in_world_frame; },
          nb::arg("component"))
      .def_prop_ro("joins", [](const Merged& merged) { return merged.result->joins; })
      .def_prop_ro("open_ways", [](const Merged& merged) { return merged.result->open_ways; })
      .def_prop_ro("expected_false_joins",
                   [](const Merged& merged) { return merged.result->expected_false_joins; })
      .def_prop_ro("not_compared",
                   [](const Merged& merged) {
                     const std::optional<NotCompared>& left = merged.result->not_compared;
                     return left ? std::optional(std::pair(left->pairs, left->expected_joins)) : std::nullopt;
                   })
      .def_prop_ro("plan", [](const Merged& merged) { return merged.result->plan; })
      .def_prop_ro("left_out",
                   [](const Merged& merged) {
                     std::vector<std::tuple<std::size_t, std::string, std::string>> left_out;
                     for (const LeftOut& one : merged.result->left_out)
                       left_out.emplace_back(one.map, name_of(one.reason), explain(*merged.result, one));
                     return left_out;
                   })
      .def("state",
           [](const Merged& merged) {
             const std::string bytes = [&] {
               const OthersRun meanwhile;
               ByteWriter writer;
               writer.text(to_bytes(*merged.result));
               writer.byte(merged.plan ? 1 : 0);
               if (merged.plan) write_grid(*merged.plan, writer);
               return writer.take();
             }();
             return to_nb_bytes(bytes);
           })
      .def_static(
          "from_state",
          [](std::vector<Map> maps, const nb::bytes& state) {
            const std::string bytes = to_string(state);
            const OthersRun meanwhile;
            ByteReader reader(bytes);
            Merged merged{std::move(maps),
                          std::make_shared<const MergeResult>(merge_from_bytes(reader.text()))};
            if (reader.byte() != 0) merged.plan = std::make_shared<const OccupancyGrid>(read_grid(reader));
            if (!reader.is_at_end()) throw std::invalid_argument("holds more than a merge");
            return merged;
          },
          nb::arg("maps"), nb::arg("state"))
      .def("preview", &preview, nb::arg("names"))
      .def("export", &write_exported, nb::arg("format"), nb::arg("file"), nb::arg("names"),
           nb::arg("more_inputs"))
      .def("save", &save, nb::arg("directory"), nb::arg("names"), nb::arg("more_inputs"));
}

}  // namespace

void bind_merge(nb::module_& module) {
  bind_results(module);
  module.def(
      "validate_known_pose", [](const Known& known) { validate(*to_known_pose(known)); }, nb::arg("known"));
  module.def("merge", &merge_maps, nb::arg("maps"), nb::arg("known"), nb::arg("threads"),
             nb::arg("accept").none(), nb::arg("max_false_joins"), nb::arg("max_missed"),
             nb::arg("output_resolution"), nb::arg("up_the_tree"), nb::arg("transform"), nb::arg("search"),
             nb::arg("progress").none());
  module.def(
      "bent_map",
      [](const Map& map, const Deformation& deformation) {
        const OthersRun meanwhile;
        return Map{std::make_shared<const OccupancyGrid>(bent_map(*map.grid, deformation)), {}, {}};
      },
      nb::arg("map"), nb::arg("deformation"));
  module.def("map_transforms", [] {
    std::vector<std::string> names;
    for (const MapTransformName& one : map_transforms()) names.emplace_back(one.name);
    return names;
  });
  module.def("export_formats", [] {
    std::vector<std::string> names;
    for (const ExportFormat format : export_formats()) names.emplace_back(name_of(format));
    return names;
  });
  module.def(
      "map_colour",
      [](std::size_t map) {
        const Colour colour = map_colour(map);
        return std::tuple<int, int, int>(colour.red, colour.green, colour.blue);
      },
      nb::arg("map"));
}

}  // namespace gridmerge::python
