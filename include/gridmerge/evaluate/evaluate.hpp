// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "gridmerge/merge/tree.hpp"

namespace gridmerge {

/// Root mean square, over the known cells of the moving map, of the distance between where two transforms of
/// it put a cell [m]. Symmetric in the transforms. Throws std::invalid_argument for an invalid grid.
/// O(cells).
GRIDMERGE_EXPORT double rms_displacement(const OccupancyGrid& moving, const SE2& T_estimate,
                                         const SE2& T_truth);

/// A map that a truth file names.
struct TruthMap {
  std::string name;            ///< as the file writes it
  std::filesystem::path path;  ///< a relative name is taken relative to the truth file's directory
  std::string named_at = {};   ///< "pairs.tsv:3": the truth file and the line, for messages
};

/// Two maps of one place.
struct TruePair {
  TruthMap fixed;          ///< the map that stays
  TruthMap moving;         ///< the map that is laid on it
  SE2 T_fixed_moving;      ///< between the map frames [m, rad]
  double tolerance = 0.0;  ///< largest rms_displacement() of a correct estimate [m]
  std::string
      tier;  ///< how hard the pair is, in the file's own words; empty where the file has no such column
  double overlap = 0.0;      ///< share of the smaller map that both know; 0 where the file does not say
  double shared_wall = 0.0;  ///< as in SimulatedPair [m]; 0 where the file does not say
};

/// Two maps with no common place: the only right answer is to refuse.
struct NegativePair {
  TruthMap fixed;   ///< the map that stays
  TruthMap moving;  ///< the map that is laid on it
};

/// A map of a set.
struct TrueMember {
  TruthMap map;            ///< as the file names it
  SE2 T_set_map;           ///< takes the map's frame to the set's [m, rad]
  double tolerance = 0.0;  ///< as in TruePair [m]
};

/// Maps of one place by several robots: at least two.
struct TrueSet {
  std::string name;                 ///< as the file writes it
  std::vector<TrueMember> members;  ///< in file order
};

/// Reads a ground-truth file: tab-separated text whose first line names the columns, in any order. Every
/// column is required unless said otherwise, an unknown one is an error, and blank lines are skipped. Numbers
/// are read the same way under every locale and must be finite; tolerances must be positive. Throws
/// FileError with "file:line: cause".
///
/// Columns: fixed, moving, x, y, theta, tolerance; optional: tier, overlap (in [0, 1]), shared_wall (from 0
/// on).
GRIDMERGE_EXPORT std::vector<TruePair> read_pairs(const std::filesystem::path& path);

/// As read_pairs(). Columns: fixed, moving.
GRIDMERGE_EXPORT std::vector<NegativePair> read_negatives(const std::filesystem::path& path);

/// As read_pairs(). Columns: set, map, x, y, theta, tolerance. Sets come in the order of their first line.
GRIDMERGE_EXPORT std::vector<TrueSet> read_sets(const std::filesystem::path& path);

/// The text of a ground-truth file, which reads back to the same values (numbers to the bit). Names are those
/// of the maps, not their paths; throws std::invalid_argument for one with a tab or a line break, for a
/// number that is not finite, and where some pairs have a tier and others have none.
GRIDMERGE_EXPORT std::string format_pairs(const std::vector<TruePair>& pairs);
/// As format_pairs().
GRIDMERGE_EXPORT std::string format_negatives(const std::vector<NegativePair>& negatives);
/// As format_pairs().
GRIDMERGE_EXPORT std::string format_sets(const std::vector<TrueSet>& sets);

/// What the engine is to be compared with.
struct Truth {
  std::vector<TruePair> pairs;          ///< maps of one place, and how they lie
  std::vector<NegativePair> negatives;  ///< maps of different places
  std::vector<TrueSet> sets;            ///< maps to be merged
};

/// How the engine is run and what is reported meanwhile.
struct EvaluateOptions {
  /// How two maps are compared; match() as it is, if empty.
  Matcher matcher;
  /// How the maps of a set are merged; merge() as it is, if empty.
  std::function<MergeResult(const std::vector<OccupancyGrid>&)> merger;
  /// How files become maps.
  LoadOptions load;
  /// How much of the maps of pairs and negatives is kept in memory, those used last first [bytes].
  std::size_t cache_bytes = std::size_t{96} << 20;
  /// Called with the number of finished and of all pairs, negatives and sets.
  std::function<void(std::size_t, std::size_t)> progress;
  /// Called with "file: what its author may not have meant", once for each such warning of a map.
  std::function<void(const std::string&)> warn;
};

/// A hypothesis beside the truth.
struct JudgedHypothesis {
  Hypothesis hypothesis;        ///< as the engine has it
  std::optional<double> error;  ///< rms_displacement() [m]; none for a negative
};

/// How one pair went: a true pair, or a negative.
struct MatchOutcome {
  std::string fixed;                   ///< as the truth file writes it
  std::string moving;                  ///< as the truth file writes it
  std::string tier;                    ///< empty for a negative
  Verdict verdict = Verdict::refused;  ///< on the best hypothesis
  double probability = 0.0;            ///< that the best hypothesis is the true pose
  /// rms_displacement() of the best hypothesis [m]; none for a negative, and none when there is no
  /// hypothesis.
  std::optional<double> error;
  std::optional<double> tolerance;           ///< [m]; none for a negative
  double seconds = 0.0;                      ///< from grids in memory to the verdict
  Reason reason = Reason::none;              ///< why it was refused
  std::vector<JudgedHypothesis> hypotheses;  ///< most probable first

  /// The maps have no common place.
  bool negative() const { return !tolerance; }
  /// The engine believed its best hypothesis.
  bool accepted() const { return verdict == Verdict::accepted; }
  /// The best hypothesis is the true pose, accepted or not.
  bool correct() const { return error && tolerance && *error <= *tolerance; }
};

/// How one set of maps went. A map alone in its component is left out; every other is correct or wrong.
struct SetOutcome {
  std::string name;          ///< as the truth file writes it
  std::size_t maps = 0;      ///< how many there are
  std::size_t correct = 0;   ///< within their tolerance
  std::size_t wrong = 0;     ///< in a component, but not within their tolerance
  std::size_t left_out = 0;  ///< alone

  /// Every map is correct.
  bool complete() const { return correct == maps; }
};

/// How everything went.
struct Evaluation {
  std::vector<MatchOutcome> matches;  ///< the pairs, then the negatives, each in file order
  std::vector<SetOutcome> sets;       ///< in file order
};

/// The files that evaluate() reads: each map of `truth` and its image (see map_files()), once each. Throws
/// FileError when a map's YAML cannot be read.
GRIDMERGE_EXPORT std::vector<std::filesystem::path> input_files(const Truth& truth);

/// Matches every pair and negative and merges every set, one after the other, reading maps as it goes.
/// Throws FileError when a map cannot be read, and std::runtime_error naming the maps when they cannot be
/// compared, or only with more memory than there is.
GRIDMERGE_EXPORT Evaluation evaluate(const Truth& truth, const EvaluateOptions& options = {});

}  // namespace gridmerge
