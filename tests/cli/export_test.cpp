// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class Export : public CliTest {
 protected:
  Outcome merge(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"merge", left, right, "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  const std::string output = directory.file("out");
};

TEST_F(Export, OfAnEarlierMergeIsRemoved) {
  ASSERT_EQ(merge({"--export", "g2o", "--export", "geojson", "--export", "geotiff"}).exit_code, 0);
  ASSERT_TRUE(std::filesystem::exists(output + "/merged.g2o"));
  ASSERT_TRUE(std::filesystem::exists(output + "/merged.tif"));
  std::ofstream(output + "/merged_2.tif") << "mine";
  std::ofstream(output + "/merged_x.tif") << "mine";
  std::ofstream(output + "/open_rmf.yaml") << "mine";
  const Outcome outcome = merge({"--export", "geojson"});
  ASSERT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("removed: merged.g2o, merged.tif (of an earlier merge)\n"), std::string::npos)
      << outcome.out;
  EXPECT_FALSE(std::filesystem::exists(output + "/merged.g2o")) << "it tells of another merge";
  EXPECT_FALSE(std::filesystem::exists(output + "/merged.tif"));
  EXPECT_TRUE(std::filesystem::exists(output + "/merged_2.tif"));
  EXPECT_EQ(read_file(output + "/open_rmf.yaml"), "mine");
  EXPECT_TRUE(std::filesystem::exists(output + "/merged_x.tif"));
  EXPECT_TRUE(std::filesystem::exists(output + "/merged.geojson"));
  // What lies in a folder into which nothing was merged yet is none of an earlier merge.
  const std::string fresh = directory.file("fresh");
  std::filesystem::create_directory(fresh);
  std::ofstream(fresh + "/merged.g2o") << "mine";
  const Outcome first = run({"merge", left, right, "-o", fresh});
  ASSERT_EQ(first.exit_code, 0);
  EXPECT_EQ(first.out.find("removed"), std::string::npos) << first.out;
  EXPECT_EQ(read_file(fresh + "/merged.g2o"), "mine");
}

TEST_F(Export, OfFurtherMergedMapsIsRemovedWithAnyName) {
  // A copy lies on its original, so that there are two merged maps.
  const std::string copy = directory.file("copy.yaml"), site = directory.file("site.tif");
  std::filesystem::copy_file(other, copy);
  ASSERT_EQ(merge({other, copy, "--export", "geotiff", "--export", "geotiff=" + site}).exit_code, 3);
  for (const char* name : {"site_2.tif", "out/merged_2.tif", "out/merged_2.yaml"})
    ASSERT_TRUE(std::filesystem::exists(directory.file(name))) << name;
  const Outcome outcome = merge({"--export", "geotiff=" + site});
  ASSERT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("geotiff: " + site + "\nremoved: site_2.tif (of an earlier merge)\n"),
            std::string::npos)
      << outcome.out;
  for (const char* name : {"site_2.tif", "out/merged_2.tif", "out/merged_2.yaml", "out/merged.tif"})
    EXPECT_FALSE(std::filesystem::exists(directory.file(name))) << name;
}

