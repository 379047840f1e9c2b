// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/merge_output.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gridmerge/io/map_file.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "io/file_size_limit.hpp"
#include "io/png.hpp"
#include "io/support.hpp"
#include "merge/drawing.hpp"
#include "report/results.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;
using test::map_from;
using test::message_of;
using test::read_file;
using test::TemporaryDirectory;
using Names = std::vector<std::string>;
using Paths = std::vector<std::filesystem::path>;

const std::vector<OccupancyGrid> kMaps(4, map_from({"#..", ".##"}, 0.05));
const Names kNames{"a.yaml", "b.yaml", "c.yaml", "d.yaml"};
const Paths kInputs(kNames.begin(), kNames.end());

MergeResult one_component() {
  return test::merged(kMaps, {{{0, {}}, {1, {0.05, 0.1, 0.0}}}});
}
MergeResult two_components() {
  return test::merged(kMaps, {{{0, {}}, {1, {}}}, {{2, {}}, {3, {0.1, 0.0, 0.0}}}});
}

TEST(MergeOutput, WritesOneComponent) {
  const TemporaryDirectory directory;
  const MergeResult result = one_component();
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, result});
  EXPECT_EQ(directory.names(),
            (Names{"merged.pgm", "merged.yaml", "preview.png", "report.html", "transforms.json"}));
  const OccupancyGrid merged = load_map(directory.file("merged.yaml")).grid;
  EXPECT_EQ(merged.cells, result.components[0].fused.grid.cells);
  EXPECT_EQ(merged.origin, result.components[0].fused.grid.origin);
  EXPECT_GT(decode_png(read_file(directory.file("preview.png"))).width, 100);
  EXPECT_TRUE(contains(read_file(directory.file("report.html")), "c.yaml"));
  const auto json = nlohmann::json::parse(read_file(directory.file("transforms.json")));
  EXPECT_EQ(json["components"][0]["members"][1]["source"], "b.yaml");
}

TEST(MergeOutput, WritesEveryComponent) {
  const TemporaryDirectory directory;
  const MergeResult result = two_components();
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, result});
  EXPECT_EQ(load_map(directory.file("merged_2.yaml")).grid.cells, result.components[1].fused.grid.cells);
}

TEST(MergeOutput, WithoutAComponentThereIsNoMergedMap) {
  const TemporaryDirectory directory;
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, test::merged(kMaps, {})});
  EXPECT_EQ(directory.names(), (Names{"preview.png", "report.html", "transforms.json"}));
  const auto json = nlohmann::json::parse(read_file(directory.file("transforms.json")));
  EXPECT_TRUE(json["components"].empty());
  EXPECT_EQ(json["left_out"].size(), 4u);
}

TEST(MergeOutput, MakesTheDirectory) {
  const TemporaryDirectory directory;
  write_merge_output(directory.path() / "new" / "newer", kInputs, {kNames, kMaps, one_component()});
  EXPECT_TRUE(std::filesystem::exists(directory.path() / "new" / "newer" / "transforms.json"));
}

TEST(MergeOutput, AReportIsOfTheMergeThatIsThere) {
  const TemporaryDirectory directory;
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, one_component()});
  const MergeRecord read = read_merge_record(directory.path());
  const NamedMerge merge{kNames, kMaps, read.result};
  EXPECT_NO_THROW(write_report(directory.path(), kInputs, merge, read.fingerprint));
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, two_components()});
  const std::string report = read_file(directory.file("report.html"));
  EXPECT_EQ(message_of<FileError>([&] { write_report(directory.path(), kInputs, merge, read.fingerprint); }),
            directory.file("transforms.json") +
                ": has changed since it was read: another merge wrote there, so make the report again");
  EXPECT_EQ(read_file(directory.file("report.html")), report);
  EXPECT_NO_THROW(write_report(directory.path(), kInputs, {kNames, kMaps, two_components()}));
}

