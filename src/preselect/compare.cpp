// SPDX-License-Identifier: Apache-2.0
#include "preselect/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "preselect/proposals.hpp"
#include "preselect/tally.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kMaxProposals = 48;     // poses that are checked
constexpr std::size_t kMaxProfilePoses = 20;  // and of these, proposed by long walls
constexpr std::size_t kCoarseStep = 6;        // of the walls every so manyth is checked first
constexpr std::size_t kMaxChecked = 6;        // of the best by these, all walls are
constexpr double kPromising = 3.5;            // worth from which a pose is refined
constexpr std::size_t kMaxRefined = 2;        // of them, refined
constexpr double kDistinct = 1.5;             // poses nearer than this to a better one are the same [m]
constexpr double kVoteWorth = 1.0;            // against score()
constexpr double kQuarterTurn = std::numbers::pi / 2.0;
constexpr double kVotesWithin = 1.0;       // keypoints that lie so near to each other vote for the pose [m]
constexpr double kParallel = 0.985;        // cosine of the turn between poses that mean the same
constexpr double kUnit = 4096.0 * 4096.0;  // product of equal descriptors

struct Checked {
  GridPose T;
  Tally tally;
  double votes = 0.0;
};

/// The poses that the proposals make, most votes first.
std::vector<Checked> poses_of(const Signature& fixed, const Signature& moving,
                              const std::vector<Proposal>& proposals) {
  std::vector<Checked> all;
  for (const Proposal& proposal : proposals) {
    const Keypoint &a = fixed.keypoints[proposal.fixed], &b = moving.keypoints[proposal.moving];
    GridPose T = GridPose::of(0.0, 0.0, a.theta + proposal.quarters * kQuarterTurn - b.theta);
    const Point2 turned = T * b.position;
    T.x = a.position.x - turned.x;
    T.y = a.position.y - turned.y;
    all.push_back({T, {}});
  }
  const std::size_t voters = all.size();
  for (const ProfilePose& pose : align_profiles(fixed.profiles, moving.profiles, kMaxProfilePoses)) {
    const SE2& T = pose.T_fixed_moving;
    all.push_back({GridPose::of(T.x, T.y, T.theta), {}});
  }
  for (Checked& one : all) {
    for (std::size_t i = 0; i < voters; ++i) {
      const double parallel = one.T.cos * all[i].T.cos + one.T.sin * all[i].T.sin;
      if (parallel < kParallel) continue;
      const Point2& at = fixed.keypoints[proposals[i].fixed].position;
      const Point2 there = one.T * moving.keypoints[proposals[i].moving].position;
      const double off = (at.x - there.x) * (at.x - there.x) + (at.y - there.y) * (at.y - there.y);
      if (off < kVotesWithin * kVotesWithin) one.votes += static_cast<double>(proposals[i].product) / kUnit;
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Checked& a, const Checked& b) { return a.votes > b.votes; });
  return all;
}

/// Climbs to a better pose in ever smaller steps.
Checked refined(const Signature& fixed, const Signature& moving, Checked best) {
  double shift = 0.3, turn = 3.0 * std::numbers::pi / 180.0;
  for (int level = 0; level < 2; ++level) {
    for (int round = 0; round < 2; ++round) {
      const Checked before = best;
      const GridPose& T = before.T;
      // About the middle of the moving map, or a turn would shift it.
      const Point2 middle{0.5 * moving.width * moving.cell, 0.5 * moving.height * moving.cell};
      const Point2 at = T * middle;
      for (const auto& [dx, dy, dt] :
           {std::array{shift, 0.0, 0.0}, std::array{-shift, 0.0, 0.0}, std::array{0.0, shift, 0.0},
            std::array{0.0, -shift, 0.0}, std::array{0.0, 0.0, turn}, std::array{0.0, 0.0, -turn}}) {
        GridPose tried = GridPose::of(0.0, 0.0, T.theta + dt);
        const Point2 moved = tried * middle;
        tried.x = at.x + dx - moved.x;
        tried.y = at.y + dy - moved.y;
        const Tally found = tally_both(fixed, moving, tried, 1);
        if (found.score() > best.tally.score()) best = {tried, found, best.votes};
      }
      if (!(best.tally.score() > before.tally.score())) break;
    }
    shift /= 2.0;
    turn /= 2.0;
  }
  return best;
}

}  // namespace

SignatureMatch compare(const Signature& fixed, const Signature& moving) {
  SignatureMatch match;
  const std::vector<Proposal> proposals = most_alike(fixed.descriptors, moving.descriptors, kMaxProposals);
  if (!proposals.empty()) match.likeness = static_cast<double>(proposals.front().product) / kUnit;
  const Point2 middle{0.5 * moving.width * moving.cell, 0.5 * moving.height * moving.cell};
  const auto are_near = [&](const GridPose& a, const GridPose& b) {
    if (!(a.cos * b.cos + a.sin * b.sin > kParallel)) return false;
    const Point2 p = a * middle, q = b * middle;
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) < kDistinct * kDistinct;
  };
  std::vector<Checked> distinct;
  for (const Checked& one : poses_of(fixed, moving, proposals)) {
    if (std::any_of(distinct.begin(), distinct.end(),
                    [&](const Checked& other) { return are_near(one.T, other.T); }))
      continue;
    distinct.push_back(one);
    distinct.back().tally = tally_both(fixed, moving, one.T, kCoarseStep);
  }
  if (distinct.empty()) return match;
  const auto worth = [](const Checked& one) { return one.tally.score() + kVoteWorth * one.votes; };
  const auto better = [&](const Checked& a, const Checked& b) { return worth(a) > worth(b); };
  std::stable_sort(distinct.begin(), distinct.end(), better);
  std::vector<Checked> best(distinct.begin(), distinct.begin() + std::min(distinct.size(), kMaxChecked));
  for (Checked& one : best) one.tally = tally_both(fixed, moving, one.T, 1);
  const std::size_t kept = std::min(best.size(), kMaxRefined);
  std::partial_sort(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(kept), best.end(), better);
  best.resize(kept);
  if (worth(best.front()) > kPromising) {
    for (Checked& one : best) one = refined(fixed, moving, one);
    std::iter_swap(best.begin(), std::min_element(best.begin(), best.end(), better));
  }
  const Checked& first = best.front();
  match.T_fixed_moving = fixed.T_map_grid * SE2{first.T.x, first.T.y, normalize_angle(first.T.theta)} *
                         inverse(moving.T_map_grid);
  match.seen = first.tally.seen;
  match.met = first.tally.met;
  match.open = first.tally.open;
  match.chance = first.tally.chance;
  match.votes = first.votes;
  for (const Checked& other : distinct) {
    if (!are_near(other.T, first.T)) match.next_votes = std::max(match.next_votes, other.votes);
  }
  return match;
}

}  // namespace gridmerge::internal
