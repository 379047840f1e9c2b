// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace gridmerge::cli {

/// What the program returns to its caller.
enum ExitCode {
  kDone = 0,
  kError = 1,  ///< one line on stderr says what and why
  kUsage = 2,
  kRefused = 3,  ///< done, but not all is merged or matched: maps were refused, or a shard misses matches
};

/// What the command line asks for. Set while it is parsed and called afterwards, so that usage errors and
/// errors of the work itself stay apart. Returns an ExitCode; throws std::exception.
using Action = std::function<int()>;

/// Each adds its subcommand to `app`, which sets `action` when it is the one called.
void add_info(CLI::App& app, Action& action);
void add_match(CLI::App& app, Action& action);
void add_measure(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_node(CLI::App& app, Action& action);  // where the component dds is built
void add_report(CLI::App& app, Action& action);
void add_view(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_simulate(CLI::App& app, Action& action);

}  // namespace gridmerge::cli
