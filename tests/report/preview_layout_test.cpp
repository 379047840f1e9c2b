// SPDX-License-Identifier: Apache-2.0
// Where the parts of a preview stand, to the pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/report/merge_output.hpp"
#include "io/png.hpp"
#include "merge/drawing.hpp"
#include "report/canvas.hpp"
#include "report/map_panel.hpp"
#include "report/preview_colours.hpp"
#include "report/results.hpp"
#include "report/style.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::map_from;
using Colours = PreviewColours;

constexpr int kGap = 24;  // around and between the parts

/// Maps that lie on each other.
MapPanel merged_panel(const std::string& title, const std::vector<const OccupancyGrid*>& maps,
                      std::size_t first) {
  MapPanel panel;
  panel.title = title;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    panel.maps.push_back({maps[i], {}});
    panel.colours.push_back(map_colour(first + i));
  }
  panel.resolution = maps[0]->resolution;
  panel.longest_side = std::max(maps[0]->width, maps[0]->height);
  panel.min_side = 1400;
  panel.min_width = 1000;
  panel.max_side = 2352;
  return panel;
}

MapPanel small_panel(const std::string& title, const OccupancyGrid& map, std::size_t index) {
  MapPanel panel;
  panel.title = title;
  panel.maps = {{&map, {}}};
  panel.colours = {map_colour(index)};
  panel.resolution = map.resolution;
  panel.longest_side = 1.0;
  panel.min_side = panel.min_width = 280;
  panel.max_side = 560;
  return panel;
}

Canvas written(const std::string& text, TextSize size) {
  Canvas canvas(text_width(text, size), size == TextSize::large ? 38 : 25, Style::kPage);
  canvas.write(0, 0, size, text, Style::kInk);
  return canvas;
}

/// 15 x 15 pixels of each colour in a line around both, and the text behind.
Canvas explained(Colour left, Colour right, const std::string& text) {
  Canvas canvas(38 + text_width(text, TextSize::small), 25, Style::kPage);
  canvas.fill(0, 5, 30, 15, Style::kLine);
  canvas.fill(1, 6, 14, 13, left);
  canvas.fill(15, 6, 14, 13, right);
  canvas.write(38, 0, TextSize::small, text, Style::kInk);
  return canvas;
}

Canvas explained_map(std::size_t map, const std::string& text) {
  return explained(map_colour(map), free_tint(map_colour(map)), text);
}

Canvas explained_sharing() {
  return explained(Colours::kSharedWall, Colours::kSharedFree, "in two maps or more");
}

Canvas explained_disagreement() {
  return explained(Colours::kDisagreement, shared_colour(7, 1),
                   "maps disagree: bright if half say wall and half say free, pale if few differ");
}

/// Rows of parts that stand beside each other.
Canvas in_rows(const std::vector<std::vector<Canvas>>& rows, int row_gap) {
  int width = 0, height = -row_gap;
  for (const std::vector<Canvas>& row : rows) {
    int end = -kGap, tallest = 0;
    for (const Canvas& part : row) {
      end += kGap + part.width();
      tallest = std::max(tallest, part.height());
    }
    width = std::max(width, end);
    height += row_gap + tallest;
  }
  Canvas canvas(width, height, Style::kPage);
  int y = 0;
  for (const std::vector<Canvas>& row : rows) {
    int x = 0, tallest = 0;
    for (const Canvas& part : row) {
      canvas.draw(x, y, part);
      x += part.width() + kGap;
      tallest = std::max(tallest, part.height());
    }
    y += tallest + row_gap;
  }
  return canvas;
}

Canvas legend_of(const std::vector<std::vector<Canvas>>& rows) {
  return in_rows(rows, 6);
}

/// Parts below each other.
void expect_page(const NamedMerge& merge, const std::vector<Canvas>& parts) {
  int width = 0, height = kGap;
  for (const Canvas& part : parts) {
    width = std::max(width, part.width());
    height += part.height() + kGap;
  }
  Canvas expected(width + 2 * kGap, height, Style::kPage);
  int y = kGap;
  for (const Canvas& part : parts) {
    expected.draw(kGap, y, part);
    y += part.height() + kGap;
  }
  const PngImage page = decode_png(preview_png(merge));
  ASSERT_EQ(page.width, expected.width());
  ASSERT_EQ(page.height, expected.height());
  const auto& samples = expected.image().samples;
  ASSERT_EQ(page.samples.size(), samples.size());
  const auto differs = std::mismatch(page.samples.begin(), page.samples.end(), samples.begin()).first;
  const auto at = static_cast<int>((differs - page.samples.begin()) / 3);
  EXPECT_TRUE(differs == page.samples.end()) << "at " << at % page.width << ", " << at / page.width;
}

