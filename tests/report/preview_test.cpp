// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "gridmerge/report/merge_output.hpp"
#include "io/png.hpp"
#include "merge/drawing.hpp"
#include "report/map_panel.hpp"
#include "report/picture.hpp"
#include "report/preview_colours.hpp"
#include "report/results.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::map_from;
using test::Picture;
using test::rgb;
using test::Rgb;
using Colours = internal::PreviewColours;

Picture preview(const std::vector<OccupancyGrid>& maps, const std::vector<std::vector<Member>>& components) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < maps.size(); ++i) names.push_back("map" + std::to_string(i) + ".yaml");
  return {decode_png(preview_png({names, maps, test::merged(maps, components)}))};
}

TEST(Preview, ShowsWhoSawWhat) {
  // Beside each other: only a, both, only b. In the lowest row the maps contradict each other.
  const std::vector<OccupancyGrid> maps{map_from({"##..", "....", "...."}),
                                        map_from({"#...", "....", "###."})};
  const Picture picture = preview(maps, {{{0, {}}, {1, {1.0, 0.0, 0.0}}}});
  EXPECT_EQ(picture.cells(map_colour(0)), 1u) << "wall of a";
  EXPECT_EQ(picture.cells(Colours::kSharedWall), 1u);
  EXPECT_EQ(picture.cells(Colours::kDisagreement), 3u);
  EXPECT_EQ(picture.cells(Colours::kSharedFree), 5u);
}

TEST(Preview, TheFewerMapsDisagreeTheFainterItIs) {
  const auto colour_of = [](std::size_t walls, std::size_t frees, bool walls_first) {
    std::vector<OccupancyGrid> maps;
    std::vector<Member> members;
    for (std::size_t i = 0; i < walls + frees; ++i) {
      maps.push_back(map_from({(i < (walls_first ? walls : frees)) == walls_first ? "#" : "."}));
      members.push_back({i, {}});
    }
    return preview(maps, {members}).at(24 + 12 + 16, 24 + 48 + 12 + 16);  // in the only cell
  };
  const auto orange = rgb(Colours::kDisagreement);
  const auto red = [](Rgb colour) { return std::get<0>(colour); };
  const auto blue = [](Rgb colour) { return std::get<2>(colour); };
  EXPECT_EQ(colour_of(3, 3, true), orange);
  EXPECT_EQ(colour_of(0, 2, true), rgb(Colours::kSharedFree));
  EXPECT_EQ(colour_of(2, 0, true), rgb(Colours::kSharedWall));
  EXPECT_EQ(colour_of(1, 7, true), (Rgb{245, 215, 191})) << "a quarter of the way from white";
  int before = 255;
  for (std::size_t walls = 1; walls <= 4; ++walls) {
    const Rgb colour = colour_of(walls, 8 - walls, true);
    EXPECT_EQ(colour, colour_of(walls, 8 - walls, false)) << "whatever the order";
    EXPECT_LT(blue(colour), before);
    before = blue(colour);
  }
  before = red(orange);
  for (std::size_t walls = 5; walls <= 8; ++walls) {
    const Rgb colour = colour_of(walls, 8 - walls, true);
    EXPECT_LT(red(colour), before) << "more of them say wall: towards black";
    before = red(colour);
  }
}

TEST(Preview, NamesLackTheFoldersThatAllLieIn) {
  const std::vector<OccupancyGrid> maps{map_from({"#.."}), map_from({"..#"})};
  const MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  EXPECT_EQ(preview_png({{"/a/b/one", "/a/b/two"}, maps, result}),
            preview_png({{"one", "two"}, maps, result}));
  EXPECT_NE(preview_png({{"a/one", "b/two"}, maps, result}), preview_png({{"one", "two"}, maps, result}));
}

TEST(Preview, WallsOfTheSecondMapHaveItsColour) {
  const std::vector<OccupancyGrid> maps{map_from({"#.."}), map_from({"...##"})};
  const Picture picture = preview(maps, {{{0, {}}, {1, {1.0, 0.0, 0.0}}}});
  EXPECT_EQ(picture.cells(map_colour(0)), 1u);
  EXPECT_EQ(picture.cells(map_colour(1)), 2u);
  EXPECT_EQ(picture.cells(Colours::kSharedFree), 2u);
  EXPECT_EQ(picture.cells(Colours::kDisagreement), 0u);
}

