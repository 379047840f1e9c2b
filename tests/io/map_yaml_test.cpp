// SPDX-License-Identifier: Apache-2.0
#include "io/map_yaml.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>

#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;

const std::string kGood =
    "image: a.pgm\n"
    "resolution: 0.05\n"
    "origin: [-1.5, 2, 0.25]\n"
    "negate: 0\n"
    "occupied_thresh: 0.65\n"
    "free_thresh: 0.196\n";

// kGood with the line of `key` replaced, or dropped when `line` is empty.
std::string with(const std::string& key, const std::string& line) {
  std::string text = kGood;
  const std::size_t begin = text.find(key + ":");
  const std::size_t end = text.find('\n', begin) + 1;
  return text.replace(begin, end - begin, line.empty() ? "" : line + "\n");
}

std::string error_of(const std::string& text) {
  return test::message_of<ParseError>([&] { parse_map_yaml(text); });
}

TEST(MapYaml, ReadsEveryKey) {
  const MapYaml map = parse_map_yaml(kGood + "mode: scale\n");
  EXPECT_EQ(map.image, "a.pgm");
  EXPECT_EQ(map.resolution, 0.05);
  EXPECT_EQ(map.origin, (SE2{-1.5, 2.0, 0.25}));
  EXPECT_FALSE(map.negate);
  EXPECT_EQ(map.occupied_thresh, 0.65);
  EXPECT_EQ(map.free_thresh, 0.196);
  EXPECT_EQ(map.mode, MapMode::scale);
}

TEST(MapYaml, ModeIsTrinaryUnlessSaid) {
  EXPECT_EQ(parse_map_yaml(kGood).mode, MapMode::trinary);
  EXPECT_EQ(parse_map_yaml(kGood + "mode: trinary").mode, MapMode::trinary);
  EXPECT_EQ(parse_map_yaml(kGood + "mode: Raw").mode, MapMode::raw);  // as nav2, in any case of letters
}

TEST(MapYaml, NegateIsANumberOrABool) {
  for (const char* yes : {"1", "true", "True", "yes", "on", "y", "Y", "'1'"}) {
    EXPECT_TRUE(parse_map_yaml(with("negate", std::string("negate: ") + yes)).negate) << yes;
  }
  for (const char* no : {"0", "false", "FALSE", "no", "off", "n"}) {
    EXPECT_FALSE(parse_map_yaml(with("negate", std::string("negate: ") + no)).negate) << no;
  }
}

TEST(MapYaml, TakesYamlAsItIsWritten) {
  EXPECT_EQ(parse_map_yaml(with("origin", "origin:\n  - 1\n  - -2.0\n  - 0")).origin, (SE2{1.0, -2.0, 0.0}));
  EXPECT_EQ(parse_map_yaml(with("image", "image: \"my map #1.pgm\"")).image, "my map #1.pgm");
  EXPECT_EQ(parse_map_yaml("---\n" + kGood + "...\n").image, "a.pgm");
  EXPECT_EQ(parse_map_yaml("\xef\xbb\xbf" + kGood).image, "a.pgm");  // a byte order mark
  EXPECT_EQ(parse_map_yaml(kGood + "more: {nested: [1, 2]}\n").image, "a.pgm");
  std::string windows;
  for (const char c : kGood) windows.append(c == '\n' ? 1 : 0, '\r').push_back(c);
  EXPECT_EQ(parse_map_yaml(windows).image, "a.pgm");
  EXPECT_EQ(parse_map_yaml(windows).free_thresh, 0.196);
}

TEST(MapYaml, YawIsTakenIntoRange) {
  EXPECT_EQ(parse_map_yaml(with("origin", "origin: [0, 0, -3.0]")).origin.theta, -3.0);
  EXPECT_NEAR(parse_map_yaml(with("origin", "origin: [0, 0, 7.0]")).origin.theta, 7.0 - 2 * std::numbers::pi,
              1e-12);
}

TEST(MapYaml, AYawThatIsNoNumberIsZero) {
  for (const char* nan : {"nan", "-nan", "NaN", ".nan", ".NaN", "'nan'"}) {
    const MapYaml map = parse_map_yaml(with("origin", std::string("origin: [1, 2, ") + nan + "]"));
    EXPECT_EQ(map.origin, (SE2{1.0, 2.0, 0.0})) << nan;
    ASSERT_EQ(map.warnings.size(), 1u) << nan;
    EXPECT_EQ(map.warnings[0].kind, MapWarningKind::yaw_not_a_number);
    EXPECT_TRUE(contains(map.warnings[0].text, "it is read as 0"));
  }
}

