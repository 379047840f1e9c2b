// SPDX-License-Identifier: Apache-2.0
#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class Streams : public CliTest {};

TEST_F(Streams, AReaderThatLeavesIsNotAnError) {
  RunOptions options;
  options.break_stdout = true;
  const Outcome outcome = run({"info", left, right}, options);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Streams, AFullDeviceIs) {
  RunOptions options;
  options.stdout_to = "/dev/full";
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"info", left}, {"info", left, "--json"}, {"--help"}, {"--version"}}) {
    expect_error(run(arguments, options), "standard output", "No space left");
  }
}

TEST_F(Streams, SoIsAStdoutThatIsClosed) {
  RunOptions options;
  options.close_stdout = true;
  expect_error(run({"info", left}, options), "standard output", "Bad file descriptor");
}

TEST_F(Streams, AClosedStdoutDoesNotEndUpInAFile) {
  const std::string negatives = directory.write("negatives.tsv", "fixed\tmoving\nleft.yaml\tother.yaml\n");
  const std::string before = read_file(left);
  RunOptions options;
  options.close_stdout = true;
  run({"evaluate", "--negatives", negatives, "--json", directory.file("result.json")}, options);
  EXPECT_EQ(read_file(left), before);
  EXPECT_FALSE(std::filesystem::exists(directory.file("result.json"))) << "written after stdout failed";
}

TEST_F(Streams, AMessageThatCannotBePrintedEndsNoWork) {
  std::string yaml = read_file(left);
  const std::size_t at = yaml.find("free_thresh:");
  yaml.replace(at, yaml.find('\n', at) - at, "free_thresh: 0.25");
  const std::string warned =
      directory.write("warned.yaml", "image: left.pgm\n" + yaml.substr(yaml.find('\n') + 1));
  RunOptions closed, full;
  closed.close_stderr = true;
  full.stderr_to = "/dev/full";
  for (const RunOptions& options : {closed, full}) {
    EXPECT_EQ(run({"info", directory.file("nope.yaml")}, options).exit_code, 1);
    EXPECT_EQ(run({"frobnicate"}, options).exit_code, 2);
    const std::string output = directory.file("out");
    EXPECT_EQ(run({"merge", warned, right, "-o", output}, options).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(output + "/merged.yaml"));
    std::filesystem::remove_all(output);
  }
  RunOptions neither = closed;
  neither.close_stdout = true;
  EXPECT_EQ(run({"info", left}, neither).exit_code, 1);
}

TEST_F(Streams, AMessageIsOneLineWhateverTheFileIsCalled) {
  expect_error(run({"info", directory.file("two\nlines\x1b[31m")}), "two\\nlines\\x1b[31m", "No such file");
}

TEST_F(Streams, TheProgressBarIsForTerminalsAndGoesAway) {
  std::string table = "fixed\tmoving\n";
  for (int i = 0; i < 12; ++i) table += "left.yaml\tother.yaml\n";
  const std::string negatives = directory.write("negatives.tsv", table);
  const std::vector<std::string> arguments = {"evaluate", "--negatives", negatives, "--threads", "1"};
  RunOptions terminal;
  terminal.stderr_is_terminal = true;

  const Outcome shown = run(arguments, terminal);
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_NE(shown.err.find("\revaluating ["), std::string::npos) << "no bar in a run of " << shown.out;
  EXPECT_NE(shown.err.find("%, "), std::string::npos) << shown.err;
  EXPECT_NE(shown.err.find(" left"), std::string::npos) << shown.err;
  EXPECT_EQ(shown.err.find(" h left"), std::string::npos) << "from when on does it count?" << shown.err;
  const std::string erase = "\r\x1b[K";
  ASSERT_GE(shown.err.size(), erase.size());
  EXPECT_EQ(shown.err.substr(shown.err.size() - erase.size()), erase);
  EXPECT_EQ(shown.out.find('\r'), std::string::npos);

  EXPECT_EQ(run(arguments).err, "");
  std::vector<std::string> quiet = arguments;
  quiet.push_back("--quiet");
  EXPECT_EQ(run(quiet, terminal).err, "");
}

}  // namespace
}  // namespace gridmerge::test