TEST(PreviewLayout, MergedMapsThenTheLegendThenWhatWasLeftOut) {
  const std::vector<OccupancyGrid> maps{map_from({"#."}), map_from({".."}), map_from({"#"})};
  const std::vector<std::string> names{"a.yaml", "b.yaml", "c.yaml"};
  const MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  expect_page(
      {names, maps, result},
      {draw_panel(merged_panel("merged.yaml: 2 maps", {&maps[0], &maps[1]}, 0), TextSize::large),
       legend_of({{explained_map(0, "a.yaml"), explained_map(1, "b.yaml"), explained_sharing()},
                  {explained_disagreement()}}),
       written("Left out", TextSize::large), draw_panel(small_panel("c.yaml", maps[2], 2), TextSize::small)});
}

TEST(PreviewLayout, SeveralMergedMapsStandBelowEachOther) {
  const std::vector<OccupancyGrid> maps{map_from({"#."}), map_from({"#."}), map_from({"###"}),
                                        map_from({"..."})};
  const std::vector<std::string> names{"a", "b", "c", "d"};
  const MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}, {{2, {}}, {3, {}}}});
  expect_page({names, maps, result},
              {draw_panel(merged_panel("merged.yaml: 2 maps", {&maps[0], &maps[1]}, 0), TextSize::large),
               draw_panel(merged_panel("merged_2.yaml: 2 maps", {&maps[2], &maps[3]}, 2), TextSize::large),
               legend_of({{explained_map(0, "a"), explained_map(1, "b"), explained_map(2, "c"),
                           explained_map(3, "d"), explained_sharing()},
                          {explained_disagreement()}})});
}

TEST(PreviewLayout, TheLegendGoesOnBesideAsLongAsThereIsRoom) {
  const std::string name(50, 'm'), other(50, 'n');
  const Canvas first = explained_map(0, name), second = explained_map(1, other);
  const int together = first.width() + kGap + second.width();
  ASSERT_GT(together, 1001);
  ASSERT_LT(together, 2000);
  for (const int width : {together, together - 1}) {
    // A pixel is a cell, beside a margin of 12 on both sides.
    const std::vector<OccupancyGrid> maps(2, make_grid(width - 24, 1, 1.0, {}, Cell::free));
    const MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
    const Canvas panel =
        draw_panel(merged_panel("merged.yaml: 2 maps", {&maps[0], &maps[1]}, 0), TextSize::large);
    ASSERT_EQ(panel.width(), width);
    std::vector<std::vector<Canvas>> rows{{first, second}};
    if (width < together) rows = {{first}, {second}};
    const bool has_room =
        rows.back().size() == 1 && second.width() + kGap + explained_sharing().width() <= width;
    if (has_room) {
      rows.back().push_back(explained_sharing());
      rows.push_back({explained_disagreement()});
    } else {
      rows.push_back({explained_sharing(), explained_disagreement()});
    }
    expect_page({{name, other}, maps, result}, {panel, legend_of(rows)});
  }
}

TEST(PreviewLayout, NamesInTheLegendAreNoWiderThanThePage) {
  const std::vector<OccupancyGrid> maps{map_from({"#."}), map_from({".."})};
  const std::string name(300, 'm');
  const MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  const std::string cut = fit_width(name, TextSize::small, 1000 - 38);
  ASSERT_GT(cut.size(), 10u);
  expect_page({{name, "b"}, maps, result},
              {draw_panel(merged_panel("merged.yaml: 2 maps", {&maps[0], &maps[1]}, 0), TextSize::large),
               legend_of({{explained_map(0, cut)},
                          {explained_map(1, "b"), explained_sharing()},
                          {explained_disagreement()}})});
}

TEST(PreviewLayout, OfThirteenMapsThatWereLeftOutTwelveStandInRowsOfThree) {
  for (const std::size_t count : {12u, 13u}) {
    const std::vector<OccupancyGrid> maps(count, map_from({"#"}));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back("map" + std::to_string(i));
    std::vector<std::vector<Canvas>> rows(4);
    for (std::size_t i = 0; i < 12; ++i)
      rows[i / 3].push_back(draw_panel(small_panel(names[i], maps[i], i), TextSize::small));
    ASSERT_EQ(rows[0][0].width(), 280);
    const MergeResult result = test::merged(maps, {});
    expect_page(
        {names, maps, result},
        {written(count == 12 ? "Left out" : "Left out (and 1 more)", TextSize::small), in_rows(rows, kGap)});
  }
}

