// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cached_merge.hpp"
#include "exports.hpp"
#include "gridmerge/merge/merge.hpp"
#include "known_poses.hpp"
#include "options.hpp"
#include "plan.hpp"
#include "search_options.hpp"
#include "transform_options.hpp"

namespace gridmerge::cli {

/// What the command line of `gridmerge merge` says.
struct MergeCommandOptions {
  CommonOptions common;
  std::vector<std::string> maps;
  std::string output;
  LoadOptions load;
  double output_resolution = 0.0;
  double max_false_joins = MergeOptions{}.max_false_joins;
  std::string transform = name_of(MapTransform::rigid);
  double max_missed = MergeOptions{}.max_missed;
  bool all_pairs = false;  // asked for by name
  SearchOptions search;
  KnownPoseOptions known;
  CacheOptions cache;
  ExportOptions exports;
  PlanCommandOptions plan;
};

/// Options of which it matters whether they were given.
struct GivenMergeOptions {
  CLI::Option* max_false_joins = nullptr;
  CLI::Option* max_missed = nullptr;
  TransformOptions transform;
};

/// All of them, in the order of --help, with checks of what one option alone can get wrong.
GivenMergeOptions add_merge_options(CLI::App& command, MergeCommandOptions& options);

/// Settles what --transform and --elastic say. Throws CLI::Error for options that do not go together.
void settle(MergeCommandOptions& options, const GivenMergeOptions& given);

}  // namespace gridmerge::cli
