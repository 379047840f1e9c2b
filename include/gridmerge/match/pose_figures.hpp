// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace gridmerge {

/// What speaks for a pose of two maps and against it. pose_figures() lists them with their meanings.
struct PoseFigures {
  double score = 0.0;
  double lead = 0.0;
  double stands_out = 0.0;
  double wall_score = 0.0;
  double seen_walls = 0.0;
  double walls_met = 0.0;
  double walls_met_locally = 0.0;
  double wall_lines = 0.0;
  double seen_things = 0.0;
  double things_met = 0.0;
  double spread = 0.0;
  double held = 0.0;
  double held_most = 0.0;
  double free_direction = 0.0;
  double acceptance_index = 0.0;
  double next_acceptance_index = 0.0;
  double common_area = 0.0;
  double overlap = 0.0;
  double sigma = 0.0;
  double outliers = 0.0;
};

/// One of the figures: the one place where its name, unit and meaning stand.
struct PoseFigure {
  const char* name;
  const char* unit;
  const char* meaning;
  double PoseFigures::*value;
};

/// All of them, in the order of PoseFigures.
std::span<const PoseFigure> pose_figures();

}  // namespace gridmerge
