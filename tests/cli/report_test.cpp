// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <filesystem>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class Report : public CliTest {
 protected:
  std::string merge(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words{"merge", "-o", output};
    words.insert(words.end(), arguments.begin(), arguments.end());
    EXPECT_NE(run(words).exit_code, 1);
    return read_file(output + "/report.html");
  }

  /// The bytes of the report that `gridmerge report` makes once the merge's own is gone.
  std::string made_again(const std::vector<std::string>& more = {}) const {
    std::filesystem::remove(output + "/report.html");
    std::vector<std::string> words{"report", output};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, output + "/report.html\n");
    EXPECT_EQ(outcome.err, "");
    return read_file(output + "/report.html");
  }

  void expect_the_same(const std::vector<std::string>& merge_arguments,
                       const std::vector<std::string>& report_arguments = {}) const {
    const std::string merged = merge(merge_arguments);
    EXPECT_FALSE(merged.empty());
    EXPECT_TRUE(merged == made_again(report_arguments)) << "after " << merge_arguments.back();
  }

  const std::string output = directory.file("out");
};

TEST_F(Report, IsWhatTheMergeWrote) {
  expect_the_same({left, other, right});
  expect_the_same({left, other});
  expect_the_same({left, right, "--output-resolution", "0.17"});
  expect_the_same({left, other, right, "--strategy", "tree"});
  expect_the_same({left, right}, {"--threads", "1"});
}

TEST_F(Report, IsWhatTheMergeWroteInTheWorldsFrame) {
  const std::string poses = directory.write("poses.tsv", "map\tx\ty\ttheta\nright.yaml\t1e5\t-5e4\t1.5\n");
  expect_the_same({left, right, "--fix", right, "--init", poses});
}

TEST_F(Report, OfMapsWithNamesOfAnyBytes) {
  // Two that differ in bytes that are of no character alone.
  const std::string a =
      write_map(directory, "caf\xe9/robot", map_part(draw_building(1), {0, 0, 13, 13}, T_left_building));
  const std::string b =
      write_map(directory, "caf\xe8/robot", map_part(draw_building(1), {5, 0, 18, 13}, T_right_building));
  expect_the_same({a, b});
  expect_the_same({b, a});
}

TEST_F(Report, NamesItsFileOnOneLine) {
  const std::string odd = directory.file("a\n\x1b[31mb");
  ASSERT_EQ(run({"merge", left, right, "-o", odd}).exit_code, 0);
  EXPECT_EQ(run({"report", odd}).out, directory.file("a\\n\\x1b[31mb") + "/report.html\n");
}

TEST_F(Report, OfBareImages) {
  const std::vector<std::string> images{directory.file("left.pgm"), directory.file("right.pgm")};
  expect_the_same({images[0], images[1], "--resolution", "0.1"}, {"--resolution", "0.1"});
  expect_error(run({"report", output}), images[0], "resolution");
}

TEST_F(Report, SeeksMapsFromTheRoot) {
  merge({left, right});
  Json json = Json::parse(read_file(output + "/transforms.json"));
  std::string text = json.dump();
  for (const std::string& name : {left, right}) {
    for (auto at = text.find(name); at != std::string::npos; at = text.find(name))
      text.replace(at, name.size(), std::filesystem::path(name).filename());
  }
  directory.write("out/transforms.json", text);
  expect_error(run({"report", output}), "left.yaml", "--root");
  const std::string again = made_again({"--root", directory.path()});
  EXPECT_NE(again.find("\"name\":\"left.yaml\""), std::string::npos);
}

TEST_F(Report, AMapThatIsGoneIsNamed) {
  merge({left, right});
  std::filesystem::remove(right);
  const std::string before = read_file(output + "/report.html");
  expect_error(run({"report", output}), right, "--root");
  EXPECT_EQ(read_file(output + "/report.html"), before);
}

TEST_F(Report, WarnsOfMapsThatHaveChanged) {
  merge({left, right});
  std::filesystem::copy_file(directory.file("other.pgm"), directory.file("left.pgm"),
                             std::filesystem::copy_options::overwrite_existing);
  const Outcome outcome = run({"report", output});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("merged.yaml: is not what the maps give"), std::string::npos) << outcome.err;
}

TEST_F(Report, SaysWhatIsNoMergesOutput) {
  expect_error(run({"report", directory.path()}), directory.path(), "no transforms.json");
  expect_error(run({"report", directory.file("nowhere")}), "nowhere", "no transforms.json");
  directory.write("out/transforms.json", "{\"components\": []}");
  expect_error(run({"report", output}), "transforms.json", "maps is missing");
  directory.write("out/transforms.json",
                  "\x7f"
                  "ELF");
  expect_error(run({"report", output}), "transforms.json", "no JSON");
  merge({left, right});
  std::filesystem::remove(output + "/merged.yaml");
  expect_error(run({"report", output}), "merged.yaml", "No such file");
}

TEST_F(Report, NeverReplacesAnInput) {
  merge({left, right});
  // A map by the report's name.
  std::filesystem::remove(output + "/report.html");
  std::filesystem::copy_file(directory.file("left.pgm"), output + "/report.html");
  directory.write(
      "left.yaml",
      "image: out/report.html\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
      "free_thresh: 0.196\n");
  const Outcome outcome = run({"report", output, "--quiet"});
  expect_error(outcome, "report.html", "is an input");
  EXPECT_EQ(read_file(output + "/report.html"), read_file(directory.file("left.pgm")));
}

}  // namespace
}  // namespace gridmerge::test
