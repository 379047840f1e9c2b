// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Simulated maps and the truth about them, as files.
struct DatasetOptions {
  bool probabilities = false;  ///< maps in mode `raw`, with their probabilities, instead of `trinary`
};

/// Makes sure, before long work, that a dataset can be written to `directory`. Leaves everything as it was.
/// Throws FileError.
GRIDMERGE_INTERNAL_EXPORT void prepare_dataset(const std::filesystem::path& directory);

/// Writes a simulation to `directory`, which is made if need be: `robot_1.yaml` and so on with their images
/// (and `robot_1_step_1.yaml` and so on, as they were before),
/// `building.yaml` (the building itself), `building.tsv` (where each robot's map lies on it), and
/// `pairs.tsv`, `negatives.tsv` and `sets.tsv`. The maps of `elsewhere`, which are of other buildings, become
/// `elsewhere_1.yaml` and so on, each of them a negative with every robot's map. Negatives are also the
/// strangers of the simulation.
///
/// Of an earlier dataset there, the robots' maps and the maps of other buildings that its tables name are
/// removed where this one has none of that name, and so are their earlier moments. Other files stay.
///
/// All files take their places at one point of time, even if the program is killed. Throws FileError.
GRIDMERGE_INTERNAL_EXPORT void write_dataset(const std::filesystem::path& directory,
                                             const Simulation& simulation,
                                             const std::vector<Simulation>& elsewhere,
                                             const DatasetOptions& options = {});

}  // namespace gridmerge::internal