TEST(Preview, NothingElseHasTheColourOfDisagreement) {
  const std::vector<OccupancyGrid> maps{map_from({"#.."}), map_from({"...##"})};
  const auto legend_only = preview(maps, {{{0, {}}, {1, {1.0, 0.0, 0.0}}}}).pixels(Colours::kDisagreement);
  EXPECT_FALSE(legend_only.empty());
  const auto [first, last] = std::minmax_element(legend_only.begin(), legend_only.end());
  EXPECT_LT(last->first - first->first, 64) << "the legend's sample only";
  EXPECT_LT(last->second - first->second, 32);
}

TEST(Preview, EighteenMapsHaveEighteenColours) {
  std::set<Rgb> colours{rgb(Colours::kUnknown), rgb(Colours::kSharedFree), rgb(Colours::kSharedWall),
                        rgb(Colours::kDisagreement)};
  for (std::size_t i = 0; i < 18; ++i) EXPECT_TRUE(colours.insert(rgb(map_colour(i))).second) << i;
  for (std::size_t i = 18; i < 100; ++i) EXPECT_NE(map_colour(i), Colours::kDisagreement) << i;
}

TEST(Preview, NorthIsUpAndEastIsRight) {
  const std::vector<OccupancyGrid> maps{map_from({"..#", "...", "..."}), map_from({"#"})};
  const Picture picture = preview(maps, {{{0, {}}, {1, {}}}});
  const auto shared_free = picture.pixels(Colours::kDisagreement);  // lower left: free in a, wall in b
  const auto wall = picture.pixels(map_colour(0));
  EXPECT_EQ(shared_free.front().second - wall.front().second, 2 * 32);
  EXPECT_EQ(wall.front().first - shared_free.front().first, 2 * 32);
}

TEST(Preview, PlacesMapsByTheirTransforms) {
  const std::vector<OccupancyGrid> maps{map_from({"."}),
                                        map_from({"##"}, 1.0, {0.0, 0.0, std::numbers::pi / 2})};
  const Picture picture = preview(maps, {{{0, {}}, {1, {3.0, 0.0, 0.0}}}});
  auto wall = picture.pixels(map_colour(1));
  std::erase_if(
      wall, [top = wall.front().second](const auto& pixel) { return pixel.second >= top + 64; });  // legend
  EXPECT_EQ(wall.size(), 2u * 32 * 32) << "upright";
  const auto [left, right] = std::minmax_element(wall.begin(), wall.end());
  EXPECT_EQ(right->first - left->first, 31) << "one cell wide";
  const auto free = picture.pixels(Colours::kUnknown);
  EXPECT_EQ(left->first - free.front().first, 12 + 2 * 32)
      << "to the left of x = 3, beyond the panel's margin";
}

TEST(Preview, LargeMapsAreDrawnCoarserAndKeepTheirWalls) {
  OccupancyGrid map = make_grid(9000, 400, 0.01, {}, Cell::free);
  test::draw_line(map, 0, 100, 8999, 300);
  const std::vector<OccupancyGrid> maps{map, map_from({"."})};
  const Picture picture = preview(maps, {{{0, {}}, {1, {}}}});
  EXPECT_GE(picture.image.width, 2000);
  std::set<int> columns;
  for (const auto& [x, y] : picture.pixels(map_colour(0))) columns.insert(x);
  EXPECT_GE(columns.size(), 2250u) << "a wall from end to end";
}

TEST(Preview, IsNoWiderThanItPromises) {
  // Lengths about those at which the drawing becomes coarser. Cells are counted from the second map's corner,
  // so the first one, where it is shifted, begins in the middle of a coarse cell.
  const OccupancyGrid frame = map_from({"."}, 0.1);
  for (const int length : {2327, 2328, 2329, 2352, 2376, 2400, 4654, 4656, 9600}) {
    const std::vector<OccupancyGrid> maps{make_grid(length, 2, 0.1, {}, Cell::free), frame};
    for (const double shift : {0.0, -0.1}) {
      EXPECT_LE(preview(maps, {{{0, {shift, 0.0, 0.0}}, {1, {}}}}).image.width, 2400) << length;
    }
    EXPECT_LE(preview(maps, {}).image.width, 2400) << length;
  }
}