TEST_F(Export, AMergeOfNothingNamesWhatItRemoves) {
  ASSERT_EQ(merge({"--export", "g2o"}).exit_code, 0);
  const Outcome outcome = run({"merge", left, other, "-o", output});
  ASSERT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("removed: merged.yaml, merged.pgm, merged.g2o (of an earlier merge)\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_FALSE(std::filesystem::exists(output + "/merged.yaml"));
}

TEST_F(Export, IsWrittenBesideTheResultOrWhereItIsTold) {
  const std::string elsewhere = directory.file("fleet.yaml");
  const Outcome outcome =
      merge({"--export", "g2o", "--export=open-rmf=" + elsewhere, "--export", "geojson", other});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_NE(outcome.out.find(output + "/merged.g2o\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(elsewhere + "\n"), std::string::npos) << outcome.out;
  const std::string g2o = read_file(output + "/merged.g2o");
  EXPECT_NE(g2o.find("VERTEX_SE2 0 0 0 0\n"), std::string::npos) << g2o;
  EXPECT_NE(g2o.find("\nFIX 0\n"), std::string::npos) << g2o;
  EXPECT_NE(g2o.find("\nEDGE_SE2 0 1 "), std::string::npos) << g2o;
  EXPECT_EQ(g2o.find("no deviation"), std::string::npos) << "a match has one";
  EXPECT_NE(read_file(elsewhere).find(
                "    reference_image:\n      reference_coordinates:\n        merged:\n          rmf: [["),
            std::string::npos);
  const Json geojson = Json::parse(read_file(output + "/merged.geojson"));
  EXPECT_EQ(geojson["features"].size(), 3u);
  EXPECT_FALSE(std::filesystem::exists(output + "/open_rmf.yaml"));
}

TEST_F(Export, OfASavedMergeIsTheSame) {
  ASSERT_EQ(merge({"--export", "g2o", "--export", "open-rmf", "--export", "geojson", "--export", "geotiff"})
                .exit_code,
            0);
  const Outcome outcome =
      run({"report", output, "--export", "g2o=" + directory.file("g"), "--export",
           "open-rmf=" + directory.file("o"), "--export", "geojson=" + directory.file("j"), "--export",
           "geotiff=" + directory.file("t")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_file(directory.file("g")), read_file(output + "/merged.g2o"));
  EXPECT_EQ(read_file(directory.file("o")), read_file(output + "/open_rmf.yaml"));
  EXPECT_EQ(read_file(directory.file("j")), read_file(output + "/merged.geojson"));
  EXPECT_TRUE(read_file(directory.file("t")) == read_file(output + "/merged.tif"));
}

TEST_F(Export, FollowsALinkToItsFolder) {
  std::filesystem::create_directory(directory.file("there"));
  std::filesystem::create_symlink("there/m.tif", directory.file("link.tif"));
  std::ofstream(directory.file("there/m.tif")) << "old";
  ASSERT_EQ(merge({"--export", "geotiff=" + directory.file("link.tif")}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(directory.file("link.tif")));
  EXPECT_EQ(read_file(directory.file("there/m.tif")).substr(0, 3), "II+");
}

TEST_F(Export, OfCopiesWithKnownPosesIsTheMergedMap) {
  // Each counts, as both poses are known.
  const std::string second = directory.file("second.yaml");
  std::filesystem::copy_file(left, second);
  const std::string head = "map\tx\ty\ttheta\n" + left + "\t0\t0\t0\n" + right + "\t1\t2\t0\n";
  const std::string two = directory.write("two.tsv", head);
  const std::string three = directory.write("three.tsv", head + second + "\t0\t0\t0\n");
  ASSERT_EQ(run({"merge", left, second, right, "-o", output, "--init", three, "--fix", left, "--fix", second,
                 "--fix", right, "--export", "geotiff"})
                .exit_code,
            0);
  const std::string each = read_file(output + "/merged.tif");
  EXPECT_EQ(run({"report", output}).err, "") << "what it makes again is what was merged";
  ASSERT_EQ(run({"merge", left, right, "-o", output, "--init", two, "--fix", left, "--fix", right, "--export",
                 "geotiff"})
                .exit_code,
            0);
  EXPECT_FALSE(read_file(output + "/merged.tif") == each);
}

TEST_F(Export, UpATreeHoldsCopiesEachAsTheMergedMapDoes) {
  ASSERT_EQ(run({"merge", left, right, left, left, "-o", output, "--strategy", "tree", "--export", "geotiff"})
                .exit_code,
            0);
  const std::string twice = read_file(output + "/merged.tif");
  ASSERT_EQ(merge({"--strategy", "tree", "--export", "geotiff"}).exit_code, 0);
  EXPECT_FALSE(read_file(output + "/merged.tif") == twice) << "log-odds add up";
}

TEST_F(Export, OfAWideSiteIsSmall) {
  const std::string poses =
      directory.write("poses.tsv", "map\tx\ty\ttheta\n" + left + "\t0\t0\t0\n" + right + "\t4000\t20\t1\n");
  const Outcome outcome = merge(
      {"--init", poses, "--fix", left, "--fix", right, "--output-resolution", "2", "--export", "geotiff"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("geotiff: " + output + "/merged.tif\n"), std::string::npos) << outcome.out;
  EXPECT_LT(std::filesystem::file_size(output + "/merged.tif"), 10'000'000u);
}

TEST_F(Export, OfAFormatThatThereIsNotIsAMistake) {
  for (const std::string format : {"kml", "", "G2O", "=x", "kml=x"}) {
    const Outcome outcome = merge({"--export", format});
    EXPECT_EQ(outcome.exit_code, 2) << format;
    EXPECT_NE(outcome.err.find("--export"), std::string::npos) << outcome.err;
    if (format.size() > 0) {
      EXPECT_NE(outcome.err.find("is no format: there are g2o, open-rmf, geojson, geotiff"),
                std::string::npos)
          << outcome.err;
    }
  }
  EXPECT_NE(merge({"--export", "g2o="}).err.find("'g2o=' names no file"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Export, ToWhereItCannotBeIsAnErrorBeforeTheWork) {
  const std::string nowhere = directory.file("no/folder/x.g2o");
  expect_error(merge({"--export", "g2o=" + nowhere}), nowhere, "No such file or directory");
  expect_error(merge({"--export", "g2o=" + output + "/transforms.json"}), output + "/transforms.json",
               "is a file that the merge itself writes");
  expect_error(merge({"--export", "g2o=" + left}), left, "is an input and would be replaced");
  expect_error(
      merge({"--export", "g2o=" + directory.file("x"), "--export", "geojson=" + directory.file("./x")}),
      directory.file("./x"), "would be written by two exports");
  expect_error(merge({"--export", "g2o=/dev/null"}), "/dev/null", "");
  expect_error(merge({"--export", "g2o=" + output}), output, "is the folder of the results");
  for (const std::string end : {"/", "/.", "/x/.."})
    expect_error(merge({"--export", "g2o=" + output + end}), output + end,
                 "cannot be written: it names a directory");
  expect_error(merge({"--search", "random-walk", "--strategy", "tree", "--trace", output + "/"}),
               output + "/", "cannot be written: it names a directory");
  expect_error(merge({"--export", "geotiff=" + directory.file("x.tif"), "--export",
                      "g2o=" + directory.file("./x_2.tif")}),
               directory.file("./x_2.tif"), "may be written by two exports");
  expect_error(merge({"--export", "g2o=" + directory.file("x_2.tif"), "--export",
                      "geotiff=" + directory.file("x.tif")}),
               directory.file("x_2.tif"), "may be written by two exports");
  expect_error(merge({"--search", "random-walk", "--strategy", "tree", "--trace", directory.file("x_2.tif"),
                      "--export", "geotiff=" + directory.file("x.tif")}),
               directory.file("x_2.tif"), "may be written by --export and --trace");
  const std::string base = left.substr(0, left.rfind("left"));
  std::filesystem::copy_file(left, base + "in_3.yaml");
  expect_error(
      run({"merge", base + "in_3.yaml", right, "-o", output, "--export", "geotiff=" + base + "in.yaml"}),
      base + "in_3.yaml", "is an input and might be replaced");
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Export, OfNothingIsAnErrorAfterTheWork) {
  const Outcome outcome = run({"merge", left, other, "-o", output, "--export", "g2o"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(count_lines(outcome.err), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find(output + "/merged.g2o: is not written: no two maps were joined"),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.out.find("nothing was merged"), std::string::npos) << outcome.out;
  EXPECT_TRUE(std::filesystem::exists(output + "/transforms.json"));
  EXPECT_FALSE(std::filesystem::exists(output + "/merged.g2o"));
  EXPECT_EQ(run({"report", output, "--export", "g2o"}).exit_code, 1);
}

}  // namespace
}  // namespace gridmerge::test
