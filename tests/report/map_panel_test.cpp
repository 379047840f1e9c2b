// SPDX-License-Identifier: Apache-2.0
#include "report/map_panel.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "merge/drawing.hpp"
#include "report/preview_colours.hpp"
#include "report/style.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::map_from;
using Colours = PreviewColours;

constexpr Colour kRed{200, 20, 0}, kBlue{0, 100, 200};
constexpr int kMargin = 12;  // around the maps [pixels]

/// A panel of maps that lie where they are, and must live as long; cells have 1 m.
MapPanel panel_of(const std::vector<OccupancyGrid>& maps) {
  MapPanel panel;
  panel.title = "title";
  for (const OccupancyGrid& map : maps) panel.maps.push_back({&map, {}});
  panel.colours = {kRed, kBlue};
  panel.resolution = 1.0;
  panel.longest_side = 1.0;
  panel.min_width = 200;
  panel.min_side = 10;
  panel.max_side = 1000;
  return panel;
}

MapPanel panel_of(std::vector<OccupancyGrid>&&) = delete;

/// The same pixels; says where the first other one is.
void expect_equal(const Canvas& drawn, const Canvas& expected) {
  ASSERT_EQ(drawn.width(), expected.width());
  ASSERT_EQ(drawn.height(), expected.height());
  const auto &a = drawn.image().samples, &b = expected.image().samples;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto width = static_cast<std::size_t>(drawn.width());
    ASSERT_EQ(int{a[i]}, int{b[i]}) << "at " << i / 3 % width << ", " << i / 3 / width;
  }
}

/// A bar of so many pixels at the left, with what is written beside it.
void draw_bar(Canvas& canvas, int y, int length, const std::string& label) {
  canvas.fill(0, y + 11, length, 2, Style::kInk);
  canvas.fill(0, y + 5, 2, 15, Style::kInk);
  canvas.fill(length - 2, y + 5, 2, 15, Style::kInk);
  canvas.write(length + 8, y, TextSize::small, label, Style::kInk);
}

TEST(MapPanel, HasATitleAboveAndABarBelow) {
  const std::vector<OccupancyGrid> maps{map_from({"#..", "..#"})};
  // A metre has 13 pixels, so 2 m are what fits a quarter of the width.
  MapPanel panel = panel_of(maps);
  panel.min_side = 39;
  for (const TextSize size : {TextSize::small, TextSize::large}) {
    const int zoom = 13, drawing_y = size == TextSize::small ? 25 + 8 : 38 + 12;
    const int bar_y = drawing_y + 2 * zoom + 2 * kMargin + (size == TextSize::small ? 8 : 12);
    Canvas expected(200, bar_y + 25, Style::kPage);
    expected.write(0, 0, size, "title", Style::kInk);
    expected.fill(0, drawing_y, 3 * zoom + 2 * kMargin, 2 * zoom + 2 * kMargin, Colours::kUnknown);
    expected.fill(kMargin, drawing_y + kMargin, 3 * zoom, 2 * zoom, free_tint(kRed));
    expected.fill(kMargin, drawing_y + kMargin, zoom, zoom, kRed);
    expected.fill(kMargin + 2 * zoom, drawing_y + kMargin + zoom, zoom, zoom, kRed);
    draw_bar(expected, bar_y, 26, "2 m");
    expect_equal(draw_panel(panel, size), expected);
  }
}

/// The colours of the cells, top row first, of a panel whose cells have 10 pixels.
std::vector<Colour> cells_of(const MapPanel& panel, int columns, int rows) {
  const Canvas drawn = draw_panel(panel, TextSize::small);
  EXPECT_EQ(drawn.height(), 25 + 8 + 10 * rows + 2 * kMargin + 8 + 25);
  std::vector<Colour> colours;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto at = static_cast<std::size_t>((33 + kMargin + 10 * row + 5) * drawn.width() + kMargin +
                                               10 * column + 5) *
                      3;
      const std::vector<std::uint8_t>& samples = drawn.image().samples;
      colours.push_back({samples[at], samples[at + 1], samples[at + 2]});
    }
  }
  return colours;
}

