// SPDX-License-Identifier: Apache-2.0
#include "io/interpret.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

#include "io/support.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;
using Cells = std::vector<Cell>;
using Warnings = std::vector<std::string>;

constexpr Cell kUnknown = Cell::unknown, kFree = Cell::free, kOccupied = Cell::occupied;

MapYaml yaml_of(MapMode mode = MapMode::trinary) {
  MapYaml yaml;
  yaml.resolution = 0.05;
  yaml.mode = mode;
  return yaml;
}

Warnings texts_of(const LoadedMap& map) {
  Warnings texts;
  for (const MapWarning& warning : map.warnings) texts.push_back(warning.text);
  return texts;
}

// One row of pixels.
MapImage row_of(std::vector<std::uint16_t> lightness, std::vector<std::uint8_t> alpha = {}) {
  const int width = static_cast<int>(lightness.size());
  return {.width = width,
          .height = 1,
          .white = 255,
          .lightness = std::move(lightness),
          .alpha = std::move(alpha),
          .is_lossy = false};
}

TEST(Interpret, TakesResolutionAndOriginFromTheYaml) {
  MapYaml yaml = yaml_of();
  yaml.origin = {1.0, 2.0, 0.5};
  const OccupancyGrid grid = interpret(yaml, row_of({0, 254})).grid;
  validate(grid);
  EXPECT_EQ(grid.resolution, 0.05);
  EXPECT_EQ(grid.origin, yaml.origin);
}

TEST(Interpret, PutsTheLastRowOfThePictureAtTheBottom) {
  const MapImage image{.width = 2,
                       .height = 3,
                       .white = 255,
                       .lightness = {0, 0, 205, 205, 254, 0},
                       .alpha = {},
                       .is_lossy = false};
  EXPECT_EQ(interpret(yaml_of(), image).grid.cells,
            (Cells{kFree, kOccupied, kUnknown, kUnknown, kOccupied, kOccupied}));
  const OccupancyGrid raw = interpret(yaml_of(MapMode::raw), {2, 2, 255, {1, 2, 3, 4}, {}, false}).grid;
  EXPECT_EQ(raw.probability, (std::vector<float>{0.03f, 0.04f, 0.01f, 0.02f}));
}

TEST(Trinary, ComparesStrictlyWithTheThresholds) {
  MapYaml yaml = yaml_of();
  yaml.occupied_thresh = 0.75;
  yaml.free_thresh = 0.25;
  // Of 100: occupancies 0.76, 0.75, 0.74 and 0.26, 0.25, 0.24 (0.75 and 0.25 are exact).
  const MapImage image{.width = 6,
                       .height = 1,
                       .white = 100,
                       .lightness = {24, 25, 26, 74, 75, 76},
                       .alpha = {},
                       .is_lossy = false};
  EXPECT_EQ(interpret(yaml, image).grid.cells,
            (Cells{kOccupied, kUnknown, kUnknown, kUnknown, kUnknown, kFree}));
  EXPECT_TRUE(interpret(yaml, image).grid.probability.empty());
}

TEST(Trinary, ReadsWhatMapSaverWrites) {
  const LoadedMap map = interpret(yaml_of(), row_of({0, 205, 254, 255}));
  EXPECT_EQ(map.grid.cells, (Cells{kOccupied, kUnknown, kFree, kFree}));
  EXPECT_EQ(texts_of(map), Warnings{});
}

TEST(Trinary, NegateSwapsBlackAndWhite) {
  MapYaml yaml = yaml_of();
  yaml.negate = true;
  EXPECT_EQ(interpret(yaml, row_of({0, 128, 255})).grid.cells, (Cells{kFree, kUnknown, kOccupied}));
}