TEST(MergeOutput, RemovesTheMapsOfAnEarlierRunAndNothingElse) {
  const TemporaryDirectory directory;
  const Names others{"merged_x.yaml",       "merged.yaml.old", "merged_.pgm",  "merged.txt",
                     "my_merged.yaml",      "notes",           "merged_1.pgm", "merged_02.pgm",
                     "merged_20240512.pgm", "merged_3.yaml",   "merged_3.pgm", "merged_2.tif",
                     "merged.tif",          "open_rmf.yaml",   "merged.g2o"};
  for (const std::string& name : others) directory.write(name, "mine");
  directory.write("merged_18.yaml/notes", "mine");
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, two_components()});
  EXPECT_EQ(write_merge_output(directory.path(), kInputs, {kNames, kMaps, one_component()}),
            (Paths{directory.file("merged_2.yaml"), directory.file("merged_2.pgm")}));
  EXPECT_FALSE(std::filesystem::exists(directory.file("merged_2.yaml")));
  EXPECT_FALSE(std::filesystem::exists(directory.file("merged_2.pgm")));
  EXPECT_TRUE(std::filesystem::exists(directory.file("merged.yaml")));
  EXPECT_EQ(write_merge_output(directory.path(), kInputs, {kNames, kMaps, test::merged(kMaps, {})}),
            (Paths{directory.file("merged.yaml"), directory.file("merged.pgm")}));
  EXPECT_FALSE(std::filesystem::exists(directory.file("merged.yaml")));
  EXPECT_FALSE(std::filesystem::exists(directory.file("merged.pgm")));
  EXPECT_EQ(read_file(directory.file("merged_18.yaml/notes")), "mine");
  for (const std::string& name : others) EXPECT_EQ(read_file(directory.file(name)), "mine") << name;
}

TEST(MergeOutput, RemovesNothingWhereNothingWasMerged) {
  for (const std::string transforms :
       {"", "{\"frames\": []}", "no JSON", "[]",
        "{\"components\": [{\"map\": \"../x\"}], \"joins\": [], \"left_out\": []}"}) {
    const TemporaryDirectory directory;
    const Names mine{"merged_2.pgm", "merged_2.yaml", "merged.tif"};
    for (const std::string& name : mine) directory.write(name, "mine");
    if (!transforms.empty()) directory.write("transforms.json", transforms);
    EXPECT_EQ(write_merge_output(directory.path(), kInputs, {kNames, kMaps, one_component()}), Paths{});
    for (const std::string& name : mine) EXPECT_EQ(read_file(directory.file(name)), "mine") << name;
  }
}

TEST(MergeOutput, RemovesTheExportsOfAnEarlierMerge) {
  const TemporaryDirectory directory;
  const MergeResult result = two_components();
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, result});
  Paths exports;
  for (const ExportFormat format : export_formats()) {
    const Paths files =
        write_export(format, directory.file(export_file(format)), kInputs, {kNames, kMaps, result});
    exports.insert(exports.end(), files.begin(), files.end());
  }
  ASSERT_EQ(exports.size(), 5u);
  EXPECT_EQ(write_merge_output(directory.path(), kInputs, {kNames, kMaps, result}), exports);
  for (const std::filesystem::path& file : exports) EXPECT_FALSE(std::filesystem::exists(file)) << file;
}

TEST(MergeOutput, NeverReplacesAnInput) {
  const TemporaryDirectory directory;
  for (const std::string name :
       {"merged.yaml", "merged_3.yaml", "merged.pgm", "preview.png", "open_rmf.yaml"}) {
    const std::string input = directory.write(name, "mine");
    const auto write = [&] {
      write_merge_output(directory.path(), {"a", "b", input}, {kNames, kMaps, one_component()});
    };
    EXPECT_TRUE(contains(message_of<FileError>(write), name + ": is an input"));
    EXPECT_EQ(directory.names(), Names{name});
    EXPECT_EQ(read_file(input), "mine");
    std::filesystem::remove(input);
  }
}

TEST(MergeOutput, NeverReplacesAnInputByAnotherName) {
  const TemporaryDirectory directory;
  directory.write("merged.yaml", "mine");
  std::filesystem::create_symlink("merged.yaml", directory.file("link.yaml"));
  const std::string indirect = (directory.path() / "." / "link.yaml").string();
  EXPECT_THROW(prepare_merge_output(directory.path(), {"elsewhere.yaml", indirect}), FileError);
  directory.write("other/merged.yaml", "mine");
  EXPECT_NO_THROW(prepare_merge_output(directory.path(), {directory.file("other/merged.yaml")}));
}