TEST(MapYaml, OfAnOriginOfFourNumbersTheFirstThreeCount) {
  const MapYaml map = parse_map_yaml(with("origin", "origin: [1, 2, 0.5, 7]"));
  EXPECT_EQ(map.origin, (SE2{1.0, 2.0, 0.5}));
  ASSERT_EQ(map.warnings.size(), 1u);
  EXPECT_EQ(map.warnings[0].kind, MapWarningKind::long_origin);
  EXPECT_TRUE(contains(map.warnings[0].text, "'7' is passed over"));
  EXPECT_TRUE(parse_map_yaml(kGood).warnings.empty());
}

TEST(MapYaml, LimitsThemselvesAreFine) {
  EXPECT_NO_THROW(parse_map_yaml(with("resolution", "resolution: 1e-6")));
  EXPECT_NO_THROW(parse_map_yaml(with("resolution", "resolution: 1000")));
  EXPECT_NO_THROW(parse_map_yaml(with("occupied_thresh", "occupied_thresh: 1.0")));
  EXPECT_NO_THROW(parse_map_yaml(with("free_thresh", "free_thresh: 0")));
  EXPECT_NO_THROW(parse_map_yaml(with("free_thresh", "free_thresh: 0.65")));
  EXPECT_EQ(parse_map_yaml(with("origin", "origin: [1e9, -1e9, 0]")).origin.x, 1e9);
}