TEST(PreviewLayout, RowsAreAsHighAsTheHighestOfTheirMaps) {
  const std::vector<OccupancyGrid> maps{map_from({"#"}), map_from({"#", "#"}), map_from({"#"}),
                                        map_from({"#"})};
  const std::vector<std::string> names{"a", "b", "c", "d"};
  std::vector<Canvas> panels;
  for (std::size_t i = 0; i < 4; ++i)
    panels.push_back(draw_panel(small_panel(names[i], maps[i], i), TextSize::small));
  const MergeResult result = test::merged(maps, {});
  expect_page({names, maps, result}, {written("Left out", TextSize::small),
                                      in_rows({{panels[0], panels[1], panels[2]}, {panels[3]}}, kGap)});
}

TEST(PreviewLayout, AMapAloneOnThePlanStandsFirst) {
  const std::vector<OccupancyGrid> maps{map_from({"#"}, 0.5), map_from({"#..."}, 0.5), map_from({"#"}, 0.5)};
  const std::vector<std::string> names{"a", "b", "c"};
  const OccupancyGrid plan = map_from({"######", "#....#", "#....#", "######"}, 0.25);
  MergeResult result;
  for (std::size_t i = 0; i < 3; ++i) result.left_out.push_back({i, Reason::ambiguous});
  result.plan = PlanPlacement{"folder/floor.png", 2.0, {{{1}, {}, 2.0, 0.99, Reason::none}}, 0.25};
  const OccupancyGrid walls = map_from({"######", "#    #", "#    #", "######"}, 0.5);
  MapPanel panel = small_panel("b on floor.png", maps[1], 1);
  panel.longest_side = 6.0;
  panel.min_side = 1400;
  panel.min_width = 1000;
  panel.max_side = 2352;
  panel.plan = PlacedMap{&walls, {}};
  expect_page(
      {names, maps, result, &plan},
      {draw_panel(panel, TextSize::large),
       legend_of({{explained_map(1, "b"), explained(Colours::kPlan, Colours::kPlan, "walls of floor.png")}}),
       written("Left out", TextSize::large),
       in_rows({{draw_panel(small_panel("a", maps[0], 0), TextSize::small),
                 draw_panel(small_panel("c", maps[2], 2), TextSize::small)}},
               kGap)});
}

// Of many others twelve are shown, whichever of all maps is the one on the plan.
TEST(PreviewLayout, BesideAMapAloneOnThePlanTwelveOthersAreShown) {
  const OccupancyGrid plan = map_from({"###"}, 0.5);
  for (const auto& [lone, others] : {std::pair<std::size_t, std::size_t>{0, 12}, {12, 12}, {0, 13}}) {
    const std::vector<OccupancyGrid> maps(others + 1, map_from({"#"}, 1.0));
    std::vector<std::string> names;
    MergeResult result;
    for (std::size_t i = 0; i < maps.size(); ++i) {
      names.push_back("map" + std::to_string(i));
      result.left_out.push_back({i, Reason::ambiguous});
    }
    result.plan = PlanPlacement{"floor.png", 2.0, {{{lone}, {}, 2.0, 0.99, Reason::none}}, 0.5};
    std::vector<std::vector<Canvas>> rows(4);
    for (std::size_t i = 0, shown = 0; shown < 12; ++i) {
      if (i == lone) continue;
      rows[shown++ / 3].push_back(draw_panel(small_panel(names[i], maps[i], i), TextSize::small));
    }
    // The plan is drawn as far as the map is long on each side: the third of its cells is too far away.
    const OccupancyGrid near = map_from({"##"}, 1.0);
    MapPanel panel = merged_panel(names[lone] + " on floor.png", {&maps[lone]}, lone);
    panel.plan = PlacedMap{&near, {}};
    expect_page(
        {names, maps, result, &plan},
        {draw_panel(panel, TextSize::large),
         legend_of({{explained_map(lone, names[lone]),
                     explained(Colours::kPlan, Colours::kPlan, "walls of floor.png")}}),
         written(others == 12 ? "Left out" : "Left out (and 1 more)", TextSize::large), in_rows(rows, kGap)});
  }
}

TEST(PreviewLayout, BesideALongMapOnThePlanThereIsRoomForMoreInARow) {
  const std::vector<OccupancyGrid> maps{make_grid(1200, 1, 0.5, {}, Cell::free), map_from({"#"}, 0.5),
                                        map_from({"#"}, 0.5), map_from({"#"}, 0.5), map_from({"#"}, 0.5)};
  const std::vector<std::string> names{"a", "b", "c", "d", "e"};
  const OccupancyGrid plan = map_from({"#"}, 0.5);
  MergeResult result;
  std::vector<Canvas> others;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    result.left_out.push_back({i, Reason::ambiguous});
    if (i > 0) others.push_back(draw_panel(small_panel(names[i], maps[i], i), TextSize::small));
  }
  result.plan = PlanPlacement{"floor.png", 1.0, {{{0}, {}, 1.0, 0.99, Reason::none}}, 0.5};
  MapPanel panel = merged_panel("a on floor.png", {&maps[0]}, 0);
  panel.plan = PlacedMap{&plan, {}};
  const Canvas drawn = draw_panel(panel, TextSize::large);
  ASSERT_EQ(drawn.width(), 1200 + 24);
  expect_page(
      {names, maps, result, &plan},
      {drawn,
       legend_of({{explained_map(0, "a"), explained(Colours::kPlan, Colours::kPlan, "walls of floor.png")}}),
       written("Left out", TextSize::large), in_rows({others}, kGap)});
}

