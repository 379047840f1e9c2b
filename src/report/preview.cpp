// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "match/scaled_pose.hpp"
#include "report/canvas.hpp"
#include "report/map_panel.hpp"
#include "report/plan_layer.hpp"
#include "report/preview_colours.hpp"
#include "report/short_names.hpp"
#include "report/style.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr int kGap = 24;       // around and between the parts of the page [pixels]
constexpr int kLegendGap = 6;  // between its lines [pixels]
constexpr int kPageMinWidth = 1000, kPageMaxWidth = 2400;
constexpr int kComponentMinSide = 1400, kComponentMaxSide = kPageMaxWidth - 2 * kGap;
constexpr int kLeftOutMinSide = 280, kLeftOutMaxSide = 560;
constexpr std::size_t kMaxComponentPanels = 12;  // or the picture of a fleet is 40,000 pixels high
constexpr std::size_t kMaxLeftOutPanels = 12;

MapPanel component_panel(const std::vector<OccupancyGrid>& maps, const MergeResult& result,
                         std::size_t index) {
  const Component& component = result.components[index];
  MapPanel panel;
  panel.title = fmt::format("{}: {} maps", component_file(index), component.members.size());
  for (const Member& member : component.members) {
    panel.maps.push_back({&maps.at(member.map), member.T_component_map});
    panel.deformations.push_back(member.deformation);
    panel.colours.push_back(map_colour(member.map));
  }
  const OccupancyGrid& fused = component.fused.grid;
  panel.resolution = fused.resolution;
  panel.longest_side = std::max(fused.width, fused.height);
  panel.min_side = kComponentMinSide;
  panel.min_width = kPageMinWidth;
  panel.max_side = kComponentMaxSide;
  return panel;
}

MapPanel left_out_panel(const std::string& name, const OccupancyGrid& map, std::size_t index) {
  MapPanel panel;
  panel.title = name;
  panel.maps = {{&map, {}}};
  panel.colours = {map_colour(index)};
  const OccupancyGrid known = crop_to_known(map);
  panel.resolution = map.resolution;
  panel.longest_side = std::hypot(known.width, known.height);  // whatever the yaw of the origin
  panel.min_side = kLeftOutMinSide;
  panel.min_width = kLeftOutMinSide;
  panel.max_side = kLeftOutMaxSide;
  return panel;
}

/// The walls of a plan, at its scale, under the maps that hang on it.
class PlanUnderMaps {
 public:
  explicit PlanUnderMaps(const NamedMerge& merge) {
    if (!merge.plan || !merge.result.plan) return;
    for (const PlanPlace& place : plan_places(merge.result)) {
      if (place.on_plan) place_ = place;  // all are one component, or one map
    }
    plan_ = merge.plan;
    name_ = short_names({merge.result.plan->name}).front();
  }

  const std::string& name() const { return name_; }

  /// The map that hangs there alone.
  std::optional<std::size_t> lone_map() const {
    return place_ && !place_->component ? std::optional(place_->map) : std::nullopt;
  }

  bool is_under(std::size_t component) const { return place_ && place_->component == component; }

  /// Whether it is under one of so many components, those first, or under a lone map.
  bool is_drawn(std::size_t components) const {
    return place_ && (!place_->component || *place_->component < components);
  }

  /// Into a panel, which grows as far as the plan reaches, but by its longer side on each side at most: the
  /// maps would be lost on the plan of a whole site. Nothing where no map may be as large as the plan at its
  /// scale.
  void draw_into(MapPanel& panel) {
    if (!is_scalable(*plan_, place_->scale)) return;
    Box box = covered_box(panel.maps, panel.deformations);
    walls_ = scaled(walls_of_plan(*plan_), place_->scale);
    const double margin = std::max(box.max_x - box.min_x, box.max_y - box.min_y);
    cut_walls({box.min_x - margin, box.min_y - margin, box.max_x + margin, box.max_y + margin});
    panel.plan = {&walls_, place_->T_scene_plan};
    box.add(covered_box({*panel.plan}, {}));
    panel.longest_side = std::max(box.max_x - box.min_x, box.max_y - box.min_y) / panel.resolution;
  }

 private:
  void cut_walls(const Box& box) {
    for (int row = 0; row < walls_.height; ++row) {
      for (int column = 0; column < walls_.width; ++column) {
        const Point2 p = place_->T_scene_plan * walls_.cell_centre(column, row);
        if (p.x < box.min_x || p.x > box.max_x || p.y < box.min_y || p.y > box.max_y)
          walls_.at(column, row) = Cell::unknown;
      }
    }
  }

  const OccupancyGrid* plan_ = nullptr;
  std::optional<PlanPlace> place_;
  OccupancyGrid walls_;  // of the panel that was drawn into
  std::string name_;
};

// Puts the parts beside each other, in as many rows as the width asks for.
Canvas flow(const std::vector<Canvas>& parts, int width, int row_gap) {
  struct Spot {
    int x, y;
  };
  std::vector<Spot> spots;
  int x = 0, y = 0, row_height = 0, used_width = 1;
  for (const Canvas& part : parts) {
    if (x > 0 && x + part.width() > width) {
      x = 0;
      y += row_height + row_gap;
      row_height = 0;
    }
    spots.push_back({x, y});
    used_width = std::max(used_width, x + part.width());
    row_height = std::max(row_height, part.height());
    x += part.width() + kGap;
  }
  Canvas canvas(used_width, std::max(1, y + row_height), Style::kPage);
  for (std::size_t i = 0; i < parts.size(); ++i) canvas.draw(spots[i].x, spots[i].y, parts[i]);
  return canvas;
}

