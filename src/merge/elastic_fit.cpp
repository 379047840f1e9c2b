// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "merge/elastic_system.hpp"

namespace gridmerge::internal {

namespace {

/// How near walls must be to be tied, and how much stiffer the maps are than in the end: first whole maps
/// fit, then their parts.
struct Round {
  double reach;    // [sd]
  double stiffer;  // of bending
};
constexpr std::array<Round, 7> kRounds{
    {{6.0, 30.0}, {5.0, 16.0}, {3.8, 5.0}, {2.4, 1.5}, {2.0, 1.0}, {2.0, 1.0}, {2.0, 1.0}}};
constexpr double kLeastReach = 0.3;     // [m]
constexpr double kBendingLength = 1.5;  // [m]: over so much a map may well bend by sd
constexpr double kStrainLength = 0.3;   // [m]
constexpr double kTiedDown = 1e-3;      // of a shift [1/m^2]: next to nothing, where nothing else holds it
constexpr double kMostStrainOfStep = 0.35;
// Of a map that is not bent, whose scale and shear are of the whole map [1]: what a sensor or a drawing may
// well be off by.
constexpr double kUsualStrain = 0.03;

/// Of a map: as `stiffness`, or with the strain's weight shared among the squares of a lattice that is one
/// map.
Stiffness stiffness_of(const ElasticMember& member, const Stiffness& stiffness) {
  if (member.freedom == MapTransform::elastic) return stiffness;
  const ElasticSheet& sheet = member.sheet;
  const double squares = (sheet.columns() - 1.0) * (sheet.rows() - 1.0);
  return {0.0, 1.0 / (squares * std::pow(kUsualStrain * sheet.spacing(), 2))};
}

double reach_of(const Round& round, double sd) {
  return std::max(kLeastReach, round.reach * sd);
}

std::vector<Eigen::SparseMatrix<double>> energies_of(const std::vector<ElasticMember>& members, double sd,
                                                     const Round& round) {
  std::vector<Eigen::SparseMatrix<double>> energies(members.size());
  const Stiffness stiffness{round.stiffer * std::pow(kBendingLength / sd, 2),
                            std::pow(kStrainLength / sd, 2)};
  parallel_for(members.size(), [&](std::size_t i) {
    energies[i] = members[i].sheet.energy(stiffness_of(members[i], stiffness));
    for (Eigen::Index k = 0; k < energies[i].rows(); ++k) energies[i].coeffRef(k, k) += kTiedDown;
  });
  return energies;
}

}  // namespace

double first_reach(double sd) {
  return reach_of(kRounds.front(), sd);
}

std::vector<bool> fit(const ElasticFit& options, std::vector<ElasticMember>& members) {
  std::vector<bool> is_tied(members.size(), false);
  for (const Round& round : kRounds) {
    throw_if_cancelled();
    const std::vector<TiedPair> tied =
        tie_walls(members, options.pairs, reach_of(round, options.sd), options.cell, options.fold);
    for (const TiedPair& pair : tied) {
      if (pair.ties.empty()) continue;
      is_tied[pair.first] = is_tied[pair.second] = true;
    }
    const std::vector<std::vector<Point2>> shifts =
        solve_shifts(members, tied, energies_of(members, options.sd, round));
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (!members[i].held) members[i].sheet.step_to(shifts[i], kMostStrainOfStep);
    }
  }
  return is_tied;
}

}  // namespace gridmerge::internal