TEST(Trinary, TheGrayOfMapSaversIsUnknownWhateverTheThresholds) {
  MapYaml yaml = yaml_of();
  yaml.free_thresh = 0.25;
  const LoadedMap map = interpret(yaml, row_of({0, 205, 254, 205, 204, 206}));
  EXPECT_EQ(map.grid.cells, (Cells{kOccupied, kUnknown, kFree, kUnknown, kFree, kFree}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_EQ(map.warnings[0].kind, MapWarningKind::unknown_gray);
  EXPECT_TRUE(contains(map.warnings[0].text, "2 pixels of lightness 205"));
  EXPECT_TRUE(contains(map.warnings[0].text, "free_thresh 0.25 would make them free"));
  EXPECT_TRUE(contains(map.warnings[0].text, "--literal-thresholds"));
  EXPECT_EQ(texts_of(interpret(yaml, row_of({0, 204, 254}))), Warnings{});

  yaml.free_thresh = 0.05;
  yaml.occupied_thresh = 0.1;
  const LoadedMap other = interpret(yaml, row_of({0, 205, 254}));
  EXPECT_EQ(other.grid.cells, (Cells{kOccupied, kUnknown, kFree}));
  ASSERT_EQ(other.warnings.size(), 1u);
  EXPECT_TRUE(contains(other.warnings[0].text, "occupied_thresh 0.1 would make them occupied"));
}

TEST(Trinary, OfANegatedMapItIsTheGrayThatWasNegated) {
  MapYaml yaml = yaml_of();
  yaml.free_thresh = 0.25;
  yaml.negate = true;
  const LoadedMap map = interpret(yaml, row_of({255, 50, 1, 49}));
  EXPECT_EQ(map.grid.cells, (Cells{kOccupied, kUnknown, kFree, kFree}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_TRUE(contains(map.warnings[0].text, "1 pixels of lightness 50"));
}

TEST(Trinary, LiteralThresholdsAreReadToTheLetter) {
  MapYaml yaml = yaml_of();
  yaml.free_thresh = 0.25;
  const LoadedMap map = interpret(yaml, row_of({0, 205, 254, 205}), true);
  EXPECT_EQ(map.grid.cells, (Cells{kOccupied, kFree, kFree, kFree}));  // as nav2 does
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_EQ(map.warnings[0].kind, MapWarningKind::gray_is_known);
  EXPECT_TRUE(contains(map.warnings[0].text, "2 pixels of lightness 205"));
  EXPECT_TRUE(contains(map.warnings[0].text, "load as free with free_thresh 0.25 and negate 0"));
}

TEST(Trinary, OfALossyPictureWhatIsNearerToUnknownThanToFreeIsUnknown) {
  MapImage image = row_of({0, 180, 199, 205, 211, 229, 230, 254});
  const Cells literal{kOccupied, kUnknown, kUnknown, kUnknown, kFree, kFree, kFree, kFree};
  EXPECT_EQ(interpret(yaml_of(), image).grid.cells, literal);
  image.is_lossy = true;
  const LoadedMap map = interpret(yaml_of(), image);
  EXPECT_EQ(map.grid.cells,
            (Cells{kOccupied, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kFree, kFree}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_TRUE(contains(map.warnings[0].text, "2 pixels of lightness about 205"));
  EXPECT_EQ(interpret(yaml_of(), image, true).grid.cells, literal);
}

TEST(Trinary, TheGrayOfMapSaversIsNotCountedAsAlphaToo) {
  MapYaml yaml = yaml_of();
  yaml.free_thresh = 0.25;
  const LoadedMap map = interpret(yaml, row_of({0, 205, 254}, {255, 255, 255}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_EQ(map.warnings[0].kind, MapWarningKind::unknown_gray);
}

TEST(Trinary, UnknownGrayThatIsTransparentIsUnknownIndeed) {
  MapYaml yaml = yaml_of();
  yaml.free_thresh = 0.25;
  EXPECT_EQ(texts_of(interpret(yaml, row_of({0, 205, 254}, {255, 0, 255}))), Warnings{});
}

TEST(Trinary, WarnsOfUnknownThatLoadsAsOccupied) {
  MapYaml yaml = yaml_of();
  yaml.negate = true;
  const LoadedMap map = interpret(yaml, row_of({0, 205, 254}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_TRUE(contains(map.warnings[0].text, "load as occupied"));
  EXPECT_TRUE(contains(map.warnings[0].text, "negate 1"));
}

TEST(Trinary, FindsUnknownGrayOnOtherScalesToo) {
  MapYaml yaml = yaml_of();
  yaml.free_thresh = 0.25;
  const MapImage deep{.width = 3,
                      .height = 1,
                      .white = 65535,
                      .lightness = {0, 205 * 257, 65535},
                      .alpha = {},
                      .is_lossy = false};
  EXPECT_EQ(interpret(yaml, deep).warnings.size(), 1u);
  const MapImage color{
      .width = 3, .height = 1, .white = 765, .lightness = {0, 615, 765}, .alpha = {}, .is_lossy = false};
  EXPECT_EQ(interpret(yaml, color).warnings.size(), 1u);
  const MapImage percent{
      .width = 3, .height = 1, .white = 100, .lightness = {0, 80, 100}, .alpha = {}, .is_lossy = false};
  EXPECT_EQ(interpret(yaml, percent).warnings.size(), 0u);
}

TEST(Trinary, WhatIsNotOpaqueIsUnknown) {
  const LoadedMap map = interpret(yaml_of(), row_of({0, 0, 254, 254, 0}, {255, 0, 255, 254, 128}));
  EXPECT_EQ(map.grid.cells, (Cells{kOccupied, kUnknown, kFree, kUnknown, kUnknown}));
}

TEST(Trinary, WarnsWhereNav2WouldAverageAlpha) {
  // Opaque 205 becomes 217.5 there: free. Transparent black becomes 0: occupied. The others stay.
  const LoadedMap map = interpret(yaml_of(), row_of({0, 254, 205, 0, 205}, {255, 255, 255, 0, 0}));
  EXPECT_EQ(map.grid.cells, (Cells{kOccupied, kFree, kUnknown, kUnknown, kUnknown}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_TRUE(contains(map.warnings[0].text, "2 pixels load otherwise in nav2"));
  const MapImage two_rows{
      .width = 1, .height = 2, .white = 255, .lightness = {0, 254}, .alpha = {255, 255}, .is_lossy = false};
  EXPECT_EQ(texts_of(interpret(yaml_of(), two_rows)), Warnings{});
}

TEST(Scale, StretchesOccupancyBetweenTheThresholds) {
  MapYaml yaml = yaml_of(MapMode::scale);
  yaml.occupied_thresh = 0.75;
  yaml.free_thresh = 0.25;
  const MapImage image{.width = 6,
                       .height = 1,
                       .white = 100,
                       .lightness = {0, 24, 25, 50, 75, 76},
                       .alpha = {},
                       .is_lossy = false};
  const OccupancyGrid grid = interpret(yaml, image).grid;
  EXPECT_EQ(grid.cells, (Cells{kOccupied, kOccupied, kUnknown, kUnknown, kUnknown, kFree}));
  EXPECT_EQ(grid.probability, (std::vector<float>{1.0f, 1.0f, 1.0f, 0.5f, 0.0f, 0.0f}));
}

TEST(Scale, WhatIsNotOpaqueIsUnknown) {
  const LoadedMap map = interpret(yaml_of(MapMode::scale), row_of({0, 0, 254}, {255, 254, 255}));
  EXPECT_EQ(map.grid.cells, (Cells{kOccupied, kUnknown, kFree}));
  EXPECT_TRUE(std::isnan(map.grid.probability[1]));
  EXPECT_EQ(texts_of(map), Warnings{});  // nav2 does the same
}

TEST(Scale, EqualThresholdsLeaveAHalf) {
  MapYaml yaml = yaml_of(MapMode::scale);
  yaml.occupied_thresh = yaml.free_thresh = 0.5;
  const MapImage image{
      .width = 3, .height = 1, .white = 2, .lightness = {0, 1, 2}, .alpha = {}, .is_lossy = false};
  EXPECT_EQ(interpret(yaml, image).grid.probability, (std::vector<float>{1.0f, 0.5f, 0.0f}));
}

TEST(Scale, WarnsOfUnknownThatLoadsAsFree) {
  MapYaml yaml = yaml_of(MapMode::scale);
  EXPECT_EQ(texts_of(interpret(yaml, row_of({0, 205, 254}))), Warnings{});
  yaml.free_thresh = 0.25;
  const LoadedMap map = interpret(yaml, row_of({0, 205, 254}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_TRUE(contains(map.warnings[0].text, "1 pixels of lightness 205"));
  EXPECT_TRUE(contains(map.warnings[0].text, "load as free with free_thresh 0.25"));
}

TEST(Raw, ValuesArePercents) {
  const OccupancyGrid grid =
      interpret(yaml_of(MapMode::raw), row_of({0, 19, 20, 64, 65, 100, 101, 255})).grid;
  EXPECT_EQ(grid.cells, (Cells{kFree, kFree, kUnknown, kUnknown, kOccupied, kOccupied, kUnknown, kUnknown}));
  const std::vector<float> known(grid.probability.begin(), grid.probability.begin() + 6);
  EXPECT_EQ(known, (std::vector<float>{0.0f, 0.19f, 0.2f, 0.64f, 0.65f, 1.0f}));
  EXPECT_TRUE(std::isnan(grid.probability[6]));
  EXPECT_TRUE(std::isnan(grid.probability[7]));
}

TEST(Raw, LimitingThresholdsStillTellCells) {
  MapYaml yaml = yaml_of(MapMode::raw);
  yaml.free_thresh = 0.0;
  yaml.occupied_thresh = 1.0;
  EXPECT_EQ(interpret(yaml, row_of({0, 1, 99, 100})).grid.cells,
            (Cells{kFree, kUnknown, kUnknown, kOccupied}));
}

TEST(Raw, TakesNoHeedOfNegateAndAlpha) {
  MapYaml yaml = yaml_of(MapMode::raw);
  yaml.negate = true;
  const LoadedMap map = interpret(yaml, row_of({0, 100}, {0, 0}));
  EXPECT_EQ(map.grid.cells, (Cells{kFree, kOccupied}));
  EXPECT_EQ(texts_of(map), Warnings{"negate has no effect in raw mode"});
}

TEST(Interpret, TellsFirstWhatTheYamlIsWarnedOf) {
  MapYaml yaml = yaml_of();
  yaml.warnings = {{MapWarningKind::long_origin, "the origin has a fourth number"}};
  const LoadedMap map = interpret(yaml, row_of({205, 254}));
  EXPECT_EQ(texts_of(map), (Warnings{"the origin has a fourth number", "the map has no occupied cell"}));
  EXPECT_EQ(map.warnings[0].kind, MapWarningKind::long_origin);
}

TEST(Interpret, WarnsOfMissingCells) {
  EXPECT_EQ(texts_of(interpret(yaml_of(), row_of({205, 205}))), Warnings{"the map has no known cell"});
  EXPECT_EQ(texts_of(interpret(yaml_of(), row_of({205, 254}))), Warnings{"the map has no occupied cell"});
  EXPECT_EQ(texts_of(interpret(yaml_of(), row_of({205, 0}))), Warnings{"the map has no free cell"});
}

TEST(Interpret, WarnsWhereWhatWasNotSeenIsPaintedBlack) {
  std::vector<std::uint16_t> pixels(100, 0);
  pixels[50] = 254;
  const Warnings warnings = texts_of(interpret(yaml_of(), row_of(pixels)));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("99 of 100 known cells are occupied"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("painted black"), std::string::npos) << warnings[0];
}

RC_GTEST_PROP(Interpret, NegateIsTheSameAsAnInvertedPicture, ()) {
  MapYaml yaml = yaml_of(*rc::gen::element(MapMode::trinary, MapMode::scale));
  MapImage image =
      row_of(*rc::gen::container<std::vector<std::uint16_t>>(50, rc::gen::inRange<std::uint16_t>(0, 256)));
  const OccupancyGrid grid = interpret(yaml, image).grid;
  for (std::uint16_t& value : image.lightness) value = static_cast<std::uint16_t>(255 - value);
  yaml.negate = true;
  const OccupancyGrid negated = interpret(yaml, image).grid;
  RC_ASSERT(negated.cells == grid.cells);
  RC_ASSERT(negated.probability.size() == grid.probability.size());
  for (std::size_t i = 0; i < grid.probability.size(); ++i) {
    RC_ASSERT(std::abs(negated.probability[i] - grid.probability[i]) < 1e-6f);
  }
}

}  // namespace
}  // namespace gridmerge
