// SPDX-License-Identifier: Apache-2.0
// The tutorials: every command of a `console` block, as it stands there, says what stands below it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "support/temporary_directory.hpp"

namespace gridmerge::test {
namespace {

/// A line of a shell, and what it says: "..." stands for anything.
struct Step {
  std::string command;
  std::string said;
};

std::vector<Step> steps_of(const std::filesystem::path& page) {
  std::vector<Step> steps;
  std::ifstream file(page);
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("```", 0) == 0)
      inside = line == "```console";
    else if (inside && line.rfind("$ ", 0) == 0)
      steps.push_back({line.substr(2), ""});
    else if (inside && line.rfind("> ", 0) == 0)
      steps.back().command += "\n" + line.substr(2);
    else if (inside && !steps.empty())
      steps.back().said += line + "\n";
  }
  return steps;
}

bool is_said(std::string_view pattern, std::string_view text) {
  const std::size_t gap = pattern.find("...");
  if (gap == std::string_view::npos) return pattern == text;
  if (text.substr(0, gap) != pattern.substr(0, gap)) return false;
  const std::string_view rest = pattern.substr(gap + 3);
  for (std::size_t skipped = gap; skipped <= text.size(); ++skipped)
    if (is_said(rest, text.substr(skipped))) return true;
  return false;
}

/// Runs the line where the example's maps are. `status` is $? before it, and after it.
std::string run_in_shell(const std::string& folder, const std::string& command, int& status) {
  const std::string script =
      "exec 2>&1; cd '" + folder + "' || exit; (exit " + std::to_string(status) + ")\n" + command;
  std::FILE* const pipe = ::popen(script.c_str(), "r");
  if (pipe == nullptr) return "no shell";
  std::string said;
  char buffer[4096];
  for (std::size_t size; (size = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) said.append(buffer, size);
  const int ended = ::pclose(pipe);
  status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  return said;
}

TEST(Tutorials, EveryCommandSaysWhatStandsBelowIt) {
  const std::filesystem::path program = GRIDMERGE_PROGRAM;
  const std::string path = program.parent_path().string() + ":" + std::getenv("PATH");
  ASSERT_EQ(::setenv("PATH", path.c_str(), 1), 0);
  std::size_t commands = 0;
  for (const std::string page : {"three_maps.md", "paper.md"}) {
    const TemporaryDirectory directory;
    std::filesystem::copy(GRIDMERGE_EXAMPLE, directory.path() / "floor");
    int status = 0;
    for (const Step& step : steps_of(std::filesystem::path(GRIDMERGE_TUTORIALS) / page)) {
      const std::string said = run_in_shell((directory.path() / "floor").string(), step.command, status);
      EXPECT_TRUE(is_said(step.said, said)) << page << ": $ " << step.command << "\nsays\n"
                                            << said << "and is to say\n"
                                            << step.said;
      ++commands;
    }
  }
  EXPECT_GE(commands, 15u);
}

}  // namespace
}  // namespace gridmerge::test