TEST(MapYaml, EveryKeyButModeIsRequired) {
  for (const char* key : {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"}) {
    EXPECT_EQ(error_of(with(key, "")), std::string("missing key '") + key + "'");
  }
}

TEST(MapYaml, NoKeyIsGivenTwice) {
  const std::string text = kGood + "mode: scale\nnote: a\n";
  for (const char* line :
       {"image: a.pgm", "resolution: 0.05", "origin: [0, 0, 0]", "negate: 1", "occupied_thresh: 0.5",
        "free_thresh: 0.1", "mode: raw", "note: b", "'note': a", "? mode\n: scale"}) {
    const std::string given(line);
    std::string key = given.substr(0, given.find(given[0] == '?' ? "\n" : ":"));
    std::erase_if(key, [](char c) { return c == '\'' || c == '?' || c == ' '; });
    EXPECT_EQ(error_of(text + given + "\n"), "'" + key + "' is given twice") << line;
    EXPECT_EQ(error_of(given + "\n" + text), "'" + key + "' is given twice") << line;
  }
  EXPECT_TRUE(contains(error_of(kGood + "mode: scale\nmode: nonsense\n"), "'mode' is given twice"));
  // A map in the map has names of its own, and names differ in the case of their letters.
  EXPECT_EQ(parse_map_yaml(text + "more: {image: 1, mode: 2}\nMode: raw\n").mode, MapMode::scale);
  EXPECT_LT(error_of(kGood + std::string(5000, 'k') + ": 1\n" + std::string(5000, 'k') + ": 1\n").size(),
            200u);
}

struct BadYaml {
  const char* name;
  std::string text;
  const char* message;

  friend void PrintTo(const BadYaml& bad, std::ostream* out) { *out << bad.name; }
};

class MapYamlRefuses : public testing::TestWithParam<BadYaml> {};

TEST_P(MapYamlRefuses, AndSaysWhy) {
  EXPECT_TRUE(contains(error_of(GetParam().text), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    BadTexts, MapYamlRefuses,
    testing::Values(
        BadYaml{"Nothing", "", "not a YAML map"}, BadYaml{"AWord", "hello", "not a YAML map"},
        BadYaml{"AList", "- image: a.pgm\n- resolution: 1\n", "not a YAML map"},
        BadYaml{"BrokenYaml", "image: a.pgm\n\tresolution: 1", "not valid YAML: line 2: "},
        BadYaml{"EmptyImage", with("image", "image: ''"), "'image' is empty"},
        BadYaml{"NullImage", with("image", "image:"), "'image' is not a single value"},
        BadYaml{"ListForImage", with("image", "image: [a.pgm]"), "'image' is not a single value"},
        BadYaml{"NulInImage", with("image", R"(image: "a.pgm\0.png")"), "'image' holds a NUL"},
        BadYaml{"ZeroResolution", with("resolution", "resolution: 0"), "resolution 0 is not in"},
        BadYaml{"NegativeResolution", with("resolution", "resolution: -1"), "resolution -1 is not in"},
        BadYaml{"NanResolution", with("resolution", "resolution: .nan"),
                "'resolution' is '.nan', not a finite number"},
        BadYaml{"InfiniteResolution", with("resolution", "resolution: .inf"), "not a finite number"},
        BadYaml{"HugeResolution", with("resolution", "resolution: 1e300"), "resolution 1e+300 is not in"},
        BadYaml{"TinyResolution", with("resolution", "resolution: 9e-7"), "resolution 9e-07 is not in"},
        BadYaml{"WordForResolution", with("resolution", "resolution: fine"),
                "'resolution' is 'fine', not a finite"},
        BadYaml{"UnitInResolution", with("resolution", "resolution: 0.05 m"),
                "'0.05 m', not a finite number"},
        BadYaml{"DecimalComma", with("resolution", "resolution: 0,05"), "'0,05', not a finite number"},
        BadYaml{"MapForResolution", with("resolution", "resolution: {a: 1}"),
                "'resolution' is not a single value"},
        BadYaml{"TwoNumberOrigin", with("origin", "origin: [1, 2]"), "'origin' is not a list of three"},
        BadYaml{"FiveNumberOrigin", with("origin", "origin: [1, 2, 3, 4, 5]"),
                "'origin' is not a list of three"},
        BadYaml{"WordForYaw", with("origin", "origin: [0, 0, none]"),
                "'origin' is 'none', not a finite number"},
        BadYaml{"NumberForOrigin", with("origin", "origin: 0"), "'origin' is not a list of three"},
        BadYaml{"NanOrigin", with("origin", "origin: [0, .nan, 0]"),
                "'origin' is '.nan', not a finite number"},
        BadYaml{"PlainNanOrigin", with("origin", "origin: [nan, 0, 0]"),
                "'origin' is 'nan', not a finite number"},
        BadYaml{"InfiniteYaw", with("origin", "origin: [0, 0, inf]"), "not a finite number"},
        BadYaml{"OverflowingOrigin", with("origin", "origin: [1e999, 0, 0]"), "not a finite number"},
        BadYaml{"FarOrigin", with("origin", "origin: [0, -2e9, 0]"), "'origin' is further than 1000000000 m"},
        BadYaml{"BarelyFarOrigin", with("origin", "origin: [1000000001, 0, 0]"), "'origin' is further than"},
        BadYaml{"ResolutionAboveAll", with("resolution", "resolution: 1000.01"),
                "resolution 1000.01 is not in"},
        BadYaml{"ListInOrigin", with("origin", "origin: [[0], 0, 0]"), "'origin' is not a single value"},
        BadYaml{"NegativeThreshold", with("free_thresh", "free_thresh: -0.1"),
                "'free_thresh' is -0.1, not in 0..1"},
        BadYaml{"PercentThreshold", with("occupied_thresh", "occupied_thresh: 65"),
                "'occupied_thresh' is 65, not in"},
        BadYaml{"NanThreshold", with("occupied_thresh", "occupied_thresh: NaN"),
                "'occupied_thresh' is 'NaN'"},
        BadYaml{"CrossedThresholds", with("free_thresh", "free_thresh: 0.7"),
                "'free_thresh' 0.7 is above 'occupied_thresh' 0.65"},
        BadYaml{"NegateTwo", with("negate", "negate: 2"), "'negate' is '2', not 0, 1, true or false"},
        BadYaml{"UnknownMode", kGood + "mode: binary", "'mode' is 'binary', not trinary, scale or raw"},
        BadYaml{"LongValues", with("resolution", "resolution: " + std::string(5000, 'x')),
                "xxx...', not a finite"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(MapYaml, LongValuesAreShortenedInMessages) {
  EXPECT_LT(error_of(with("resolution", "resolution: " + std::string(5000, 'x'))).size(), 200u);
}

TEST(MapYaml, ShowsValuesOfSixtyCharactersWhole) {
  const std::string sixty(60, 'x');
  EXPECT_TRUE(contains(error_of(with("resolution", "resolution: " + sixty)), "is '" + sixty + "',"));
  EXPECT_TRUE(contains(error_of(with("resolution", "resolution: " + sixty + "x")), "is '" + sixty + "...',"));
}

TEST(MapYaml, DeepNestingIsRefused) {
  EXPECT_TRUE(contains(error_of(std::string(100000, '[')), "nested too deeply"));
  EXPECT_TRUE(contains(error_of(std::string(100000, '{')), "nested too deeply"));
}

TEST(MapYaml, SixteenLevelsAreTheMostOfListsAndOfMaps) {
  const auto nested = [](int depth, const std::string& begin, const std::string& end) {
    std::string text;
    for (int i = 0; i < depth; ++i) text += begin;
    text += "x";
    for (int i = 0; i < depth; ++i) text += end;
    return kGood + "more: " + text + "\n";  // the map that this is a part of is a level, too
  };
  for (const auto& [begin, end] : {std::pair("[", "]"), std::pair("{a: ", "}")}) {
    EXPECT_EQ(parse_map_yaml(nested(15, begin, end)).image, "a.pgm");
    EXPECT_TRUE(contains(error_of(nested(16, begin, end)), "nested too deeply")) << begin;
  }
  std::string beside_each_other;
  for (int i = 0; i < 20; ++i) beside_each_other += "more" + std::to_string(i) + ": {a: [b]}\n";
  EXPECT_EQ(parse_map_yaml(kGood + beside_each_other).image, "a.pgm");
}

TEST(MapYaml, AnchorsThatUnfoldToBillionsCostNothing) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 30; ++i) {
    const std::string name = std::to_string(i), before = std::to_string(i - 1);
    bomb.append("a").append(name).append(": &a").append(name);
    bomb.append(" [*a").append(before).append(", *a").append(before).append("]\n");
  }
  EXPECT_EQ(parse_map_yaml(bomb + kGood).image, "a.pgm");
  EXPECT_TRUE(contains(error_of(bomb + with("origin", "origin: *a29")), "'origin' is not a list of three"));
}

RC_GTEST_PROP(MapYaml, ReadsWhatItWrites, ()) {
  const auto number = [](double scale) { return scale * *rc::gen::inRange(-1000003, 1000004) / 1000003.0; };
  MapYaml map;
  map.image = *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127)));
  map.resolution = std::exp(number(6.0));
  map.origin = {number(1e9), number(1e3), number(3.14159)};
  map.free_thresh = std::abs(number(0.5));
  map.occupied_thresh = 0.5 + std::abs(number(0.5));
  map.negate = *rc::gen::arbitrary<bool>();
  map.mode = *rc::gen::element(MapMode::trinary, MapMode::scale, MapMode::raw);
  const MapYaml read = parse_map_yaml(format_map_yaml(map));
  RC_ASSERT(read.image == map.image);
  RC_ASSERT(read.resolution == map.resolution);
  RC_ASSERT(read.origin == map.origin);
  RC_ASSERT(read.free_thresh == map.free_thresh);
  RC_ASSERT(read.occupied_thresh == map.occupied_thresh);
  RC_ASSERT(read.negate == map.negate);
  RC_ASSERT(read.mode == map.mode);
}

TEST(MapYaml, QuotesNamesThatNeedIt) {
  for (const char* name :
       {"\r", " a", "a ", "a: b", "a #b", "#a", "- a", "-", "[a]", "'a'", "\"a\"", "~", "Küche"}) {
    MapYaml map;
    map.resolution = 0.05;
    map.image = name;
    EXPECT_EQ(parse_map_yaml(format_map_yaml(map)).image, name);
  }
}

TEST(MapYaml, RefusesToWriteANameThatYamlCannotHold) {
  MapYaml map;
  map.resolution = 0.05;
  map.image = "a control character beside what is not UTF-8 \x02\x9c.pgm";
  EXPECT_EQ(test::message_of<ParseError>([&] { format_map_yaml(map); }),
            "the image's name cannot be written in YAML");
}

}  // namespace
}  // namespace gridmerge