TEST(MergeOutput, NeverReplacesTheImageOfAnInput) {
  const TemporaryDirectory directory;
  for (const std::string name : {"merged.pgm", "merged_2.pgm", "preview.png"}) {
    save_map(kMaps[0], directory.file("floor.yaml"));
    const std::string yaml = read_file(directory.file("floor.yaml"));
    directory.write("floor.yaml", "image: " + name + yaml.substr(yaml.find('\n')));
    std::filesystem::rename(directory.file("floor.pgm"), directory.file(name));
    const Paths inputs = load_map(directory.file("floor.yaml")).files;
    const auto prepare = [&] { prepare_merge_output(directory.path(), inputs); };
    EXPECT_TRUE(contains(message_of<FileError>(prepare), name + ": is an input"));
    std::filesystem::remove(directory.file(name));
  }
}

TEST(MergeOutput, PreparingMakesNothingToStay) {
  const TemporaryDirectory directory;
  prepare_merge_output(directory.path() / "new" / "newer", {});
  EXPECT_EQ(directory.names(), Names{});
  directory.write("old/file", "mine");
  std::filesystem::create_directory(directory.path() / "empty");
  prepare_merge_output(directory.path() / "old" / "new" / "", {});
  prepare_merge_output(directory.path() / "empty", {});
  EXPECT_EQ(directory.names(), (Names{"empty", "old"}));
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "old" / "new"));
  EXPECT_EQ(read_file(directory.file("old/file")), "mine");
}

TEST(MergeOutput, SaysWhatIsNoDirectory) {
  const TemporaryDirectory directory;
  const std::string file = directory.write("file", "mine");
  EXPECT_TRUE(contains(message_of<FileError>([&] { prepare_merge_output(file, {}); }), file));
  EXPECT_TRUE(contains(message_of<FileError>([&] { prepare_merge_output(file + "/under", {}); }), file));
  EXPECT_EQ(read_file(file), "mine");
  std::filesystem::create_directories(directory.path() / "out" / "report.html");
  EXPECT_TRUE(contains(message_of<FileError>([&] { prepare_merge_output(directory.file("out"), {}); }),
                       "report.html: cannot be written: it names a directory"));
}

TEST(MergeOutput, SaysWhereItMayNotWrite) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const TemporaryDirectory directory;
  std::filesystem::permissions(directory.path(),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_TRUE(contains(message_of<FileError>([&] { prepare_merge_output(directory.path(), {}); }),
                       "cannot be written to"));
}

TEST(MergeOutput, ForeseesTheSizeOfTheMergedMap) {
  EXPECT_FALSE(check_merged_size(kNames, kMaps, 0.0));
  EXPECT_FALSE(check_merged_size({}, {}, 0.0));
  EXPECT_THROW(check_merged_size({}, kMaps, 0.0), std::out_of_range);
  for (const double none : {std::nan(""), -1.0, 1e-300, 1e-7, 1001.0})
    EXPECT_THROW(check_merged_size(kNames, kMaps, none), std::invalid_argument) << none;
  // 150 million cells each.
  const std::optional<double> coarser = check_merged_size(kNames, kMaps, 1e-5);
  ASSERT_TRUE(coarser);
  EXPECT_NEAR(*coarser, 2.2e-5, 1e-9);
  EXPECT_FALSE(check_merged_size(kNames, kMaps, *coarser));
  EXPECT_TRUE(contains(message_of<FileError>([] { check_merged_size(kNames, kMaps, 5e-6); }),
                       "a.yaml: alone has 6e+08 cells"));
  std::vector<OccupancyGrid> far = kMaps;
  far[2].origin.y = 1e9 - 0.1;
  EXPECT_TRUE(
      contains(message_of<FileError>([&] { check_merged_size(kNames, far, 0.0); }), "c.yaml: lies too far"));
  far[2].origin.y = 1e9 - 10.0;
  EXPECT_FALSE(check_merged_size(kNames, far, 0.0));
}