TEST(Preview, TheScaleBarHasARoundLength) {
  for (const double resolution : {0.037, 3.0}) {
    for (const int width : {1, 137, 700}) {
      const std::vector<OccupancyGrid> maps{make_grid(width, 5, resolution, {}, Cell::free),
                                            map_from({"."}, resolution)};
      const Picture picture = preview(maps, {{{0, {}}, {1, {}}}});
      // The page's ink is drawn in text, in dots of a few pixels, and in the bar.
      int bar = 0;
      for (int y = 0; y < picture.image.height; ++y) {
        for (int x = 0, run = 0; x < picture.image.width; ++x) {
          run = picture.at(x, y) == Rgb{45, 45, 50} ? run + 1 : 0;
          bar = std::max(bar, run);
        }
      }
      const int zoom = std::clamp(1400 / std::max(width, 5), 1, 32);
      const double length = bar * resolution / zoom;
      const double power = std::pow(10.0, std::floor(std::log10(length) + 0.02));
      double error = 1.0;
      for (const double digit : {1.0, 2.0, 5.0})
        error = std::min(error, std::abs(length / power - digit) / digit);
      EXPECT_LT(error, 0.02) << bar << " pixels are " << length << " m";
      // The longest such length that is no more than a quarter of the drawing, which has a margin.
      const int quarter = std::max(std::max(width, 5) * zoom + 2 * 12, 1000) / 4;
      EXPECT_LE(bar, quarter + 1);
      EXPECT_GT(bar, 0.4 * quarter - 1);
    }
  }
}

TEST(Preview, MapsThatWereLeftOutAreShownByThemselves) {
  const std::vector<OccupancyGrid> maps{map_from({"#.."}), map_from({"##."}), map_from({"###"})};
  const Picture none = preview(maps, {});
  EXPECT_EQ(none.cells(map_colour(0)), 1u);
  EXPECT_EQ(none.cells(map_colour(1)), 2u);
  EXPECT_EQ(none.cells(map_colour(2)), 3u);
  const Picture some = preview(maps, {{{0, {}}, {1, {}}}});
  EXPECT_EQ(some.cells(map_colour(2)), 3u);
}

TEST(Preview, EveryComponentIsShown) {
  const std::vector<OccupancyGrid> maps{map_from({"#."}), map_from({".."}), map_from({"##"}),
                                        map_from({" ."})};
  const Picture picture = preview(maps, {{{0, {}}, {1, {}}}, {{2, {}}, {3, {}}}});
  EXPECT_EQ(picture.cells(Colours::kDisagreement), 2u) << "one in each";
  EXPECT_EQ(picture.cells(map_colour(2)), 1u);
}

