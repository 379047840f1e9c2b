// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace gridmerge::cli {

/// The columns of a terminal that help fits in.
constexpr std::size_t kHelpWidth = 100;

/// CLI11's help, with explanations of options broken between words. CLI11 2.1 prints each on one line.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace gridmerge::cli
