// SPDX-License-Identifier: Apache-2.0
// Maps by name, of files and of bags.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "bag/support.hpp"
#include "gridmerge/bag/bag.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using test::cells_of;
using test::contains;
using test::mcap_file;
using test::row_at;
using Paths = std::vector<std::filesystem::path>;

class AnyMap : public testing::Test {
 protected:
  std::string error_of(const std::string& name, const LoadOptions& options = {}) {
    return test::message_of<FileError>([&] { load_any_map(name, options); });
  }

  std::string write_folder(const std::string& name, const std::string& files) {
    directory_.write(name + "/metadata.yaml",
                     "rosbag2_bagfile_information: {relative_file_paths: [" + files + "]}\n");
    return directory_.file(name);
  }

  const test::TemporaryDirectory directory_;
};

TEST_F(AnyMap, NamesAreTakenApartAtTheTopic) {
  const auto parts = [](const std::string& name) {
    const MapName parsed = parse_map_name(name);
    return parsed.file.string() + "|" + parsed.topic;
  };
  EXPECT_EQ(parts("a.mcap"), "a.mcap|");
  EXPECT_EQ(parts("a.mcap#/tb1/map"), "a.mcap|/tb1/map");
  EXPECT_EQ(parts("no#such.yaml"), "no#such.yaml|") << "a name as people give files";
  EXPECT_EQ(parts("#/map"), "#/map|");
  EXPECT_EQ(parts("a.mcap#"), "a.mcap#|");
  const std::string bag = directory_.write("floor #1.mcap", "");
  EXPECT_EQ(parts(bag), bag + "|") << "a file that is there";
  EXPECT_EQ(parts(bag + "#/map"), bag + "|/map");
  EXPECT_EQ(parts(bag + "#map"), bag + "|map");
  EXPECT_EQ(parts(bag + "#m"), bag + "|m");
  EXPECT_EQ(parts(bag + "#"), bag + "#|") << "no topic";
  EXPECT_EQ(format_map_name(parse_map_name(bag + "#/map")), bag + "#/map");
  EXPECT_EQ(format_map_name({bag, ""}), bag);
}

TEST_F(AnyMap, AnEmptyNameIsCalledSo) {
  EXPECT_EQ(test::message_of<FileError>([] { load_any_map(""); }), "'': is no name of a map: it is empty");
}

TEST_F(AnyMap, TwoWaysToNameAMapAreOneMap) {
  const std::string bag = directory_.write("a.mcap", mcap_file({row_at(1, {0, 100})}));
  const std::string other_way = (directory_.path() / "." / "a.mcap").string();
  EXPECT_TRUE(is_same_map(bag, other_way));
  EXPECT_TRUE(is_same_map(bag + "#/map", other_way + "#map"));
  EXPECT_FALSE(is_same_map(bag + "#/tb1/map", bag + "#/tb2/map"));
  EXPECT_FALSE(is_same_map(bag + "#/map", directory_.file("none") + "#/map"));
  std::filesystem::create_hard_link(bag, directory_.file("b.mcap"));
  std::filesystem::create_symlink(bag, directory_.file("c.mcap"));
  std::filesystem::copy_file(bag, directory_.file("d.mcap"));
  EXPECT_EQ(map_identity(directory_.file("b.mcap") + "#/map"), map_identity(bag + "#map"));
  EXPECT_EQ(map_identity(directory_.file("c.mcap")), map_identity(other_way));
  EXPECT_NE(map_identity(directory_.file("d.mcap")), map_identity(bag));
  EXPECT_NE(map_identity(bag + "#/map"), map_identity(bag));
  EXPECT_FALSE(map_identity(directory_.file("none")));
}

