// SPDX-License-Identifier: Apache-2.0
#include "console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <stdexcept>
#include <system_error>

#include "grid/parallel.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/grid/execution.hpp"
#include "io/add_map.hpp"
#include "io/atomic_file.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

// Work that ends before this shows no bar at all; after it the bar is drawn no more often than people can
// see.
constexpr auto kFirstDraw = std::chrono::milliseconds(300);
constexpr auto kDrawInterval = std::chrono::milliseconds(100);
constexpr int kBarWidth = 30;

// There is nobody to tell that stderr cannot be written, and no reason to end the work for it.
void print_to_stderr(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void print_line_to_stderr(const std::string& line) {
  print_to_stderr(escape_controls(line) + "\n");
}

// Rounded up: what is said to take a second is not done in none.
std::string describe_time_left(std::chrono::duration<double> left) {
  const double seconds = std::ceil(left.count());
  if (seconds < 60.0) return fmt::format("{:.0f} s left", seconds);
  const double minutes = std::ceil(left.count() / 60.0);
  if (minutes < 60.0) return fmt::format("{:.0f} min left", minutes);
  return fmt::format("{:.1f} h left", left.count() / 3600.0);
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

std::string describe_removed(const std::vector<std::filesystem::path>& removed, const char* of) {
  std::string names;
  for (const std::filesystem::path& file : removed) {
    std::error_code error;
    if (std::filesystem::exists(std::filesystem::symlink_status(file, error))) continue;  // written anew
    names += (names.empty() ? "" : ", ") + file.filename().string();
  }
  return names.empty() ? names : fmt::format("removed: {} (of an earlier {})\n", escape_controls(names), of);
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
  tell("warning: " + message);
}

void Console::tell(const std::string& message) {
  if (quiet_) return;
  clear();
  print_line_to_stderr("gridmerge: " + message);
}

void Console::remark(const std::string& message) {
  if (!verbose_) return;
  clear();
  print_line_to_stderr(message);
}

void Console::progress(const std::string& phase, double share) {
  share = std::clamp(share, 0.0, 1.0);
  draw(phase, [&] {
    const std::string done(static_cast<std::size_t>(share * kBarWidth), '#');
    std::string bar = fmt::format(" [{:<{}}] {:3.0f} %", done, kBarWidth, 100.0 * share);
    if (share == 0.0) return bar;
    const std::chrono::duration<double> taken = Clock::now() - phase_began_;
    return bar + ", " + describe_time_left(taken * (1.0 - share) / share);
  });
}

void Console::progress(const std::string& phase) {
  draw(phase, [] { return " ..."; });
}

void Console::draw(const std::string& phase, const std::function<std::string()>& rest) {
  const Clock::time_point now = Clock::now();
  const bool is_new = phase != phase_;
  if (is_new) {
    phase_ = phase;
    phase_began_ = now;
  }
  if (!bar_wanted_ || (now < next_draw_ && !(is_new && bar_shown_))) return;
  next_draw_ = now + kDrawInterval;
  bar_shown_ = true;
  print_to_stderr("\r" + phase_ + rest() + "\x1b[K");
}

void Console::clear() {
  if (!bar_shown_) return;
  bar_shown_ = false;
  print_to_stderr("\r\x1b[K");  // to the line's start, and erase it
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

LoadedMap MapReader::read(const std::string& path) {
  return take(path, load_any_map(path, options_));
}

bool MapReader::lacks_resolution(const std::string& path) const {
  return options_.resolution == 0.0 && internal::is_bare_image(path);
}

LoadedMap MapReader::read(const std::string& path, double resolution, const std::string& other) {
  if (!lacks_resolution(path)) return read(path);
  console_.warn(
      fmt::format("{}: no --resolution says how large its pixels are, so the range of scales counts "
                  "from {} m, as of {}",
                  path, resolution, other));
  LoadOptions options = options_;
  options.resolution = resolution;
  return take(path, load_any_map(path, options));
}

std::vector<LoadedMap> MapReader::read_all(const std::vector<std::string>& paths, int threads) {
  constexpr std::size_t kAtOnce = 16;  // between two looks at how much is done
  std::vector<LoadedMap> maps(paths.size());
  std::vector<std::exception_ptr> faults(paths.size());
  for (std::size_t begin = 0; begin < paths.size(); begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, paths.size() - begin);
    console_.progress("reading maps", static_cast<double>(begin) / static_cast<double>(paths.size()));
    with_threads(threads, [&] {
      internal::parallel_for(count, [&](std::size_t i) {
        try {
          maps[begin + i] = load_any_map(paths[begin + i], options_);
        } catch (const FileError&) {
          faults[begin + i] = std::current_exception();
        }
      });
    });
    for (std::size_t i = begin; i < begin + count; ++i) {
      if (faults[i]) std::rethrow_exception(faults[i]);
      maps[i] = take(paths[i], std::move(maps[i]));
    }
  }
  return maps;
}

LoadedMap MapReader::take(const std::string& path, LoadedMap map) {
  for (const MapWarning& warning : map.warnings) warned_.push_back({path, warning});
  console_.remark(fmt::format("read {}: {} x {} cells of {} m", path, map.grid.width, map.grid.height,
                              map.grid.resolution));
  return map;
}

void MapReader::tell_warnings() {
  constexpr std::size_t kNamed = 3;
  while (!warned_.empty()) {
    const Warned first = warned_.front();
    std::vector<std::string> others;
    std::erase_if(warned_, [&](const Warned& one) {
      if (one.warning.kind != first.warning.kind) return false;
      if (one.path != first.path) others.push_back(one.path);
      return true;
    });
    std::string also;
    if (!others.empty()) {
      const std::size_t named = std::min(others.size(), kNamed);
      also = fmt::format(" (also {}{}: 'gridmerge info' tells of each)",
                         fmt::join(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(named), ", "),
                         others.size() > named ? fmt::format(" and {} more", others.size() - named) : "");
    }
    console_.warn(first.path + ": " + first.warning.text + also);
  }
}

}  // namespace gridmerge::cli