/// The longest run of a colour in a row of the picture.
int longest_run(const Picture& picture, Colour colour) {
  int longest = 0;
  for (int y = 0; y < picture.image.height; ++y) {
    for (int x = 0, run = 0; x < picture.image.width; ++x) {
      run = picture.at(x, y) == rgb(colour) ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  return longest;
}

/// A wall along the whole length.
OccupancyGrid wall_of(int cells) {
  return make_grid(cells, 1, 0.05, {}, Cell::occupied);
}

TEST(Preview, MergedMapsFillThePage) {
  const OccupancyGrid other = map_from({"."}, 0.05);
  const auto drawn = [&](int cells) {
    return longest_run(preview({wall_of(cells), other}, {{{0, {}}, {1, {0.0, 1.0, 0.0}}}}), map_colour(0));
  };
  EXPECT_EQ(drawn(20), 20 * 32);  // a cell is no wider than that
  EXPECT_EQ(drawn(100), 100 * 14);
  EXPECT_EQ(drawn(1400), 1400);
  EXPECT_EQ(drawn(2327), 2327);  // a page of 2400 pixels, less its margin and the drawing's
  EXPECT_EQ(drawn(2328), 1164);  // two cells a pixel
}

TEST(Preview, MapsThatWereLeftOutAreSmall) {
  const auto drawn = [](int cells) { return longest_run(preview({wall_of(cells)}, {}), map_colour(0)); };
  EXPECT_EQ(drawn(4), 4 * 32);
  EXPECT_EQ(drawn(100), 100 * 2);
  EXPECT_EQ(drawn(280), 280);
  EXPECT_EQ(drawn(534), 534);  // a panel of 560 pixels, less its margin
  EXPECT_EQ(drawn(535), 268);
  EXPECT_EQ(drawn(1069), 535);
}

TEST(Preview, TheLegendHasASampleOfTheWallsAndTheFreeSpaceOfEachMap) {
  // Two maps that share all they know, so that their own colours are in the legend alone.
  const std::vector<OccupancyGrid> maps{map_from({"#."}), map_from({"#."})};
  const Picture picture = preview(maps, {{{0, {}}, {1, {}}}});
  for (const std::size_t map : {0u, 1u}) {
    const auto wall = picture.pixels(map_colour(map)), free = picture.pixels(free_tint(map_colour(map)));
    ASSERT_FALSE(wall.empty());
    EXPECT_EQ(wall.size(), free.size());
    const auto [left, top] = wall.front();
    const int side = free.front().first - left;  // beside each other, in a frame of a pixel
    EXPECT_EQ(free.front().second, top);
    EXPECT_EQ(wall.size(), static_cast<std::size_t>(side * (side - 1)));
    EXPECT_EQ(wall.back(), std::pair(left + side - 1, top + side - 2));
    const Rgb line{170, 170, 165};
    EXPECT_EQ(picture.at(left - 1, top - 1), line);
    EXPECT_EQ(picture.at(left + 2 * side, top + side - 1), line);
    EXPECT_NE(picture.at(left - 2, top), line);
    EXPECT_NE(picture.at(left + 2 * side + 1, top), line);
  }
  EXPECT_EQ(free_tint({255, 0, 155}), (Colour{255, 194, 231}));  // a quarter of the colour, of 100 parts 24
}

TEST(Preview, OfNothingIsAnEmptyPage) {
  const PngImage page = decode_png(preview_png({{}, {}, {}}));
  EXPECT_EQ(page.width, 1 * 48);
  EXPECT_EQ(page.height, 24);
}

TEST(Preview, ManyMapsStayReadable) {
  const std::vector<OccupancyGrid> maps(100, map_from({"#."}));
  std::vector<Member> members;
  for (std::size_t i = 0; i < 40; ++i) members.push_back({i, {static_cast<double>(i), 0.0, 0.0}});
  const Picture picture = preview(maps, {members});
  EXPECT_LT(picture.image.width, 2000);
  EXPECT_LT(picture.image.height, 4000);
}

TEST(Preview, OfManyComponentsTheFirstTwelveAreShown) {
  std::vector<OccupancyGrid> maps;
  std::vector<std::vector<Member>> components;
  for (std::size_t i = 0; i < 50; ++i) {
    maps.insert(maps.end(), {map_from({"#."}), map_from({".."})});
    components.push_back({{2 * i, {}}, {2 * i + 1, {}}});
  }
  const Picture picture = preview(maps, components);
  EXPECT_EQ(picture.cells(Colours::kDisagreement), 12u) << "one in each";
  components.resize(12);
  maps.resize(24);
  const int note = picture.image.height - preview(maps, components).image.height;
  EXPECT_GT(note, 0);
  EXPECT_LT(note, 200);
}

TEST(Preview, OddMapsAndNames) {
  std::vector<OccupancyGrid> maps;
  for (std::size_t i = 0; i < test::kHostileNames.size(); ++i)
    maps.push_back(make_grid(1, 1, 1e-6, {1e9, 0.0, 1.0}));
  maps[0] = make_grid(1, 1, 1000.0, {}, Cell::occupied);
  maps[1] = make_grid(1, 2000, 0.05, {}, Cell::occupied);
  for (const auto& components :
       std::vector<std::vector<std::vector<Member>>>{{}, {{{0, {}}, {2, {}}}}, {{{1, {}}, {3, {}}}}}) {
    const std::string png = preview_png({test::kHostileNames, maps, test::merged(maps, components)});
    EXPECT_GT(decode_png(png).width, 0);
  }
  EXPECT_GT(decode_png(preview_png({{}, {}, {}})).width, 0);
}

TEST(Preview, EveryMapNeedsAName) {
  const std::vector<OccupancyGrid> maps{map_from({"#"}), map_from({"#"})};
  EXPECT_THROW(preview_png({{"a"}, maps, test::merged(maps, {})}), std::out_of_range);
  EXPECT_THROW(preview_png({{"a"}, maps, test::merged(maps, {{{0, {}}, {1, {}}}})}), std::out_of_range);
}

}  // namespace
}  // namespace gridmerge
