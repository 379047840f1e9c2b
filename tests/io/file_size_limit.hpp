// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <exception>
#include <string>

namespace gridmerge::test {

/// Runs `call` in a child process that can write no file beyond `bytes`, as on a full disk, and returns the
/// message of what it threw ("" if nothing).
template <typename Call>
std::string with_file_size_limit(int bytes, const Call& call) {
  int channel[2];
  if (pipe(channel) != 0) return ADD_FAILURE() << "no pipe", "";
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      call();
    } catch (const std::exception& error) {
      if (write(channel[1], error.what(), std::strlen(error.what())) < 0) _exit(1);
    }
    _exit(0);  // without the parent's exit handlers
  }
  close(channel[1]);
  std::string message;
  char buffer[256];
  for (ssize_t got; (got = read(channel[0], buffer, sizeof buffer)) > 0;)
    message.append(buffer, static_cast<std::size_t>(got));
  close(channel[0]);
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the child ended with status " << status;
  return message;
}

}  // namespace gridmerge::test