TEST_F(AnyMap, FilesAreReadAsTheyAre) {
  directory_.write("a.pgm", std::string("P5\n2 1\n255\n\0\xfe", 13));
  const std::string yaml =
      directory_.write("a.yaml",
                       "image: a.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: "
                       "0.65\nfree_thresh: 0.196\n");
  EXPECT_EQ(load_any_map(yaml).grid.cells, (std::vector<Cell>{Cell::occupied, Cell::free}));
  EXPECT_EQ(any_map_files(yaml), (Paths{yaml, directory_.file("a.pgm")}));
  EXPECT_TRUE(contains(error_of(yaml + "#/map"), yaml + ": is no bag, and so has no topic '/map'"));
}

TEST_F(AnyMap, BagsAreToldByContentNotByName) {
  const std::string path = directory_.write("a.yaml", mcap_file({row_at(1, {0, 100})}));
  const LoadedMap map = load_any_map(path);
  EXPECT_EQ(map.grid.cells, cells_of({0, 100}));
  EXPECT_EQ(map.files, (Paths{path}));
  EXPECT_TRUE(is_bag(path));
  EXPECT_FALSE(is_bag(directory_.write("b.mcap", "image: a.pgm")));
  EXPECT_FALSE(is_bag(directory_.file("nothing")));
}

TEST_F(AnyMap, AFolderHasAllItsFiles) {
  const std::string folder = write_folder("run", "old/run_0.mcap, run_1.db3");
  directory_.write("run/run_0.mcap", mcap_file({row_at(2, {0, 100}), row_at(9, {100, 0})}));
  test::write_db3(directory_.file("run/run_1.db3"), {row_at(5, {100, 100})});
  const LoadedMap map = load_any_map(folder);
  EXPECT_EQ(map.grid.cells, cells_of({100, 0})) << "the last by time, not by file";
  const Paths files{folder + "/metadata.yaml", folder + "/run_0.mcap", folder + "/run_1.db3"};
  EXPECT_EQ(map.files, files);
  EXPECT_EQ(any_map_files(folder + "#/map"), files);
  const Bag bag(folder);
  EXPECT_EQ(bag.topics().at(0).messages, 3u);
  std::vector<std::int64_t> times;
  BagMaps maps(bag);
  while (const auto one = maps.next()) times.push_back(one->time);
  EXPECT_EQ(times, (std::vector<std::int64_t>{2, 5, 9}));
}

TEST_F(AnyMap, AFolderWithoutItsFilesSaysWhich) {
  const std::string folder = write_folder("run", "run_0.mcap");
  EXPECT_EQ(error_of(folder), folder + "/run_0.mcap: No such file or directory");
  std::filesystem::create_directory(directory_.file("plain"));
  EXPECT_TRUE(contains(error_of(directory_.file("plain")), "a directory without a metadata.yaml"));
  directory_.write("bad/metadata.yaml", "a: [");
  EXPECT_TRUE(contains(error_of(directory_.file("bad")), "metadata.yaml: not valid YAML"));
}

TEST_F(AnyMap, WhatIsNoBagSaysSo) {
  EXPECT_TRUE(contains(error_of(directory_.file("no.mcap#/map")), "no.mcap: No such file or directory"));
  EXPECT_TRUE(
      contains(error_of(directory_.write("a.bag", "#ROSBAG V2.0\n")), "pip install 'gridmerge[rosbags]'"));
  EXPECT_TRUE(contains(error_of(directory_.write("a.zstd", test::pack_zstd("hello"))), "is no bag of ROS 2"));
  EXPECT_TRUE(contains(error_of(directory_.write("a.mcap", "\x89MCAP1\r\n")), "a.mcap"));
  const std::string pipe = directory_.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_FALSE(is_bag(pipe)) << "a pipe gives its bytes once";
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { Bag{pipe}; }), "is not a regular file"));
}

TEST_F(AnyMap, ABagInPlaceOfAMapFileIsNamed) {
  const std::string path = directory_.write("a.mcap", mcap_file({row_at(1, {0})}));
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { load_map(path); }), "a ROS bag"));
}

}  // namespace
}  // namespace gridmerge
