// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <string>

extern char** environ;

namespace gridmerge::test {

namespace {

// Two ends of a pipe or a pseudo-terminal; the child gets the writing one.
struct Channel {
  int read_end = -1;
  int write_end = -1;

  void close_read_end() { close_if_open(read_end); }
  void close_write_end() { close_if_open(write_end); }

  static void close_if_open(int& descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
  }
};

Channel open_channel(bool terminal) {
  Channel channel;
  if (terminal) {
    if (::openpty(&channel.read_end, &channel.write_end, nullptr, nullptr, nullptr) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    return channel;
  }
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  return {ends[0], ends[1]};
}

// Lowers a limit for the children that are started while it lives.
class Limit {
 public:
  Limit(__rlimit_resource resource, std::size_t bytes) : resource_(resource) {
    ::getrlimit(resource_, &before_);
    if (bytes == 0) return;
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(resource_, &limit);
  }
  ~Limit() { ::setrlimit(resource_, &before_); }
  Limit(const Limit&) = delete;
  Limit& operator=(const Limit&) = delete;

 private:
  __rlimit_resource resource_;
  rlimit before_{};
};

// With their usual effect in the child, even if this program was started to ignore them.
class UsualSignals {
 public:
  UsualSignals() {
    sigset_t signals;
    ::sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&signals, signal);
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
  }
  ~UsualSignals() { ::posix_spawnattr_destroy(&attributes_); }
  UsualSignals(const UsualSignals&) = delete;
  UsualSignals& operator=(const UsualSignals&) = delete;

  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

pid_t start(const std::vector<std::string>& arguments, const RunOptions& options, const Channel& out,
            const Channel& err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (options.close_stdout) {
    posix_spawn_file_actions_addclose(&actions, STDOUT_FILENO);
  } else if (!options.stdout_to.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, options.stdout_to.c_str(), O_WRONLY, 0);
  } else {
    posix_spawn_file_actions_adddup2(&actions, out.write_end, STDOUT_FILENO);
  }
  if (options.close_stderr) {
    posix_spawn_file_actions_addclose(&actions, STDERR_FILENO);
  } else if (!options.stderr_to.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, options.stderr_to.c_str(), O_WRONLY, 0);
  } else {
    posix_spawn_file_actions_adddup2(&actions, err.write_end, STDERR_FILENO);
  }

  std::vector<std::string> words = {options.faulty ? GRIDMERGE_FAULTY : GRIDMERGE_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = options.environment;
  for (char** variable = environ; *variable != nullptr; ++variable) variables.emplace_back(*variable);
  const std::vector<char*> argv = pointers_to(words), environment = pointers_to(variables);

  pid_t child = 0;
  const Limit file_size(RLIMIT_FSIZE, options.file_size_limit), stack(RLIMIT_STACK, options.stack_limit);
  const UsualSignals signals;
  const int error = ::posix_spawn(&child, argv[0], &actions, signals.get(), argv.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start " + words[0]);
  return child;
}

// Reads both at once: a child that fills one pipe while we wait on the other would wait forever.
void drain(Channel& out, std::string& out_text, Channel& err, std::string& err_text) {
  std::array<char, 4096> block{};
  while (out.read_end >= 0 || err.read_end >= 0) {
    std::array<pollfd, 2> ready = {pollfd{out.read_end, POLLIN, 0}, pollfd{err.read_end, POLLIN, 0}};
    if (::poll(ready.data(), ready.size(), -1) < 0 && errno != EINTR) throw std::runtime_error("poll failed");
    const auto read_some = [&](const pollfd& state, Channel& channel, std::string& text) {
      if (channel.read_end < 0 || state.revents == 0) return;
      const ssize_t count = ::read(channel.read_end, block.data(), block.size());
      if (count > 0) {
        text.append(block.data(), static_cast<std::size_t>(count));
      } else {
        channel.close_read_end();  // the end, or EIO from a terminal that nobody holds any more
      }
    };
    read_some(ready[0], out, out_text);
    read_some(ready[1], err, err_text);
  }
}

void wait_for(pid_t child, Outcome& outcome) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

Outcome run(const std::vector<std::string>& arguments, const RunOptions& options) {
  Channel out = open_channel(false);
  Channel err = open_channel(options.stderr_is_terminal);
  if (options.break_stdout) out.close_read_end();
  const pid_t child = start(arguments, options, out, err);
  out.close_write_end();
  err.close_write_end();

  Outcome outcome;
  drain(out, outcome.out, err, outcome.err);
  wait_for(child, outcome);
  return outcome;
}

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const RunOptions& options) {
  Channel out = open_channel(false);
  Channel err = open_channel(false);
  child_ = start(arguments, options, out, err);
  out.close_write_end();
  err.close_write_end();
  out_ = out.read_end;
  err_ = err.read_end;
}

RunningProgram::~RunningProgram() {
  if (child_ != 0) end_with(SIGKILL);
}

std::string RunningProgram::read_line() {
  std::string line;
  char c = 0;
  while (::read(out_, &c, 1) == 1 && c != '\n') line += c;
  return line;
}

double RunningProgram::peak_memory() const {
  std::ifstream status("/proc/" + std::to_string(child_) + "/status");
  for (std::string line; std::getline(status, line);) {
    constexpr double kKilobyte = 1024.0 / 1e6;
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) * kKilobyte;
  }
  throw std::runtime_error("the program is gone");
}

void RunningProgram::send(int signal) const {
  ::kill(child_, signal);
}

Outcome RunningProgram::end_with(int signal) {
  send(signal);
  Outcome outcome;
  Channel out{out_, -1}, err{err_, -1};
  drain(out, outcome.out, err, outcome.err);
  wait_for(child_, outcome);
  child_ = 0;
  return outcome;
}

std::size_t count_lines(const std::string& text) {
  const auto newlines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  return newlines + (!text.empty() && text.back() != '\n');
}

}  // namespace gridmerge::test