TEST(MergeOutput, MapsMayReachAsFarAsOriginsMay) {
  // Diagonals of 5 m and of 13 m: so far they may reach.
  std::vector<OccupancyGrid> maps{make_grid(3, 4, 1.0), make_grid(10, 24, 0.5)};
  const Names names{"a", "b"};
  for (const double sign : {-1.0, 1.0}) {
    for (double SE2::*const axis : {&SE2::x, &SE2::y}) {
      for (OccupancyGrid& map : maps) {
        map.origin.*axis = sign * (1e9 - 18.0);
        EXPECT_FALSE(check_merged_size(names, maps, 0.0));
        map.origin.*axis = sign * (1e9 - 17.75);
        EXPECT_EQ(message_of<FileError>([&] { check_merged_size(names, maps, 0.0); }),
                  std::string(&map == &maps[0] ? "a" : "b") +
                      ": lies too far from zero: with the other maps it may reach beyond 1000000000 m");
        map.origin = {};
      }
    }
  }
}

TEST(MergeOutput, AMergedMapMayHaveTwoToThe28Cells) {
  // 2^8 cells, each of which is 2^20 smaller ones.
  std::vector<OccupancyGrid> maps{make_grid(16, 16, 512.0, {}, Cell::free)};
  const Names names{"a", "b"};
  EXPECT_FALSE(check_merged_size(names, maps, 0.5));
  EXPECT_EQ(message_of<FileError>([&] { check_merged_size(names, maps, 0.375); }),
            "a: alone has 4.77e+08 cells of 0.375 m, and a merged map may have 2^28: choose an output "
            "resolution of 0.71 m (--output-resolution)");
  // Two have twice as many: cells of twice the side have room to spare.
  maps.push_back(maps[0]);
  EXPECT_DOUBLE_EQ(check_merged_size(names, maps, 0.5).value_or(0.0), 1.0);
  EXPECT_FALSE(check_merged_size(names, maps, 1.0));
  maps[1] = make_grid(1, 1, 0.5, {}, Cell::free);
  EXPECT_DOUBLE_EQ(check_merged_size(names, maps, 0.5).value_or(0.0), 0.71);
}

TEST(MergeOutput, OfATooLargeMapWhatIsKnownCounts) {
  const Names names{"a"};
  std::vector<OccupancyGrid> maps{make_grid(17, 16, 512.0)};
  EXPECT_TRUE(contains(message_of<FileError>([&] { check_merged_size(names, maps, 0.5); }),
                       "a: alone has 2.85e+08 cells"));  // nothing is known
  maps[0].at(0, 0) = maps[0].at(15, 15) = Cell::free;
  EXPECT_FALSE(check_merged_size(names, maps, 0.5));
  maps[0].at(16, 15) = Cell::free;
  EXPECT_TRUE(contains(message_of<FileError>([&] { check_merged_size(names, maps, 0.5); }),
                       "a: alone has 2.85e+08 cells"));
}

TEST(MergeOutput, AFullDiskLeavesTheDirectoryAsItWas) {
  const TemporaryDirectory directory;
  write_merge_output(directory.path(), kInputs, {kNames, kMaps, two_components()});
  const Names names = directory.names();
  Names before;
  for (const std::string& name : names) before.push_back(read_file(directory.file(name)));
  // Enough for the map's files, not for the picture.
  const std::string message = test::with_file_size_limit(400, [&] {
    write_merge_output(directory.path(), kInputs, {kNames, kMaps, one_component()});
  });
  EXPECT_TRUE(contains(message, "preview.png: cannot be written"));
  EXPECT_EQ(directory.names(), names);
  for (std::size_t i = 0; i < names.size(); ++i)
    EXPECT_EQ(read_file(directory.file(names[i])), before[i]) << names[i];

  const auto write_to_new = [&] {
    write_merge_output(directory.path() / "new" / "newer", kInputs, {kNames, kMaps, one_component()});
  };
  EXPECT_TRUE(contains(test::with_file_size_limit(400, write_to_new), "cannot be written"));
  EXPECT_EQ(directory.names(), names) << "no empty directory is left behind";
}

}  // namespace
}  // namespace gridmerge
