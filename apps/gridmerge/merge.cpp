// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
namespace gridmerge::cli {
void add_merge(CLI::App&, Action&) {}
}  // namespace gridmerge::cli
