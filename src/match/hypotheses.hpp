// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "match/refine.hpp"
#include "match/verdict.hpp"
#include "match/walls_met.hpp"
#include "search/exhaustive.hpp"
#include "similarity/agreement.hpp"

namespace gridmerge::internal {

/// Two maps in the cells in which they are compared. Not owned.
struct ComparedMaps {
  /// `moving` is the smaller one by is_smaller(): its walls have the best chance to be met in the other one.
  ComparedMaps(const PreparedMap& fixed, const PreparedMap& moving);
  /// The same in cells of `cell` metres, no smaller than either map's.
  ComparedMaps(const PreparedMap& fixed, const PreparedMap& moving, double cell);

  const OccupancyGrid& fixed;
  const OccupancyGrid& moving;
  double cell;          ///< side [m]
  double smaller_area;  ///< of the two maps' known areas [m^2]
  const LikelihoodField& fixed_walls;
  const LikelihoodField& moving_walls;
};

/// A pose between map frames, from one between grid frames in cells, and the inverse.
SE2 to_map_frames(const SE2& T_cells, const LikelihoodField& fixed, const LikelihoodField& moving);
SE2 to_cells(const SE2& T_fixed_moving, const LikelihoodField& fixed, const LikelihoodField& moving);

/// How densely every pose of these maps is searched.
ExhaustiveSearchOptions choose_search(const ComparedMaps& maps);

/// Poses displaced by less than this are one hypothesis [cells].
double distinct_displacement(const ComparedMaps& maps);

/// A hypothesis at a maximum, and whether its cells lie exactly on cells.
struct Settled {
  Hypothesis hypothesis;
  bool is_cell_on_cell = false;
};

/// What the walls of two maps in their working cells say of poses, and what all figures say.
class PoseJudge {
 public:
  explicit PoseJudge(const ComparedMaps& maps);

  /// The hypothesis of a pose between the grid frames [cells], its probability not yet known.
  Hypothesis judge(const SE2& T_cells) const;

  /// The hypothesis at the maximum of the evidence near a judged one: of all walls, in steps down to a
  /// sixteenth of a cell. Where a pose near one of the two that lays cell on cell is no worse, that one: a
  /// map lies on itself exactly.
  Settled settle(const Hypothesis& hypothesis) const;

  /// What is known of a pose between the grid frames [cells] at little cost: its walls' evidence and its
  /// cells. Figures of other kinds are 0.
  PoseFigures cheap_figures(const SE2& T_cells, const Evidence& walls) const;

  const WallEvidence& walls() const { return walls_; }

 private:
  /// All that speaks for a pose between the grid frames [cells] and against it.
  PoseFigures figures(const SE2& T_cells) const;

  /// A pose between the map frames that lays cell on cell, and its agreement().
  struct CellOnCell {
    SE2 T_fixed_moving;
    double agreement;
  };

  /// Of the poses between the map frames that lay cell on cell, near one between the grid frames [cells], the
  /// one at which most cells agree; none if the maps' cells differ in size, or if there is none near.
  std::optional<CellOnCell> best_cell_on_cell(const SE2& T_cells) const;

  /// The acceptance index of the cells that are counted, between the map frames.
  double agreement(const SE2& T_fixed_moving) const;

  const ComparedMaps& maps_;
  PoseMetric metric_;
  WallEvidence walls_;
  WallEvidence settling_walls_;
  WallEvidence sliding_walls_;  // fewer, for how well a pose is held
  AgreementCounter cells_;      // some of all
  WallPatches patches_;
};

/// The figures of each, with what it has before its rivals (compare_rivals()).
std::vector<PoseFigures> compared_figures(const std::vector<Hypothesis>& hypotheses,
                                          const ComparedMaps& maps);

/// Gives each its probability, and sorts by it, best first.
void weigh(std::vector<Hypothesis>& hypotheses, const ComparedMaps& maps);

/// The same by a model, with the figures of each, in which its rivals are compared.
void weigh_by(const VerdictModel& model, const std::vector<PoseFigures>& figures,
              std::vector<Hypothesis>& hypotheses);

/// The figures of each.
std::vector<PoseFigures> figures_of(const std::vector<Hypothesis>& hypotheses);

}  // namespace gridmerge::internal
