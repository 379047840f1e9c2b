// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_choice.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace gridmerge::internal {

namespace {

constexpr double kSquares = 2.0;           // side, in spacings of the lattices
constexpr double kSurely = 2.0;            // standard errors
constexpr double kGapWorth = 0.5;          // cells: to close so small a gap everywhere is no gain
constexpr double kGapWorthOfParts = 0.25;  // the same where maps have few freedoms, which chance does not use

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

/// Whether walls that were held out lie nearer to each other: surely, and by more than is worth nothing.
bool is_gain(const Misfit& before, const Misfit& after, double gap_worth, double cell) {
  const Change change = change_of(before, after);
  const double worth = misfit_of_gap(gap_worth * cell, cell) * after.met;
  return change.sum <= -kSurely * change.standard_error && change.sum <= -worth;
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
  if (!is_gain(before.all, after.all, kGapWorth, options.cell)) return gains;
  for (std::size_t i = 0; i < members.size(); ++i)
    gains[i] = change_of(before.of_map[i], after.of_map[i]).sum < 0.0;
  return gains;
}

std::vector<bool> find_parts_that_gain(const ElasticFit& options, double spacing,
                                       const std::vector<ElasticMember>& members,
                                       const std::vector<std::size_t>& part_of) {
  std::vector<Misfit> before(members.size()), after(members.size());
  for (const int colour : {0, 1}) {
    ElasticFit half = options;
    half.fold = {kSquares * spacing, colour};
    const WallFold held_out{half.fold.side, 1 - colour};
    for (const bool is_rigid : {true, false}) {
      std::vector<ElasticMember> fitted = members;
      for (ElasticMember& member : fitted)
        if (is_rigid) member.freedom = MapTransform::rigid;
      fit(half, fitted);
      const std::vector<PairMisfit> of_pairs = misfits_of(fitted, options.pairs, options.cell, held_out);
      for (std::size_t i = 0; i < of_pairs.size(); ++i)
        (is_rigid ? before : after)[part_of[options.pairs[i].first]].add(of_pairs[i]);
    }
  }
  std::vector<bool> gains;
  for (std::size_t part = 0; part < members.size(); ++part)
    gains.push_back(after[part].met > 0.0 &&
                    is_gain(before[part], after[part], kGapWorthOfParts, options.cell));
  return gains;
}

}  // namespace gridmerge::internal
