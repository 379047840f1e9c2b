// SPDX-License-Identifier: Apache-2.0
#include "plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "gridmerge/bag/bag.hpp"
#include "match/rounded_down.hpp"
#include "report/plan_json.hpp"
#include "search_options.hpp"

namespace gridmerge::cli {

using namespace internal;

void add_plan_options(CLI::App& command, PlanCommandOptions& options) {
  CLI::Option* plan =
      command
          .add_option("--plan", options.file,
                      "Hang the maps on this architect's plan, whose scale is unknown: a line drawing or a "
                      "map, as MAP. Maps that nothing else joins are joined by it. The merged map has the "
                      "plan's frame, in the maps' metres, and holds the maps alone. One MAP is enough "
                      "with it")
          ->type_name("PLAN");
  command
      .add_option("--plan-scale", options.scales,
                  "The factors by which the plan may be too small; 0.5:2 if not given. They count from "
                  "--resolution for a plan that is an image, or else from the first map's resolution")
      ->type_name("LO:HI")
      ->check(kScales)
      ->needs(plan);
}

Plan::Plan(const PlanCommandOptions& options, const std::vector<std::string>& names,
           const std::vector<OccupancyGrid>& maps, MapReader& reader)
    : options_(options), plan_(reader.read(options.file, maps.front().resolution, names.front())) {
  for (const std::string& name : names) {
    if (is_same_map(options.file, name))
      throw std::runtime_error(options.file + ": is one of the maps, and cannot be their plan too");
  }
  try {
    validate_plan(maps, plan_.grid);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(options.file + ": " + error.what());
  }
}

ScaleRange Plan::scales() const {
  return options_.scales.empty() ? PlanOptions{}.scales : to_scales(options_.scales);
}

MergeResult Plan::place(const std::vector<OccupancyGrid>& maps, MergeResult merged,
                        const MergeOptions& engine, Console& console) const {
  PlanOptions options;
  options.scales = scales();
  options.name = options_.file;
  options.progress = [&console](std::size_t done, std::size_t total) {
    console.progress("laying maps on the plan", static_cast<double>(done) / static_cast<double>(total));
  };
  try {
    return place_on_plan(maps, plan_.grid, std::move(merged), engine, options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(options_.file + ": " + error.what());
  }
}

namespace {

/// A place that is less probable than none is not to be had by asking for less.
constexpr double kWorthAsking = 0.5;

}  // namespace

std::string describe_plan(const AskedMerge& asked, const MergeResult& result) {
  if (!result.plan) return {};
  const PlanPlacement& plan = *result.plan;
  const std::size_t on_plan = plan.maps_on_plan().size();
  const std::string file = component_on_plan(result);
  std::string text = fmt::format("plan {}: ", escape_controls(plan.name));
  const auto out = std::back_inserter(text);
  if (on_plan == 0) {
    text += "no map hangs on it\n";
  } else {
    fmt::format_to(out, "{} of {} maps hang on it{}, enlarged by {:.4f} (probability {:.4f})\n", on_plan,
                   asked.names.size(), file.empty() ? std::string() : ", as " + file, plan.scale,
                   rounded_down(plan.probability()));
  }
  for (const PlanPart& part : plan.parts) {
    std::vector<std::string> maps;
    for (const std::size_t map : part.maps) maps.push_back(escape_controls(asked.names[map]));
    if (part.on_plan()) {
      if (file.empty())
        fmt::format_to(out, "  {}: {}\n", fmt::join(maps, ", "), describe_pose(part.T_plan_first));
      continue;
    }
    const std::string best = part.probability > 0.0
                                 ? fmt::format("; the best way: {}, the plan enlarged by {:.4f}",
                                               describe_pose(part.T_plan_first), part.scale)
                                 : std::string();
    fmt::format_to(out, "off the plan: {}: {} (probability {:.4f}{})\n", fmt::join(maps, ", "), explain(part),
                   rounded_down(part.probability), best);
  }
  const double most = std::accumulate(
      plan.parts.begin(), plan.parts.end(), 0.0,
      [](double probability, const PlanPart& part) { return std::max(probability, part.probability); });
  if (on_plan == 0 && most >= kWorthAsking)
    text += what_asks_for_less(asked, most, "the most probable place");
  return text;
}

}  // namespace gridmerge::cli
