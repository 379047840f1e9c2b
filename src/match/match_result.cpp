// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match_result.hpp"

#include <array>

namespace gridmerge {

std::span<const PoseFigure> pose_figures() {
  using F = PoseFigures;
  static constexpr std::array kFigures{
      PoseFigure{"score", "nats",
                 R"(the evidence of walls and common area: "same place" against "unrelated")", &F::score},
      PoseFigure{"score_margin", "sqrt(nats)",
                 "the score's margin over the best other one, by its square root: what chance moves it by",
                 &F::score_margin},
      PoseFigure{"stands_out", "nats", "how far its rank stands above those of all other hypotheses together",
                 &F::stands_out},
      PoseFigure{"wall_score", "nats", "of it, the evidence of the walls", &F::wall_score},
      PoseFigure{"seen_walls", "m", "length of the walls of both maps that lie where the other map has seen",
                 &F::seen_walls},
      PoseFigure{"walls_met", "share",
                 "of these, the share that meets a wall of the other map under the pose", &F::walls_met},
      PoseFigure{"walls_met_locally", "share",
                 "the same when every patch of the maps may also shift and turn a little by itself",
                 &F::walls_met_locally},
      PoseFigure{"wall_lines", "lines",
                 "straight lines of wall on which the maps agree, as a number of equally long ones",
                 &F::wall_lines},
      PoseFigure{"seen_things", "m",
                 "of the seen walls, the length of those of small things that stand alone, of both maps",
                 &F::seen_things},
      PoseFigure{"things_met", "share",
                 "of these, the share that meets a wall of the other map, patch by patch", &F::things_met},
      PoseFigure{"spread", "m",
                 "how far the walls on which they agree spread in the direction in which they spread least",
                 &F::spread},
      PoseFigure{"held", "nats/m",
                 "what the score loses on a shift by a metre in the direction in which it loses least",
                 &F::held},
      PoseFigure{"held_most", "nats/m", "the same in the direction in which it loses most", &F::held_most},
      PoseFigure{"free_direction", "rad",
                 "the direction in which it loses least, in the fixed map's frame, in (-pi/2, pi/2]",
                 &F::free_direction},
      PoseFigure{"acceptance_index", "share", "of the cells known in both maps, the share that is equal",
                 &F::acceptance_index},
      PoseFigure{"common_area", "m^2", "area that is known in both maps", &F::common_area},
      PoseFigure{"overlap", "share", "of the smaller map's known cells, the share that is known in both",
                 &F::overlap},
      PoseFigure{"sigma", "m", "standard deviation of the error model that explains the walls best",
                 &F::sigma},
      PoseFigure{"outliers", "share", "share of walls that this model does not explain", &F::outliers}};
  return kFigures;
}

const char* name_of(Verdict verdict) {
  return verdict == Verdict::accepted ? "accepted" : "refused";
}

const char* name_of(Reason reason) {
  switch (reason) {
    case Reason::nothing_to_compare:
      return "nothing_to_compare";
    case Reason::ambiguous:
      return "ambiguous";
    case Reason::contradiction:
      return "contradiction";
    case Reason::too_little_overlap:
      return "too_little_overlap";
    case Reason::several:
      return "several";
    case Reason::contradicts_others:
      return "contradicts_others";
    case Reason::over_budget:
      return "over_budget";
    case Reason::none:
      break;
  }
  return "none";
}

namespace {

/// Of p_fixed = scale * R * p_moving + t: what takes p_fixed to p_moving.
void invert(SE2& T_fixed_moving, double& scale) {
  T_fixed_moving = inverse(T_fixed_moving);
  if (scale == 1.0) return;
  T_fixed_moving.x /= scale;
  T_fixed_moving.y /= scale;
  scale = 1.0 / scale;
}

}  // namespace

MatchResult inverse(MatchResult result) {
  invert(result.T_fixed_moving, result.scale);
  for (Hypothesis& hypothesis : result.hypotheses) {
    invert(hypothesis.T_fixed_moving, hypothesis.scale);
    double& free_direction = hypothesis.figures.free_direction;
    free_direction = undirected_angle(free_direction + hypothesis.T_fixed_moving.theta);
  }
  return result;
}

}  // namespace gridmerge
