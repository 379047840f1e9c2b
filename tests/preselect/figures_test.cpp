// SPDX-License-Identifier: Apache-2.0
// What signatures say of a few maps. The weights of chance.cpp were fitted to such figures: a change that is
// wanted has them fitted anew (calibration/fit_preselection.py).
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "preselect/chance.hpp"
#include "preselect/compare.hpp"
#include "rooms.hpp"
#include "signature_of.hpp"
#include "support/building.hpp"

namespace gridmerge::internal {
namespace {

using test::draw_building;
using test::FigureLine;
using test::Figures;
using test::map_part;
using test::rooms_from;
using test::signature_of;

/// Parts of four floors, of which some share much, some little and some nothing.
std::vector<Signature> some_signatures() {
  std::vector<Signature> all;
  for (unsigned building = 21; building < 24; ++building) {
    const OccupancyGrid whole = draw_building(building);
    all.push_back(signature_of(map_part(whole, {0, 0, 11, 11}, {1.0, 2.0, 0.4})));
    all.push_back(signature_of(map_part(whole, {5, 2, 18, 13}, {-3.0, 7.0, -1.1})));
    all.push_back(signature_of(map_part(whole, {9, 0, 18, 9}, {0.0, 4.0, 2.3})));
  }
  // Long straight walls, which profiles are of. Each is turned: no direction is a whole quarter, which
  // rounding could put at either end of the range.
  all.push_back(signature_of(map_part(rooms_from(0), {0, 0, 17, 12}, {1.0, 1.0, 0.3})));
  all.push_back(signature_of(map_part(rooms_from(110), {0, 0, 12, 12}, {0.0, 3.0, -0.6})));
  all.push_back(signature_of(map_part(rooms_from(0), {3, 0, 17, 9}, {4.0, -2.0, 1.9})));
  return all;
}

Figures figures_of(const Signature& map) {
  double position = 0.0, direction = 0.0, facing = 0.0, descriptors = 0.0, products = 0.0, profiles = 0.0,
         places = 0.0;
  for (const SampledWall& wall : map.walls) {
    position += wall.position.x + 2.0 * wall.position.y;
    facing += wall.facing;
  }
  for (const Keypoint& keypoint : map.keypoints) {
    position += 3.0 * keypoint.position.x - keypoint.position.y;
    direction += std::cos(4.0 * keypoint.theta) + 2.0 * std::sin(4.0 * keypoint.theta);
  }
  for (const Descriptor& descriptor : map.descriptors) {
    for (std::size_t i = 0; i < descriptor.size(); ++i) {
      descriptors += descriptor[i];
      products += static_cast<double>(i) * descriptor[i];
    }
  }
  for (std::size_t side = 0; side < map.profiles.sides.size(); ++side) {
    for (std::size_t i = 0; i < map.profiles.sides[side].size(); ++i)
      profiles += static_cast<double>((side + 1) * (i + 1)) * map.profiles.sides[side][i];
  }
  for (const Place& place : map.places) places += place.distance;
  return {{"known_area", map.known_area},
          {"wall_length", map.wall_length},
          {"walls", static_cast<double>(map.walls.size())},
          {"keypoints", static_cast<double>(map.keypoints.size())},
          {"chance_of_meeting", map.chance_of_meeting},
          {"positions", position},
          {"directions", direction},
          {"facings", facing},
          {"descriptors", descriptors},
          {"descriptors_by_place", products},
          {"profiles_theta", map.profiles.theta},
          {"profiles_first", map.profiles.first},
          {"profiles_length", static_cast<double>(map.profiles.sides[0].size())},
          {"profiles", profiles},
          {"places", places}};
}

Figures figures_of(const SignatureMatch& match) {
  return test::with_pose(match.T_fixed_moving, {{"seen", match.seen},
                                                {"met", match.met},
                                                {"open", match.open},
                                                {"chance", match.chance},
                                                {"votes", match.votes},
                                                {"next_votes", match.next_votes},
                                                {"likeness", match.likeness}});
}

/// A line per signature and per pair of them.
std::vector<FigureLine> all_lines() {
  const std::vector<Signature> maps = some_signatures();
  std::vector<FigureLine> lines;
  for (std::size_t a = 0; a < maps.size(); ++a) {
    lines.push_back({"map " + std::to_string(a), figures_of(maps[a])});
    for (std::size_t b = a + 1; b < maps.size(); ++b) {
      const SignatureMatch match = compare(maps[a], maps[b]);
      FigureLine line{"pair " + std::to_string(a) + " " + std::to_string(b), figures_of(match)};
      line.figures.push_back({"log_odds", log_odds_of_joining(match, maps[a], maps[b])});
      lines.push_back(line);
    }
  }
  for (const double probability : {0.0, 0.2, 0.9, 1.0}) {
    std::ostringstream name;
    name << "look " << probability;
    lines.push_back({name.str(), {{"log_odds", log_odds_after_a_look(-3.0, probability)}}});
  }
  lines.push_back({"shift",
                   {{"of_four", shift_to_this_set({-9.0F, -7.0F, -3.0F, 4.0F})},
                    {"of_one", shift_to_this_set({-9.0F})}}});
  return lines;
}

TEST(Figures, AreThoseThatTheModelWasFittedTo) {
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", all_lines());
}

}  // namespace
}  // namespace gridmerge::internal
