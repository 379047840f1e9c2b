// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"

#include <sstream>

namespace gridmerge::cli {

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  std::istringstream words(CLI::Formatter::make_option_desc(option));
  const std::size_t width = kHelpWidth - get_column_width();
  std::string text;
  std::size_t used = 0;
  for (std::string word; words >> word; used += word.size()) {
    if (used > 0 && used + 1 + word.size() > width) {
      text += '\n';
      used = 0;
    } else if (used > 0) {
      text += ' ';
      ++used;
    }
    text += word;
  }
  return text;
}

}  // namespace gridmerge::cli