TEST(MapPanel, EachCellHasTheColourOfWhatIsSaidOfIt) {
  const std::vector<OccupancyGrid> maps{map_from({"#. #.#. "}), map_from({"  .#.. #"})};
  MapPanel panel = panel_of(maps);
  panel.min_side = 80;
  EXPECT_EQ(cells_of(panel, 8, 1),
            (std::vector<Colour>{kRed, free_tint(kRed), free_tint(kBlue), Colours::kSharedWall,
                                 Colours::kSharedFree, Colours::kDisagreement, free_tint(kRed), kBlue}));
  // A wall of the plan is drawn where no map has one.
  const OccupancyGrid plan = map_from({"########"});
  panel.plan = PlacedMap{&plan, {}};
  EXPECT_EQ(cells_of(panel, 8, 1),
            (std::vector<Colour>{kRed, Colours::kPlan, Colours::kPlan, Colours::kSharedWall, Colours::kPlan,
                                 Colours::kDisagreement, Colours::kPlan, kBlue}));
  // Nothing else of the plan is drawn.
  const OccupancyGrid free = map_from({"........"});
  panel.plan = PlacedMap{&free, {}};
  EXPECT_EQ(cells_of(panel, 8, 1)[2], free_tint(kBlue));
}

TEST(MapPanel, OfSeveralMapsTheFirstThatSeesACellGivesItItsColour) {
  const std::vector<OccupancyGrid> maps{map_from({"  ."}), map_from({"#. "})};
  MapPanel panel = panel_of(maps);
  panel.min_side = 30;
  EXPECT_EQ(cells_of(panel, 3, 1), (std::vector<Colour>{kBlue, free_tint(kBlue), free_tint(kRed)}));
}

TEST(MapPanel, DrawsBentMapsAsTheyLie) {
  const std::vector<OccupancyGrid> maps{map_from({"#...", "...."}), map_from({"...."})};
  MapPanel panel = panel_of(maps);
  panel.maps = {{&maps[0], {}}, {&maps[1], {}}};
  panel.min_side = 40;
  // By a cell upwards: the second map lies on the upper row of the first.
  panel.deformations = {{}, {{-2.0, -2.0, 0.0}, 8.0, 4, 4, std::vector<Point2>(16, {0.0, 1.0})}};
  EXPECT_EQ(cells_of(panel, 4, 2),
            (std::vector<Colour>{Colours::kDisagreement, Colours::kSharedFree, Colours::kSharedFree,
                                 Colours::kSharedFree, free_tint(kRed), free_tint(kRed), free_tint(kRed),
                                 free_tint(kRed)}));
}

TEST(MapPanel, ABarIsAsLongAsARoundNumberOfMetres) {
  // A cell has 32 pixels, and the bar a quarter of the width at most.
  const auto expect_bar = [](double resolution, int width, int length, const std::string& label) {
    const std::vector<OccupancyGrid> maps{map_from({"#"}, resolution)};
    MapPanel panel = panel_of(maps);
    panel.resolution = resolution;
    panel.min_side = 32;
    panel.min_width = width;
    const int bar_y = 33 + 32 + 2 * kMargin + 8;
    Canvas expected(width, bar_y + 25, Style::kPage);
    expected.draw(0, 0, draw_panel(panel, TextSize::small));
    expected.fill(0, bar_y, width, 25, Style::kPage);
    draw_bar(expected, bar_y, length, label);
    SCOPED_TRACE(label);
    expect_equal(draw_panel(panel, TextSize::small), expected);
  };
  expect_bar(5.0, 128, 32, "5 m");
  expect_bar(5.0, 127, 13, "2 m");  // a pixel less than 5 m
  expect_bar(2.0, 128, 32, "2 m");
  expect_bar(2.0, 127, 16, "1 m");
  expect_bar(1.0, 128, 32, "1 m");
  expect_bar(1.0, 127, 16, "0.5 m");
  expect_bar(0.03125, 400, 51, "0.05 m");
  expect_bar(1000.0, 128, 32, "1000 m");
  expect_bar(1000.0, 200, 32, "1000 m");
}

