// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace gridmerge::cli {

/// Lets all options of a command read their values alike: literally, none empty, and none that is meant to be
/// another option. Every value has its own option before it. Called when all options are there.
void settle_values(CLI::App& command);

/// The command line for CLI::App::parse(), the last word first. "--name=value" are two words in it, as CLI11
/// takes the next word where nothing stands behind '='.
std::vector<std::string> words_to_parse(const CLI::App& app, int argc, const char* const* argv);

/// What to say of a command line that CLI11 does not take.
std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv);

}  // namespace gridmerge::cli
