// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "fixture.hpp"

namespace gridmerge::test {

/// What who opens files by name finds in a directory.
using Files = std::map<std::string, std::string>;

inline Files files_in(const std::filesystem::path& directory) {
  Files files;
  if (!std::filesystem::exists(directory)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (std::filesystem::is_regular_file(entry.path()))
      files[entry.path().filename().string()] = read_file(entry.path());
  }
  return files;
}

/// Merges two small maps into a directory in which calls that write may fail (tests/cli/faulty_calls.cpp).
class FaultTest : public testing::Test {
 protected:
  FaultTest() {
    std::vector<std::string> with_export = merge_into("old", "0.1");
    with_export.insert(with_export.end(), {"--export", "g2o"});  // which the new set has no file for
    EXPECT_EQ(run(with_export).exit_code, 0);
    EXPECT_EQ(run(merge_into("new")).exit_code, 0);
    old_set = files_in(directory.file("old"));
    old_set["notes"] = "somebody's own";
    new_set = files_in(directory.file("new"));
  }

  std::vector<std::string> merge_into(const std::string& name, const std::string& resolution = "0.2",
                                      const std::string& threads = "1") const {
    return {"merge",
            a,
            b,
            "--init",
            poses,
            "--fix",
            a,
            "--fix",
            b,
            "-o",
            directory.file(name),
            "--output-resolution",
            resolution,
            "--threads",
            threads};
  }

  /// The old set in a directory of this name, alone.
  void write_old(const std::string& name) const {
    std::filesystem::remove_all(directory.file(name));
    for (const auto& [file, content] : old_set) directory.write(name + "/" + file, content);
  }

  RunOptions with_fault(const std::string& fault) const {
    RunOptions options;
    options.faulty = true;
    options.environment = {"GRIDMERGE_FAULT=" + fault, "GRIDMERGE_FAULT_COUNT=" + directory.file("count")};
    return options;
  }

  struct Counts {
    int calls = 0;  ///< that change what is on the disk
    int allocations = 0;
    int threads = 0;  ///< that were started
  };

  /// Of the program's last run that ended by itself.
  Counts counts() const {
    Counts counts;
    std::istringstream(read_file(directory.file("count"))) >> counts.calls >> counts.allocations >>
        counts.threads;
    return counts;
  }

  /// Without what is not the merge's own.
  static Files outputs_of(Files files) {
    files.erase("notes");
    files.erase(".gridmerge.lock");
    return files;
  }

  const TemporaryDirectory directory;
  const std::string a = write_map(directory, "a", map_part(draw_building(1), {0, 0, 5, 5}, {}));
  const std::string b = write_map(directory, "b", map_part(draw_building(1), {2, 0, 7, 5}, {}));
  const std::string poses =
      directory.write("poses.tsv", "map\tx\ty\ttheta\na.yaml\t0\t0\t0\nb.yaml\t0\t0\t0\n");
  Files old_set;
  Files new_set;
};

}  // namespace gridmerge::test
