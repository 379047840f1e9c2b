// SPDX-License-Identifier: Apache-2.0
// Files that ask for more than there is: time, memory, stack, or a reader's patience.
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <thread>

#include "fixture.hpp"
#include "io/png_builder.hpp"
#include "support/effort.hpp"

namespace gridmerge::test {
namespace {

class Bounds : public CliTest {
 protected:
  std::string yaml_of(const std::string& image, const std::string& rest = "") const {
    return directory.write("named.yaml",
                           "image: " + image +
                               "\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
                               "free_thresh: 0.196\n" +
                               rest);
  }

  std::string pipe() const {
    EXPECT_EQ(mkfifo(directory.file("pipe").c_str(), 0600), 0);
    return directory.file("pipe");
  }

  /// Of the largest program that this one has run [MB].
  static long most_memory() {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    return usage.ru_maxrss / 1024;
  }
};

TEST_F(Bounds, AnImageThatIsAPipeOrADeviceIsAnError) {
  pipe();
  expect_error(run({"info", yaml_of("pipe")}), "pipe", "not a regular file");
  expect_error(run({"info", yaml_of("/dev/zero")}), "/dev/zero", "not a regular file");
  expect_error(run({"merge", left, yaml_of("pipe"), "-o", directory.file("o")}), "pipe",
               "not a regular file");
}

TEST_F(Bounds, AMapThatATableOrAMergeNamesIsARegularFile) {
  const std::string table = directory.write("pairs.tsv", "fixed\tmoving\nleft.yaml\tpipe\n");
  pipe();
  expect_error(run({"evaluate", "--negatives", table}), "pipe", "not a regular file");
  const std::string output = directory.file("o");
  ASSERT_EQ(run({"merge", left, right, "-o", output}).exit_code, 0);
  std::filesystem::remove(right);
  std::filesystem::rename(directory.file("pipe"), right);
  expect_error(run({"report", output}), right, "not a regular file");
  std::filesystem::remove(output + "/transforms.json");
  std::filesystem::rename(right, output + "/transforms.json");
  expect_error(run({"report", output}), "transforms.json", "not a regular file");
}

TEST_F(Bounds, AnArgumentMayBeAPipe) {
  const std::string name = pipe();
  const std::string image = read_file(std::filesystem::path(left).replace_extension(".pgm"));
  std::thread writer([&] { std::ofstream(name, std::ios::binary) << image; });
  const Outcome outcome = run({"info", "--resolution", "0.1", name});
  writer.join();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(Bounds, WhatFollowsThePixelsIsNotRead) {
  const std::string image = directory.write("sparse.pgm", "P5\n4 4\n255\n" + std::string(16, '\xfe'));
  std::filesystem::resize_file(image, std::uintmax_t{1} << 36);
  EXPECT_EQ(run({"info", "--resolution", "0.1", image}).exit_code, 0);
  if (!test::kSanitized) {
    EXPECT_LT(most_memory(), 100);
  }
}

TEST_F(Bounds, MemoryIsAFewBytesACell) {
  // 67 million cells in a few kB. As colours alone they would be 200 MB.
  const PngBuilder picture{.width = 8192,
                           .height = 8192,
                           .bit_depth = 1,
                           .color = PngColor::palette,
                           .rows = std::string(8192 * 1024, '\0'),
                           .palette = "\xff\xff\xff"};
  const std::string image = directory.write("plain.png", picture.build());
  EXPECT_EQ(run({"info", "--resolution", "0.1", image}).exit_code, 0);
  if (!test::kSanitized) {
    EXPECT_LT(most_memory(), 300);
  }
}

TEST_F(Bounds, LongNamesMakeNoLongMessages) {
  const std::string name(1'000'000, 'x');
  const Outcome outcome = run({"info", yaml_of(name)});
  expect_error(outcome, "xxx", "File name too long");
  EXPECT_LT(outcome.err.size(), 1000u);
  const std::string table = directory.write("pairs.tsv", "fixed\tmoving\n" + name + "\t" + name + "\n");
  const Outcome evaluated = run({"evaluate", "--negatives", table});
  expect_error(evaluated, "xxx", "pairs.tsv:2");
  EXPECT_LT(evaluated.err.size(), 1000u);
}

TEST_F(Bounds, NestedTextNeedsNoStack) {
  RunOptions small;
  small.stack_limit = 128 << 10;
  for (const std::string& nested : {std::string(100'000, '['), "a: " + std::string(100'000, '{')})
    expect_error(run({"info", yaml_of("left.pgm", "more: " + nested + "\n")}, small), "named.yaml", "");
  std::string steps = "more:\n";
  for (int i = 1; i < 400; ++i) steps += std::string(i, ' ') + "- \n";
  expect_error(run({"info", yaml_of("left.pgm", steps)}, small), "named.yaml", "nested too deeply");
  const std::string output = directory.file("o");
  directory.write("o/transforms.json", std::string(1'000'000, '['));
  expect_error(run({"report", output}, small), "transforms.json", "JSON");
}

TEST_F(Bounds, MoreThreadsThanCoresAreNotWarnedOf) {
  const Outcome outcome = run({"match", "-q", "--threads", "1000", left, right});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Bounds, AMissingMapIsNamedWithItsTable) {
  const std::string pairs = directory.write(
      "pairs.tsv", "fixed\tmoving\tx\ty\ttheta\ttolerance\nleft.yaml\tnone.yaml\t0\t0\t0\t1\n");
  expect_error(run({"evaluate", pairs}), "none.yaml: No such file", "pairs.tsv:2 names it");
  const std::string sets = directory.write(
      "sets.tsv", "set\tmap\tx\ty\ttheta\ttolerance\na\tleft.yaml\t0\t0\t0\t1\na\tnone.yaml\t0\t0\t0\t1\n");
  expect_error(run({"evaluate", "--sets", sets}), "none.yaml: No such file", "sets.tsv:3 names it");
  std::filesystem::remove(std::filesystem::path(left).replace_extension(".pgm"));
  const std::string negatives = directory.write("negatives.tsv", "fixed\tmoving\nright.yaml\tleft.yaml\n");
  expect_error(run({"evaluate", "--negatives", negatives}), "left.pgm: No such file",
               "negatives.tsv:2 names it");
}

TEST_F(Bounds, AMergedMapThatCannotBeIsToldBeforeTheWork) {
  const std::string output = directory.file("o");
  expect_error(run({"merge", left, right, "--output-resolution", "0.0001", "-o", output}), left,
               "(--output-resolution)");
  std::string far = read_file(left);
  const std::size_t origin = far.find("origin:");
  far.replace(origin, far.find('\n', origin) - origin, "origin: [-1e9, 0, 0]");
  const std::string name = directory.write("far.yaml", far);
  expect_error(run({"merge", name, right, "-o", output}), name, "too far from zero");
  EXPECT_FALSE(std::filesystem::exists(output));
}

}  // namespace
}  // namespace gridmerge::test
