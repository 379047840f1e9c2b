// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/evaluate/truth.hpp"
#include "gridmerge/export.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/tree.hpp"

namespace gridmerge {

/// What the engine is to be compared with.
struct Truth {
  std::vector<TruePair> pairs;          ///< maps of one place, and how they lie
  std::vector<NegativePair> negatives;  ///< maps of different places
  std::vector<TrueSet> sets;            ///< maps to be merged
};

/// How the engine is run and what is told meanwhile.
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
/// compared.
GRIDMERGE_EXPORT Evaluation evaluate(const Truth& truth, const EvaluateOptions& options = {});

}  // namespace gridmerge
