// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "gridmerge/report/merge_record.hpp"
#include "merge.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

/// The names of the maps, and the merge without maps.
std::pair<std::vector<nb::str>, Merged> read_record(const nb::bytes& path) {
  const std::filesystem::path given = to_string(path);
  MergeRecord record = [&] {
    const OthersRun meanwhile;
    return std::filesystem::is_directory(given) ? read_merge_record(given) : read_transforms(given);
  }();
  return {to_strs(record.names), {{}, std::make_shared<const MergeResult>(std::move(record.result))}};
}

}  // namespace

void bind_record(nb::module_& module) {
  module.def("read_transforms", &read_record, nb::arg("path"));
  module.def("component_file", &component_file, nb::arg("component"));
}

}  // namespace gridmerge::python
