// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "gridmerge/match/match.hpp"

namespace gridmerge::cli {

/// Options that every subcommand has.
struct CommonOptions {
  bool quiet = false;
  bool verbose = false;
  int threads = 0;
};

void add_common_options(CLI::App& command, CommonOptions& options);

/// --resolution: of maps that are bare images.
void add_resolution_option(CLI::App& command, double& resolution);

/// --accept: from which probability on a pair is accepted.
void add_accept_option(CLI::App& command, double& probability);

/// A resolution that a map can have.
extern const CLI::Validator kMetresPerCell;

MatchOptions match_options(const CommonOptions& common, double accept_probability);

}  // namespace gridmerge::cli
