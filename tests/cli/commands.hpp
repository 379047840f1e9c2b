// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace gridmerge::test {

/// All subcommands of the program.
inline const std::vector<std::string> kCommands = {
    "info", "match", "measure", "merge", "report", "view", "evaluate", "simulate",
#ifdef GRIDMERGE_HAS_NODE
    "node",
#endif
};

}  // namespace gridmerge::test
