// SPDX-License-Identifier: Apache-2.0
#include "../../src/merge/group_match.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "../../src/merge/join_weights.hpp"
#include "gridmerge/merge/merger.hpp"
#include "merge/coverage.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// A map, where it lies in its building, and all that a merge keeps of it.
struct Piece {
  Piece(const OccupancyGrid& building, const test::Window& window, const SE2& T_map_building)
      : grid(test::map_part(building, window, T_map_building)),
        T_building(inverse(T_map_building)),
        prepared(grid),
        coverage(prepared.known()) {}

  OccupancyGrid grid;
  SE2 T_building;
  PreparedMap prepared;
  Coverage coverage;
};

/// Two neighbours in a group, a third map that shares half of what it knows with each of them and is not said
/// to fit either, and a map of another building.
class GroupMatchesTest : public testing::Test {
 protected:
  GroupMatchesTest() {
    const OccupancyGrid building = test::draw_building(1);
    add(building, {0.0, 0.0, 9.0, 13.0}, {1.0, 2.0, 0.3});
    add(building, {9.0, 0.0, 18.0, 13.0}, {-3.0, 0.5, -1.0});
    add(building, {5.0, 0.0, 13.0, 13.0}, {0.0, 4.0, 2.0});
    add(test::draw_building(2), {5.0, 0.0, 13.0, 13.0}, {});
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      problem_.maps.push_back({pieces_[i]->coverage.extent(), &pieces_[i]->coverage});
      inputs_.push_back({i, &pieces_[i]->grid, &pieces_[i]->prepared, {}});
      for (std::size_t j = i + 1; j < pieces_.size(); ++j) problem_.pairs.push_back({i, j, {}});
    }
    problem_.pairs.front().candidates.push_back({between(0, 1), 6.0, 0.1});
    consistent_set_.groups = {{{0, {}}, {1, between(0, 1)}}, {{2, {}}}, {{3, {}}}};
  }

  void add(const OccupancyGrid& building, const test::Window& window, const SE2& T_map_building) {
    pieces_.push_back(std::make_unique<const Piece>(building, window, T_map_building));
  }

  SE2 between(std::size_t a, std::size_t b) const {
    return inverse(pieces_[a]->T_building) * pieces_[b]->T_building;
  }

  std::vector<std::unique_ptr<const Piece>> pieces_;
  JoinProblem problem_;
  ConsistentSet consistent_set_;
  std::vector<MergeInput> inputs_;
};

TEST_F(GroupMatchesTest, PlaceAMapThatFitsTheWholeGroup) {
  GroupMatches groups({});
  const JoinProblem heard = groups.heard(problem_, consistent_set_, inputs_);
  const ConsistentSet after = find_consistent_set(heard, 0.95);
  ASSERT_EQ(after.groups.size(), 2U);
  ASSERT_EQ(after.groups[0].size(), 3U);
  EXPECT_LT(displacement(problem_.maps[2].extent, after.groups[0][2].T_group_map, between(0, 2)), 0.1);
  EXPECT_EQ(after.groups[1].front().map, 3U);
}

TEST_F(GroupMatchesTest, OfManyMapsPlaceThoseThatAreWorthMeeting) {
  using Groups = std::vector<std::unique_ptr<PreparedMap>>;
  using Meetings = std::vector<std::pair<std::size_t, std::size_t>>;
  for (const bool is_worth : {true, false}) {
    GroupMatches groups({});
    const JoinProblem heard = groups.heard(problem_, consistent_set_, inputs_,
                                           [&](const Groups& prepared, const Meetings& meetings) {
                                             EXPECT_TRUE(prepared[0]);
                                             EXPECT_EQ(meetings, (Meetings{{0, 2}, {0, 3}}));
                                             return std::vector<bool>{is_worth, true};
                                           });
    const ConsistentSet after = find_consistent_set(heard, 0.95);
    EXPECT_EQ(after.groups[0].size(), is_worth ? 3U : 2U);
  }
}

TEST_F(GroupMatchesTest, PlaceMapsWhateverTheSearch) {
  for (const SearchMethod search : {SearchMethod::quick, SearchMethod::thorough, SearchMethod::exhaustive}) {
    MergeOptions options;
    options.match.search = search;
    Merger merger(options);
    for (const auto& piece : pieces_) merger.add(piece->grid);
    for (std::vector<DueMatch> due = merger.due(); !due.empty(); due = merger.due()) {
      for (const DueMatch& one : due) {  // only the neighbours are said to fit
        MatchResult match;
        if (one.fixed + one.moving == 1) {
          match.verdict = Verdict::accepted;
          match.T_fixed_moving = between(one.fixed, one.moving);
          match.probability = 0.999;
          match.hypotheses.push_back({match.T_fixed_moving, 1000.0, match.probability});
          match.hypotheses.back().figures.sigma = 0.1;
        }
        merger.hand_in(one, match);
      }
    }
    const MergeResult result = merger.solve();
    ASSERT_EQ(result.components.size(), 1U) << name_of(search);
    EXPECT_EQ(result.components.front().members.size(), 3U) << name_of(search);
    ASSERT_EQ(result.left_out.size(), 1U);
    EXPECT_EQ(result.left_out.front().map, 3U);
  }
}

TEST_F(GroupMatchesTest, SpeakOncePerGroup) {
  GroupMatches groups({});
  const JoinProblem heard = groups.heard(problem_, consistent_set_, inputs_);
  const std::vector<CandidateJoin>& first = heard.pairs[1].candidates;   // of maps 0 and 2
  const std::vector<CandidateJoin>& second = heard.pairs[3].candidates;  // of maps 1 and 2
  ASSERT_FALSE(first.empty());
  ASSERT_EQ(first.size(), second.size());
  EXPECT_NE(first[0].log_odds == kSaysNothing, second[0].log_odds == kSaysNothing);
  EXPECT_GT(std::max(first[0].log_odds, second[0].log_odds), 0.0);
}

TEST_F(GroupMatchesTest, LeaveMapsAloneOfWhichSomethingIsKnownBeforehand) {
  inputs_[2].known_pose = KnownPose{};
  GroupMatches groups({});
  for (const PairCandidates& pair : groups.heard(problem_, consistent_set_, inputs_).pairs) {
    if (pair.moving == 2) {
      EXPECT_TRUE(pair.candidates.empty());
    }
  }
}

TEST_F(GroupMatchesTest, AreTheSameWhenAskedAgain) {
  GroupMatches groups({});
  const JoinProblem once = groups.heard(problem_, consistent_set_, inputs_);
  const JoinProblem again = groups.heard(problem_, consistent_set_, inputs_);
  ASSERT_EQ(once.pairs.size(), again.pairs.size());
  for (std::size_t i = 0; i < once.pairs.size(); ++i) {
    ASSERT_EQ(once.pairs[i].candidates.size(), again.pairs[i].candidates.size());
    for (std::size_t c = 0; c < once.pairs[i].candidates.size(); ++c) {
      EXPECT_EQ(once.pairs[i].candidates[c].T_fixed_moving, again.pairs[i].candidates[c].T_fixed_moving);
      EXPECT_EQ(once.pairs[i].candidates[c].log_odds, again.pairs[i].candidates[c].log_odds);
    }
  }
}

}  // namespace
}  // namespace gridmerge