// A label after a sample of what it explains: two colours beside each other.
Canvas legend_entry(Colour left, Colour right, const std::string& label, int width) {
  constexpr TextSize kSize = TextSize::small;
  const int side = baseline(kSize) - baseline(kSize) / 4;
  const int text_x = 2 * side + gap_of(kSize);
  const std::string text = fit_width(label, kSize, width - text_x);
  Canvas canvas(text_x + text_width(text, kSize), line_height(kSize), Style::kPage);
  const int top = baseline(kSize) - side;
  canvas.fill(0, top, 2 * side, side, Style::kLine);
  canvas.fill(1, top + 1, side - 1, side - 2, left);
  canvas.fill(side, top + 1, side - 1, side - 2, right);
  canvas.write(text_x, 0, kSize, text, Style::kInk);
  return canvas;
}

std::vector<Canvas> legend(const std::vector<std::string>& names, std::span<const Component> components,
                           const PlanUnderMaps& plan, int width) {
  std::vector<Canvas> entries;
  for (const Component& component : components) {
    for (const Member& member : component.members) {
      const Colour colour = map_colour(member.map);
      entries.push_back(legend_entry(colour, free_tint(colour), names.at(member.map), width));
    }
  }
  using Colours = PreviewColours;
  if (const std::optional<std::size_t> map = plan.lone_map()) {
    const Colour colour = map_colour(*map);
    entries.push_back(legend_entry(colour, free_tint(colour), names.at(*map), width));
  }
  if (plan.is_drawn(components.size()))
    entries.push_back(legend_entry(Colours::kPlan, Colours::kPlan, "walls of " + plan.name(), width));
  if (components.empty()) return entries;
  entries.push_back(legend_entry(Colours::kSharedWall, Colours::kSharedFree, "in two maps or more", width));
  entries.push_back(
      legend_entry(Colours::kDisagreement, shared_colour(7, 1),
                   "maps disagree: bright if half say wall and half say free, pale if few differ", width));
  return entries;
}

Canvas heading(const std::string& text, TextSize size) {
  Canvas canvas(text_width(text, size), line_height(size), Style::kPage);
  canvas.write(0, 0, size, text, Style::kInk);
  return canvas;
}

Canvas stack(const std::vector<Canvas>& blocks, int gap) {
  int width = 0, height = gap;
  for (const Canvas& block : blocks) {
    width = std::max(width, block.width());
    height += block.height() + gap;
  }
  Canvas canvas(width + 2 * gap, height, Style::kPage);
  int y = gap;
  for (const Canvas& block : blocks) {
    canvas.draw(gap, y, block);
    y += block.height() + gap;
  }
  return canvas;
}

}  // namespace

Colour map_colour(std::size_t map) {
  // Okabe and Ito's palette without black, without vermilion, which is the colour of disagreement, and with a
  // violet instead of the yellow: darkened enough for walls on white, it is orange to eyes without red cones.
  constexpr std::array<Colour, 6> kPalette{
      {{0, 114, 178}, {230, 159, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {120, 40, 220}}};
  const Colour colour = kPalette[map % kPalette.size()];
  const auto shade = [&](std::uint8_t channel) {
    switch (map / kPalette.size() % 3) {
      case 1:
        return static_cast<std::uint8_t>(channel * 6 / 10);
      case 2:
        return static_cast<std::uint8_t>(channel + (255 - channel) * 4 / 10);
      default:
        return channel;
    }
  };
  return {shade(colour.red), shade(colour.green), shade(colour.blue)};
}

std::string preview_png(const NamedMerge& merge) {
  const auto& [names, maps, result, drawing] = merge;
  PlanUnderMaps plan(merge);
  const std::vector<std::string> called = short_names(names);
  const bool is_any_merged = !result.components.empty() || plan.lone_map();
  const TextSize size = is_any_merged ? TextSize::large : TextSize::small;
  std::vector<Canvas> blocks;
  int width = kPageMinWidth;
  const std::size_t components = std::min(result.components.size(), kMaxComponentPanels);
  for (std::size_t i = 0; i < components; ++i) {
    MapPanel panel = component_panel(maps, result, i);
    if (plan.is_under(i)) plan.draw_into(panel);
    blocks.push_back(draw_panel(panel, size));
    width = std::max(width, blocks.back().width());
  }
  if (const std::size_t more = result.components.size() - components; more > 0)
    blocks.push_back(heading(fmt::format("And {} more merged maps", more), size));
  if (const std::optional<std::size_t> map = plan.lone_map()) {
    MapPanel panel = left_out_panel(called.at(*map), maps.at(*map), *map);
    panel.title = fmt::format("{} on {}", called[*map], plan.name());
    panel.min_side = kComponentMinSide;
    panel.min_width = kPageMinWidth;
    panel.max_side = kComponentMaxSide;
    plan.draw_into(panel);
    blocks.push_back(draw_panel(panel, size));
    width = std::max(width, blocks.back().width());
  }
  const std::vector<Canvas> entries =
      legend(called, std::span(result.components).first(components), plan, width);
  if (!entries.empty()) blocks.push_back(flow(entries, width, kLegendGap));

  std::vector<Canvas> left_out;
  for (const LeftOut& one : result.left_out) {
    if (left_out.size() == kMaxLeftOutPanels) break;
    const std::size_t map = one.map;
    if (plan.lone_map() == map) continue;
    left_out.push_back(draw_panel(left_out_panel(called.at(map), maps.at(map), map), TextSize::small));
  }
  if (!left_out.empty()) {
    const std::size_t more = result.left_out.size() - left_out.size() - (plan.lone_map() ? 1 : 0);
    blocks.push_back(heading(more == 0 ? "Left out" : fmt::format("Left out (and {} more)", more), size));
    blocks.push_back(flow(left_out, width, kGap));
  }
  return encode_png(stack(blocks, kGap).image());
}

}  // namespace gridmerge
