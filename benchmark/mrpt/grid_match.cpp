// SPDX-License-Identifier: Apache-2.0
// MRPT's matching of two occupancy grids (mrpt::slam::CGridMapAligner) on map_server files. MRPT's own
// program for it, grid-matching, takes logs of laser scans alone (.simplemap), from which it draws the grids
// itself. This one hands the same aligner, with that program's settings, the grids as they are.
//
//   grid_match FIXED.yaml MOVING.yaml [OPTIONS.ini]
//
// Prints a line "mode LOG_WEIGHT GOODNESS X Y THETA" per mode of the density that the aligner returns:
// T_fixed_moving in metres and radians of the map frames, and in [0, 1] the goodness that the aligner's own
// ICP gives that pose. No line says that it found no match.
#include <mrpt/config/CConfigFile.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPosePDFSOG.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CGridMapAligner.h>
#include <mrpt/slam/CICP.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

namespace {

using mrpt::maps::CMultiMetricMap;
using mrpt::maps::COccupancyGridMap2D;
using mrpt::maps::CSimplePointsMap;
using mrpt::poses::CPosePDFSOG;
using mrpt::slam::CGridMapAligner;

// The grid, and its occupied cells as points: with them the aligner refines and checks each mode by ICP.
CMultiMetricMap load(const std::string& path) {
  const auto grid = COccupancyGridMap2D::Create();
  if (!grid->loadFromROSMapServerYAML(path)) throw std::runtime_error("cannot read " + path);
  const auto points = CSimplePointsMap::Create();
  grid->getAsPointCloud(*points);
  CMultiMetricMap map;
  map.maps.push_back(grid);
  map.maps.push_back(points);
  return map;
}

// With the aligner's settings of ICP.
double goodness(const CMultiMetricMap& fixed, const CMultiMetricMap& moving,
                const mrpt::poses::CPose2D& pose) {
  mrpt::slam::CICP icp;
  icp.options.maxIterations = 20;
  icp.options.smallestThresholdDist = 0.05F;
  icp.options.thresholdDist = 0.75F;
  mrpt::slam::CICP::TReturnInfo info;
  icp.Align(fixed.mapByClass<CSimplePointsMap>().get(), moving.mapByClass<CSimplePointsMap>().get(), pose,
            info);
  return info.goodness;
}

void match(const std::string& fixed_path, const std::string& moving_path, const std::string& options_path) {
  const CMultiMetricMap fixed = load(fixed_path);
  const CMultiMetricMap moving = load(moving_path);
  mrpt::random::getRandomGenerator().randomize(1);
  CGridMapAligner aligner;
  aligner.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  if (!options_path.empty()) {
    const mrpt::config::CConfigFile file(options_path);
    aligner.options.loadFromConfigFile(file, "grid-match");
  }
  // As grid-matching sets it.
  aligner.options.ransac_SOG_sigma_m = 2.0F * fixed.mapByClass<COccupancyGridMap2D>()->getResolution();

  CGridMapAligner::TReturnInfo info;
  const auto density =
      std::dynamic_pointer_cast<CPosePDFSOG>(aligner.Align(&fixed, &moving, mrpt::poses::CPose2D(), info));
  if (!density) throw std::runtime_error("the aligner returned another kind of density");
  for (const auto& mode : *density) {
    std::printf("mode %.9g %.9g %.9g %.9g %.9g\n", mode.log_w, goodness(fixed, moving, mode.mean),
                mode.mean.x(), mode.mean.y(), mode.mean.phi());
  }
}

}  // namespace

int main(int count, char** words) {
  if (count != 3 && count != 4) {
    std::fputs("usage: grid_match FIXED.yaml MOVING.yaml [OPTIONS.ini]\n", stderr);
    return 2;
  }
  try {
    match(words[1], words[2], count == 4 ? words[3] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "grid_match: %s\n", error.what());
    return 1;
  }
  return 0;
}
