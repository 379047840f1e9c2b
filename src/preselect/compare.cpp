// SPDX-License-Identifier: Apache-2.0
#include "preselect/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "grid/quarter_turned.hpp"
#include "preselect/dot_products.hpp"

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

/// Walls that face another way than the one they meet by more steps than this show something else.
constexpr int kMaxTurned = 4;

struct Proposal {
  std::int32_t product;
  int fixed, moving, quarters;
};

/// A pose between the grid frames, its sine and cosine worked out once.
struct Pose {
  double x, y, theta, cos, sin;

  static Pose of(double x, double y, double theta) { return {x, y, theta, std::cos(theta), std::sin(theta)}; }
  Point2 operator*(const Point2& p) const { return {cos * p.x - sin * p.y + x, sin * p.x + cos * p.y + y}; }
  Pose inverted() const { return {-(cos * x + sin * y), -(-sin * x + cos * y), -theta, cos, -sin}; }
};

struct Tally {
  double seen = 0.0;
  double met = 0.0;
  double open = 0.0;
  double chance = 0.0;

  /// How much better than by chance the walls meet, in about its standard deviations.
  double score() const { return (met - chance - 0.5 * open) / std::sqrt(seen + 10.0); }
};

bool faces_alike(std::uint8_t a, std::uint8_t b) {
  if (a == kNoDirection || b == kNoDirection) return true;
  return steps_between(a, b) <= kMaxTurned;
}

/// The walls of `on` where `at` has seen, every `step`-th of them, in metres of wall.
Tally tally(const Signature& at, const Signature& on, const Pose& T_at_on, std::size_t step) {
  Tally sum;
  if (on.walls.empty()) return sum;
  const int turn = steps_of_turn(T_at_on.theta);
  int seen = 0, met = 0, open = 0;
  for (std::size_t i = 0; i < on.walls.size(); i += step) {
    const SampledWall& wall = on.walls[i];
    const Place place = at.place_at(T_at_on * wall.position);
    if (place.distance == kUnseen) continue;
    ++seen;
    if (place.distance >= at.open_from) {
      ++open;
    } else if (place.distance <= at.met_within && faces_alike(place.facing, turned(wall.facing, turn))) {
      ++met;
    }
  }
  const double metres = on.wall_length / static_cast<double>(on.walls.size()) * static_cast<double>(step);
  return {seen * metres, met * metres, open * metres, seen * metres * at.chance_of_meeting};
}

Tally tally_both(const Signature& fixed, const Signature& moving, const Pose& T, std::size_t step) {
  const Tally a = tally(fixed, moving, T, step), b = tally(moving, fixed, T.inverted(), step);
  return {0.5 * (a.seen + b.seen), 0.5 * (a.met + b.met), 0.5 * (a.open + b.open),
          0.5 * (a.chance + b.chance)};
}

/// The pairs of keypoints that are most alike, most alike first.
std::vector<Proposal> most_alike(const Signature& fixed, const Signature& moving) {
  const std::size_t count = moving.descriptors.size();
  std::vector<Proposal> all;
  if (count == 0) return all;
  all.reserve(4 * fixed.descriptors.size() * count);
  std::vector<std::int32_t> products(count);
  for (int quarters = 0; quarters < 4; ++quarters) {
    for (std::size_t i = 0; i < fixed.descriptors.size(); ++i) {
      const Descriptor turned = quarter_turned(fixed.descriptors[i], quarters);
      dot_products(turned.data(), moving.descriptors.front().data(), count, products.data());
      for (std::size_t j = 0; j < count; ++j) {
        if (products[j] > 0) all.push_back({products[j], static_cast<int>(i), static_cast<int>(j), quarters});
      }
    }
  }
  const auto before = [](const Proposal& a, const Proposal& b) {
    return std::tuple(-a.product, a.fixed, a.moving, a.quarters) <
           std::tuple(-b.product, b.fixed, b.moving, b.quarters);
  };
  const std::size_t kept = std::min(kMaxProposals, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept), all.end(), before);
  all.resize(kept);
  return all;
}

struct Checked {
  Pose T;
  Tally tally;
  double votes = 0.0;
};

/// The poses that the proposals make, most votes first.
std::vector<Checked> poses_of(const Signature& fixed, const Signature& moving,
                              const std::vector<Proposal>& proposals) {
  std::vector<Checked> all;
  for (const Proposal& proposal : proposals) {
    const Keypoint &a = fixed.keypoints[proposal.fixed], &b = moving.keypoints[proposal.moving];
    Pose T = Pose::of(0.0, 0.0, a.theta + proposal.quarters * kQuarterTurn - b.theta);
    const Point2 turned = T * b.position;
    T.x = a.position.x - turned.x;
    T.y = a.position.y - turned.y;
    all.push_back({T, {}});
  }
  const std::size_t voters = all.size();
  for (const ProfilePose& pose : align_profiles(fixed.profiles, moving.profiles, kMaxProfilePoses)) {
    const SE2& T = pose.T_fixed_moving;
    all.push_back({Pose::of(T.x, T.y, T.theta), {}});
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
      const Pose& T = before.T;
      // About the middle of the moving map, or a turn would shift it.
      const Point2 middle{0.5 * moving.width * moving.cell, 0.5 * moving.height * moving.cell};
      const Point2 at = T * middle;
      for (const auto& [dx, dy, dt] :
           {std::array{shift, 0.0, 0.0}, std::array{-shift, 0.0, 0.0}, std::array{0.0, shift, 0.0},
            std::array{0.0, -shift, 0.0}, std::array{0.0, 0.0, turn}, std::array{0.0, 0.0, -turn}}) {
        Pose tried = Pose::of(0.0, 0.0, T.theta + dt);
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
  const std::vector<Proposal> proposals = most_alike(fixed, moving);
  if (!proposals.empty()) match.likeness = static_cast<double>(proposals.front().product) / kUnit;
  const Point2 middle{0.5 * moving.width * moving.cell, 0.5 * moving.height * moving.cell};
  const auto are_near = [&](const Pose& a, const Pose& b) {
    const Point2 p = a * middle, q = b * middle;
    return std::hypot(p.x - q.x, p.y - q.y) < kDistinct && a.cos * b.cos + a.sin * b.sin > kParallel;
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
