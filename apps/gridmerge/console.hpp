// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gridmerge/io/map_file.hpp"
#include "options.hpp"

namespace gridmerge::cli {

/// Prints the result. A reader that has gone away (`| head`) is not an error; anything else that keeps the
/// text from being written is: throws std::runtime_error.
void print(const std::string& text);

/// Prints "gridmerge: message" to stderr as one line, whatever the message holds.
void print_error(const std::string& message);

/// A transform or a pose as people read it, on one line.
std::string describe_pose(const SE2& T);

/// Names the files of an earlier merge or dataset (`of`) that were removed and are not there again; "" if
/// there are none.
std::string describe_removed(const std::vector<std::filesystem::path>& removed, const char* of);

/// stderr while a command runs: warnings, remarks, and a progress bar when it is a terminal.
class Console {
 public:
  explicit Console(const CommonOptions& options);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// What the user should know. Not printed when quiet.
  void warn(const std::string& message);

  /// What is good to know. Not printed when quiet.
  void tell(const std::string& message);

  /// What is going on. Printed when verbose.
  void remark(const std::string& message);

  /// Shows what is being done, how much of it is done, in [0, 1], and how long the rest takes if it goes on
  /// as it did. Gone with clear().
  void progress(const std::string& phase, double share);
  /// The same of work whose length is not known.
  void progress(const std::string& phase);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  void draw(const std::string& phase, const std::function<std::string()>& rest);

  bool quiet_;
  bool verbose_;
  bool bar_wanted_;
  bool bar_shown_ = false;
  Clock::time_point next_draw_;
  std::string phase_;
  Clock::time_point phase_began_;
};

/// For a file that is to be written when the work is done: throws FileError now if it cannot be, or if it
/// would take the place of one of the `inputs`.
void try_output_file(const std::string& path, const std::vector<std::filesystem::path>& inputs);

/// Reads the maps of a command, and tells what is odd about their files once per kind, not once per map.
class MapReader {
 public:
  /// `console` must outlive this.
  MapReader(LoadOptions options, Console& console) : options_(options), console_(console) {}

  /// load_any_map().
  LoadedMap read(const std::string& path);

  /// Whether it is an image of which neither a YAML nor an option says the resolution.
  bool lacks_resolution(const std::string& path) const;

  /// The same of a map whose scale is to be found: if its resolution is lacking, `resolution`, that of
  /// `other`, takes its place, which is reported.
  LoadedMap read(const std::string& path, double resolution, const std::string& other);

  /// The same of several, in their order. Some are read at a time, by up to `threads` threads; 0 = one per
  /// core.
  std::vector<LoadedMap> read_all(const std::vector<std::string>& paths, int threads);

  /// Tells the warnings of all maps that were read since it was called last.
  void tell_warnings();

 private:
  /// Keeps the warnings, and tells that the map was read.
  LoadedMap take(const std::string& path, LoadedMap map);

  struct Warned {
    std::string path;
    MapWarning warning;
  };

  LoadOptions options_;
  Console& console_;
  std::vector<Warned> warned_;
};

}  // namespace gridmerge::cli
