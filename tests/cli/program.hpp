// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gridmerge::test {

/// How a run of the gridmerge program ended.
struct Outcome {
  int exit_code = -1;  ///< -1 when a signal ended it
  int signal = 0;      ///< that ended it
  std::string out;     ///< stdout
  std::string err;     ///< stderr
};

struct RunOptions {
  std::size_t file_size_limit = 0;       ///< RLIMIT_FSIZE of the program [bytes]; 0 = none
  bool stderr_is_terminal = false;       ///< a pseudo-terminal instead of a pipe
  bool close_stdout = false;             ///< start it with no stdout at all
  bool break_stdout = false;             ///< nobody reads stdout, as when `head` has left
  std::string stdout_to;                 ///< a file for stdout instead of a pipe
  bool close_stderr = false;             ///< start it with no stderr at all
  std::string stderr_to;                 ///< a file for stderr instead of a pipe
  std::size_t stack_limit = 0;           ///< RLIMIT_STACK of the program [bytes]; 0 = this program's
  std::vector<std::string> environment;  ///< "NAME=value", added to this program's
  bool faulty = false;                   ///< the program whose calls can be made to fail: faulty_calls.cpp
};

/// Runs the built program with these arguments and waits for it.
Outcome run(const std::vector<std::string>& arguments, const RunOptions& options = {});

/// A run of the program that goes on beside the test. Ended with SIGKILL if need be when the object goes.
class RunningProgram {
 public:
  explicit RunningProgram(const std::vector<std::string>& arguments, const RunOptions& options = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// The next line of stdout, without its end; "" when there will be none.
  std::string read_line();

  void send(int signal) const;

  /// The most memory that it has had in RAM [MB], as the system counts it (VmHWM).
  double peak_memory() const;

  /// Sends the signal and waits for the end. The outcome's stdout is what was not read before.
  Outcome end_with(int signal);

 private:
  int child_ = 0;
  int out_ = -1;
  int err_ = -1;
};

/// Number of lines; a last one without its newline counts.
std::size_t count_lines(const std::string& text);

}  // namespace gridmerge::test
