// SPDX-License-Identifier: Apache-2.0
#include "console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <system_error>

namespace gridmerge::cli {

namespace {

// Work that ends before this shows no bar at all; after it the bar is drawn no more often than people can
// see.
constexpr auto kFirstDraw = std::chrono::milliseconds(300);
constexpr auto kDrawInterval = std::chrono::milliseconds(100);
constexpr int kBarWidth = 40;

void print_line_to_stderr(const std::string& line) {
  fmt::print(stderr, "{}\n", escape_controls(line));
}

}  // namespace

void print(const std::string& text) {
  errno = 0;
  const bool written =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written && errno != EPIPE) {
    throw std::runtime_error("standard output: " + std::generic_category().message(errno));
  }
}

void print_error(const std::string& message) {
  print_line_to_stderr("gridmerge: " + message);
}

std::string describe_pose(const SE2& T) {
  return fmt::format("x {:.3f} m, y {:.3f} m, theta {:.4f} rad ({:.2f} deg)", T.x, T.y, T.theta,
                     T.theta * 180.0 / std::numbers::pi);
}

Console::Console(const CommonOptions& options)
    : quiet_(options.quiet),
      verbose_(options.verbose),
      bar_wanted_(!options.quiet && ::isatty(STDERR_FILENO) == 1),
      next_draw_(Clock::now() + kFirstDraw) {}

Console::~Console() {
  clear();
}

void Console::warn(const std::string& message) {
  if (quiet_) return;
  clear();
  print_line_to_stderr("gridmerge: warning: " + message);
}

void Console::remark(const std::string& message) {
  if (!verbose_) return;
  clear();
  print_line_to_stderr(message);
}

void Console::progress(double share) {
  if (!bar_wanted_ || Clock::now() < next_draw_) return;
  next_draw_ = Clock::now() + kDrawInterval;
  bar_shown_ = true;
  share = std::clamp(share, 0.0, 1.0);
  fmt::print(stderr, "\r[{:<{}}] {:3.0f} %", std::string(static_cast<std::size_t>(share * kBarWidth), '#'),
             kBarWidth, 100.0 * share);
  std::fflush(stderr);
}

void Console::clear() {
  if (!bar_shown_) return;
  bar_shown_ = false;
  fmt::print(stderr, "\r\x1b[K");  // to the line's start, and erase it
  std::fflush(stderr);
}

void try_output_file(const std::string& path, const std::vector<std::filesystem::path>& inputs) {
  const StagedFile trial(path, {});
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return;
  for (const std::filesystem::path& input : inputs) {
    if (std::filesystem::equivalent(path, input, error))
      throw FileError(path, "is an input and would be replaced: choose another file for the result");
  }
}

LoadedMap load(const std::string& path, double resolution, Console& console) {
  LoadOptions options;
  options.resolution = resolution;
  LoadedMap map = load_map(path, options);
  for (const std::string& warning : map.warnings) console.warn(path + ": " + warning);
  console.remark(fmt::format("read {}: {} x {} cells of {} m", path, map.grid.width, map.grid.height,
                             map.grid.resolution));
  return map;
}

}  // namespace gridmerge::cli
