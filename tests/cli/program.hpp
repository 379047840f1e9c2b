// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gridmerge::test {

/// How a run of the gridmerge program ended.
struct Outcome {
  int exit_code = -1;  ///< -1 when a signal ended it
  std::string out;     ///< stdout
  std::string err;     ///< stderr
};

struct RunOptions {
  std::size_t file_size_limit = 0;  ///< RLIMIT_FSIZE of the program [bytes]; 0 = none
  bool stderr_is_terminal = false;  ///< a pseudo-terminal instead of a pipe
  bool close_stdout = false;        ///< start it with no stdout at all
  bool break_stdout = false;        ///< nobody reads stdout, as when `head` has left
  std::string stdout_to;            ///< a file for stdout instead of a pipe
};

/// Runs the built program with these arguments and waits for it.
Outcome run(const std::vector<std::string>& arguments, const RunOptions& options = {});

/// Number of lines; a last one without its newline counts.
std::size_t count_lines(const std::string& text);

}  // namespace gridmerge::test
