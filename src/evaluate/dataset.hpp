// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Simulated maps and the truth about them, as files.
struct DatasetOptions {
  bool probabilities = false;  ///< maps in mode `raw`, with their probabilities, instead of `trinary`
};

/// How many maps a dataset has.
struct DatasetSize {
  std::size_t robots = 1;
  std::size_t steps = 1;   ///< of each robot's map
  std::size_t others = 0;  ///< maps of other buildings
};

/// Makes sure, before long work, that write_dataset() can write such a dataset to `directory`. Leaves
/// everything as it was. Throws FileError.
GRIDMERGE_INTERNAL_EXPORT void prepare_dataset(const std::filesystem::path& directory,
                                               const DatasetSize& size);

/// Writes a simulation to `directory`, which is made if need be: `robot_1.yaml` and so on with their images
/// (and `robot_1_step_1.yaml` and so on, as they were before),
/// `building.yaml` (the building itself), `building.tsv` (where each robot's map lies on it), `pairs.tsv`,
/// `negatives.tsv` and `sets.tsv`, and `simulation.sha256` (the digests of all these). The maps of
/// `elsewhere`, which are of other buildings, become `elsewhere_1.yaml` and so on, each of them a negative
/// with every robot's map. Negatives are also the strangers of the simulation.
///
/// An earlier dataset there is replaced: what this one has no file for is removed, and returned. A file
/// belongs to a dataset if it is as the list of digests says. Any other file that would be replaced or
/// removed is an error, and all stays as it was. Files of other names stay.
///
/// All files take their places at one point of time, even if the program is killed. Throws FileError.
GRIDMERGE_INTERNAL_EXPORT std::vector<std::filesystem::path> write_dataset(
    const std::filesystem::path& directory, const Simulation& simulation,
    const std::vector<Simulation>& elsewhere, const DatasetOptions& options = {});

}  // namespace gridmerge::internal
