// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_choice.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace gridmerge::internal {

namespace {

constexpr double kSquares = 2.0;   // side, in spacings of the lattices
constexpr double kSurely = 2.0;    // standard errors
constexpr double kGapWorth = 0.5;  // cells: to close so small a gap everywhere is no gain

/// Misfit on each square, and of how many walls that the other map has near.
struct Misfit {
  std::map<FloorSquare, double> on;
  double met = 0.0;

  void add(const PairMisfit& pair) {
    for (const auto& [square, value] : pair.on) on[square] += value;
    met += pair.met;
  }
};

/// Of all pairs, and of those in which each map is.
struct Misfits {
  explicit Misfits(std::size_t maps) : of_map(maps) {}

  Misfit all;
  std::vector<Misfit> of_map;
};

void add_misfits(const std::vector<ElasticMember>& members, const ElasticFit& options, const WallFold& fold,
                 Misfits& misfits) {
  const std::vector<PairMisfit> of_pairs = misfits_of(members, options.pairs, options.cell, fold);
  for (std::size_t i = 0; i < of_pairs.size(); ++i) {
    misfits.all.add(of_pairs[i]);
    misfits.of_map[options.pairs[i].first].add(of_pairs[i]);
    misfits.of_map[options.pairs[i].second].add(of_pairs[i]);
  }
}

/// What has changed, summed over the squares; both have the same ones.
struct Change {
  double sum = 0.0;
  double standard_error = 0.0;
};
Change change_of(const Misfit& before, const Misfit& after) {
  Change change;
  double squares = 0.0;
  for (const auto& [square, value] : after.on) {
    const double one = value - before.on.at(square);
    change.sum += one;
    squares += one * one;
  }
  change.standard_error = std::sqrt(squares);
  return change;
}

}  // namespace

std::vector<bool> find_gains(const ElasticFit& options, const std::vector<ElasticMember>& members) {
  Misfits before(members.size()), after(members.size());
  double spacing = 0.0;
  for (const ElasticMember& member : members) spacing = std::max(spacing, member.sheet.spacing());
  for (const int colour : {0, 1}) {
    std::vector<ElasticMember> bent = members;
    ElasticFit half = options;
    half.fold = {kSquares * spacing, colour};
    const WallFold held_out{half.fold.side, 1 - colour};
    add_misfits(bent, options, held_out, before);
    fit(half, bent);
    add_misfits(bent, options, held_out, after);
  }
  std::vector<bool> gains(members.size(), false);
  const Change all = change_of(before.all, after.all);
  const double worth = misfit_of_gap(kGapWorth * options.cell, options.cell) * after.all.met;
  if (all.sum > -kSurely * all.standard_error || all.sum > -worth) return gains;
  for (std::size_t i = 0; i < members.size(); ++i)
    gains[i] = change_of(before.of_map[i], after.of_map[i]).sum < 0.0;
  return gains;
}

}  // namespace gridmerge::internal