TEST(MapPanel, IsAsWideAsTheWidestOfItsParts) {
  const std::vector<OccupancyGrid> maps{map_from({"#"})};
  MapPanel panel = panel_of(maps);
  panel.min_side = 1;
  panel.min_width = 0;
  // 1 pixel and its margin: the scale, a quarter of that, is wider with what is written beside it.
  const Canvas narrow = draw_panel(panel, TextSize::small);
  EXPECT_EQ(narrow.width(), 5 + 8 + text_width("5 m", TextSize::small));
  const std::vector<OccupancyGrid> wide{map_from({"####"})};
  panel.maps = {{&wide[0], {}}};
  panel.min_side = 128;
  EXPECT_EQ(draw_panel(panel, TextSize::small).width(), 128 + 2 * kMargin);
  panel.min_width = 128 + 2 * kMargin + 1;
  EXPECT_EQ(draw_panel(panel, TextSize::small).width(), 128 + 2 * kMargin + 1);
}

TEST(MapPanel, ALongTitleIsCut) {
  const std::vector<OccupancyGrid> maps{map_from({"#"})};
  MapPanel panel = panel_of(maps), cut = panel;
  panel.title = std::string(100, 'a');
  cut.title = fit_width(panel.title, TextSize::large, 200);
  EXPECT_NE(cut.title, panel.title);
  expect_equal(draw_panel(panel, TextSize::large), draw_panel(cut, TextSize::large));
}

TEST(MapPanel, IsMagnifiedInWholePixelsAndDrawnCoarserInWholeCells) {
  const std::vector<OccupancyGrid> maps{make_grid(50, 3, 1.0, {}, Cell::occupied)};
  MapPanel panel = panel_of(maps);
  const auto expect_size = [&](int width, int height) {
    const Canvas drawn = draw_panel(panel, TextSize::small);
    EXPECT_EQ(drawn.width(), width + 2 * kMargin);
    EXPECT_EQ(drawn.height(), 33 + height + 2 * kMargin + 33);
  };
  panel.min_width = 0;
  panel.longest_side = 50.0;
  panel.min_side = 100;
  expect_size(100, 6);
  panel.min_side = 149;
  expect_size(100, 6);
  panel.min_side = 150;
  expect_size(150, 9);
  panel.min_side = 32 * 50 - 1;
  expect_size(31 * 50, 31 * 3);
  panel.min_side = 33 * 50;  // no cell is wider
  expect_size(32 * 50, 32 * 3);
  panel.min_side = 1;
  expect_size(50, 3);
  // A cell less than there is room for beside the margin.
  panel.max_side = 50 + 2 * kMargin + 1;
  expect_size(50, 3);
  panel.max_side = 50 + 2 * kMargin;
  panel.min_width = 25 + 2 * kMargin;
  const Canvas coarser = draw_panel(panel, TextSize::small);
  EXPECT_EQ(coarser.height(), 33 + 2 + 2 * kMargin + 33);
}

TEST(MapPanel, OfATallMapTheHeightCounts) {
  const std::vector<OccupancyGrid> maps{make_grid(3, 50, 1.0, {}, Cell::occupied)};
  MapPanel panel = panel_of(maps);
  panel.min_side = 100;
  EXPECT_EQ(draw_panel(panel, TextSize::small).height(), 33 + 100 + 2 * kMargin + 33);
}

TEST(MapPanel, TintsAndSharesAreThoseOfTheReportPage) {
  EXPECT_EQ(free_tint({255, 0, 155}), (Colour{255, 194, 231}));
  EXPECT_EQ(shared_colour(1, 1), Colours::kDisagreement);
  EXPECT_EQ(shared_colour(2, 0), Colours::kSharedFree);
  EXPECT_EQ(shared_colour(0, 2), Colours::kSharedWall);
  EXPECT_EQ(shared_colour(3, 1), mix(Colours::kSharedFree, Colours::kDisagreement, 0.5));
  EXPECT_EQ(shared_colour(1, 3), mix(Colours::kSharedWall, Colours::kDisagreement, 0.5));
}

}  // namespace
}  // namespace gridmerge
