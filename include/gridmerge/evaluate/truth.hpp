// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

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

/// Readers of ground-truth files: tab-separated text whose first line names the columns, in any order. Every
/// column is required unless said otherwise, an unknown one is an error, and blank lines are skipped. Numbers
/// are read the same way under every locale and must be finite; tolerances must be positive. They throw
/// FileError with "file:line: cause".

/// Columns: fixed, moving, x, y, theta, tolerance; optional: tier, overlap (in [0, 1]), shared_wall (from 0
/// on).
GRIDMERGE_EXPORT std::vector<TruePair> read_pairs(const std::filesystem::path& path);

/// Columns: fixed, moving.
GRIDMERGE_EXPORT std::vector<NegativePair> read_negatives(const std::filesystem::path& path);

/// Columns: set, map, x, y, theta, tolerance. Sets come in the order of their first line.
GRIDMERGE_EXPORT std::vector<TrueSet> read_sets(const std::filesystem::path& path);

/// The text of a ground-truth file, which reads back to the same values (numbers to the bit). Names are those
/// of the maps, not their paths; throws std::invalid_argument for one with a tab or a line break.
GRIDMERGE_EXPORT std::string format_pairs(const std::vector<TruePair>& pairs);
/// As format_pairs().
GRIDMERGE_EXPORT std::string format_negatives(const std::vector<NegativePair>& negatives);
/// As format_pairs().
GRIDMERGE_EXPORT std::string format_sets(const std::vector<TrueSet>& sets);

}  // namespace gridmerge
