// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "internal_export.hpp"
#include "report/json_reader.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

/// What transforms.json says of a plan. `names[i]` is what to call map i, `component` the file of the maps on
/// the plan, "" if they are no component.
Json plan_json(const std::vector<std::string>& names, const PlanPlacement& plan,
               const std::string& component);

/// The file of the component on the plan, by component_file(); "" if there is none.
GRIDMERGE_INTERNAL_EXPORT std::string component_on_plan(const MergeResult& result);

/// The same read again, into the result, whose components have been read. Of maps with one name it is the
/// first that is in no part yet. Throws JsonError.
void read_plan(const JsonReader& json, const std::vector<std::string>& names, MergeResult& result);

}  // namespace gridmerge::internal