/// Two maps of 2 m x 0.5 m on a plan in which all is wall, in cells of 0.5 m by its scale: `walls` are drawn.
void expect_cut(const SE2& T_plan_cells, int width, int height, const OccupancyGrid& walls) {
  const std::vector<OccupancyGrid> maps(2, map_from({"#..#"}, 0.5, {0.5, 0.5, 0.0}));
  MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  result.plan = PlanPlacement{"floor.png", 2.0, {{{0, 1}, {}, 2.0, 0.99, Reason::none}}, 0.25};
  const OccupancyGrid plan = make_grid(width, height, 0.25, T_plan_cells, Cell::occupied);
  MapPanel panel = merged_panel("merged.yaml: 2 maps", {&maps[0], &maps[1]}, 0);
  panel.longest_side = 20.0;
  panel.plan = PlacedMap{&walls, {}};
  expect_page(
      {{"a", "b"}, maps, result, &plan},
      {draw_panel(panel, TextSize::large),
       legend_of({{explained_map(0, "a"), explained_map(1, "b"),
                   explained(Colours::kPlan, Colours::kPlan, "walls of floor.png"), explained_sharing()},
                  {explained_disagreement()}})});
}

TEST(PreviewLayout, APlanIsCutWhereItLiesFartherAwayThanTheMapsAreLong) {
  // The maps cover [0.5, 2.5] x [0.5, 1]. Cells of the plan are at their centres: these lie in
  // [-1.5, 4.5] x [-1.5, 3], here exactly on its edges, and a cell beyond each edge.
  expect_cut({-1.125, -1.125, 0.0}, 15, 12, make_grid(13, 10, 0.5, {-1.75, -1.75, 0.0}, Cell::occupied));
  // The same, a hundredth of a metre to the left and down: the first ones are too far away now; and to the
  // right and up: the last ones are.
  expect_cut({-1.125 - 0.005, -1.125 - 0.005, 0.0}, 15, 12,
             make_grid(12, 9, 0.5, {-1.26, -1.26, 0.0}, Cell::occupied));
  expect_cut({-1.125 + 0.005, -1.125 + 0.005, 0.0}, 15, 12,
             make_grid(12, 9, 0.5, {-1.74, -1.74, 0.0}, Cell::occupied));
}

TEST(PreviewLayout, APlanThatIsFarLongerThanTheMapsMakesThePictureCoarser) {
  // 500 m of maps on a plan of any length make 1500 m, 3000 cells: two of them are a pixel.
  for (const bool is_upright : {false, true}) {
    const auto along = [&](int length, double resolution, double from, Cell cell) {
      return is_upright ? make_grid(1, length, resolution, {0.0, from, 0.0}, cell)
                        : make_grid(length, 1, resolution, {from, 0.0, 0.0}, cell);
    };
    const std::vector<OccupancyGrid> maps(2, along(1000, 0.5, 0.0, Cell::free));
    MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
    result.plan = PlanPlacement{"floor.png", 1.0, {{{0, 1}, {}, 1.0, 0.99, Reason::none}}, 10.0};
    const OccupancyGrid plan = along(300, 10.0, -1000.0, Cell::occupied);
    const OccupancyGrid walls = along(150, 10.0, -500.0, Cell::occupied);
    MapPanel panel = merged_panel("merged.yaml: 2 maps", {&maps[0], &maps[1]}, 0);
    panel.longest_side = 3000.0;
    panel.plan = PlacedMap{&walls, {}};
    const Canvas drawn = draw_panel(panel, TextSize::large);
    if (is_upright) {
      ASSERT_EQ(drawn.height(), 50 + 1500 + 24 + 12 + 25);
    } else {
      ASSERT_EQ(drawn.width(), 1500 + 24);
    }
    std::vector<std::vector<Canvas>> rows{{explained_map(0, "a"), explained_map(1, "b"),
                                           explained(Colours::kPlan, Colours::kPlan, "walls of floor.png"),
                                           explained_sharing()}};
    if (is_upright) {
      rows.push_back({explained_disagreement()});
    } else {
      rows[0].push_back(explained_disagreement());
    }
    expect_page({{"a", "b"}, maps, result, &plan}, {drawn, legend_of(rows)});
  }
}

}  // namespace
}  // namespace gridmerge
