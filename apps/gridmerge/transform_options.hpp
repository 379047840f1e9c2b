// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace gridmerge::cli {

/// The options that say what may be done to maps. Not owned.
struct TransformOptions {
  CLI::Option* transform = nullptr;
  CLI::Option* elastic = nullptr;
};

/// --transform, into `name`, and --elastic.
TransformOptions add_transform_options(CLI::App& command, std::string& name);

/// What both options say together, into `name`. Throws CLI::ValidationError if they contradict each other, or
/// if the tree, whose maps are rigid, is to change maps.
void settle_transform(const TransformOptions& options, bool up_the_tree, std::string& name);

}  // namespace gridmerge::cli
