// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "gridmerge/merge/plan.hpp"
#include "merge_summary.hpp"

namespace gridmerge::cli {

/// The plan that maps are to be hung on.
struct PlanCommandOptions {
  std::string file;    // no plan if empty
  std::string scales;  // LO:HI; the usual range if empty
};

/// --plan and --plan-scale.
void add_plan_options(CLI::App& command, PlanCommandOptions& options);

/// The plan of a merge.
class Plan {
 public:
  /// Reads it, and its warnings beside those of the maps, which are called so. Throws FileError for a file
  /// that is no map, and std::runtime_error for a plan without walls and one that is among the maps.
  Plan(const PlanCommandOptions& options, const std::vector<std::string>& names,
       const std::vector<OccupancyGrid>& maps, MapReader& reader);

  /// As it was read.
  const OccupancyGrid& grid() const { return plan_.grid; }

  ScaleRange scales() const;

  /// That it was read from.
  const std::vector<std::filesystem::path>& files() const { return plan_.files; }

  /// place_on_plan(). Errors name the plan.
  MergeResult place(const std::vector<OccupancyGrid>& maps, MergeResult merged, const MergeOptions& engine,
                    Console& console) const;

 private:
  PlanCommandOptions options_;
  LoadedMap plan_;
};

/// What became of the plan, in words; "" of a merge without one.
std::string describe_plan(const AskedMerge& asked, const MergeResult& result);

}  // namespace gridmerge::cli
