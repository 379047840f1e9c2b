// SPDX-License-Identifier: Apache-2.0
// Bad map files: one clear line that names the file and the cause.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include "gridmerge/io/map_file.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using test::contains;

const std::string kYaml =
    "image: a.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: "
    "0.196\n";

class BadMap : public testing::Test {
 protected:
  std::string error_of(const std::string& path, const LoadOptions& options = {}) {
    const std::string message = test::message_of<FileError>([&] { load_map(path, options); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }

  // Of a good YAML with this image.
  std::string image_error(const std::string& image) {
    directory_.write("a.pgm", image);
    const std::string message = error_of(directory_.write("a.yaml", kYaml));
    EXPECT_TRUE(message.starts_with(directory_.file("a.pgm") + ": ")) << message;
    EXPECT_TRUE(message.ends_with(" (the image of " + directory_.file("a.yaml") + ")")) << message;
    return message;
  }

  // Of a YAML that does not get as far as its image.
  std::string yaml_error(const std::string& text) {
    const std::string message = error_of(directory_.write("a.yaml", text));
    EXPECT_TRUE(message.starts_with(directory_.file("a.yaml") + ": ")) << message;
    return message.substr(directory_.file("a.yaml: ").size());
  }

  test::TemporaryDirectory directory_;
};

TEST_F(BadMap, MissingFile) {
  EXPECT_EQ(error_of(directory_.file("a.yaml")), directory_.file("a.yaml") + ": No such file or directory");
  EXPECT_TRUE(contains(error_of(""), "No such file or directory"));
}

TEST_F(BadMap, Directory) {
  EXPECT_EQ(error_of(directory_.path().string()), directory_.path().string() + ": Is a directory");
}

TEST_F(BadMap, UnreadableFile) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read every file";
  directory_.write("a.yaml", kYaml);
  std::filesystem::permissions(directory_.file("a.yaml"), std::filesystem::perms::none);
  EXPECT_TRUE(contains(error_of(directory_.file("a.yaml")), "Permission denied"));
}

TEST_F(BadMap, EmptyFile) {
  EXPECT_EQ(yaml_error(""), "the file is empty");
}

TEST_F(BadMap, NeitherYamlNorImage) {
  EXPECT_EQ(yaml_error("hello"), "not a YAML map of keys and values");
  EXPECT_TRUE(contains(yaml_error("\xff\xd8{JFIF"), "not"));
}

TEST_F(BadMap, MissingKey) {
  EXPECT_EQ(yaml_error("image: a.pgm\n"), "missing key 'resolution'");
}

TEST_F(BadMap, ControlCharactersInValues) {
  EXPECT_EQ(yaml_error("image: a.pgm\nresolution: \"0\\n\\e[31m1\"\n"),
            "'resolution' is '0\\n\\x1b[31m1', not a finite number");
}

TEST_F(BadMap, YamlTooLarge) {
  const std::string comment(1 << 20, '#');
  EXPECT_EQ(yaml_error(kYaml + comment), "the file is larger than 1048576 bytes");
  EXPECT_TRUE(contains(error_of("/dev/zero"), "the file is larger than 1048576 bytes"));
}

TEST_F(BadMap, ImageMissing) {
  const std::string message = error_of(directory_.write("a.yaml", kYaml));
  EXPECT_EQ(message, directory_.file("a.pgm") + ": No such file or directory (the image of " +
                         directory_.file("a.yaml") + ")");
}

TEST_F(BadMap, ImageIsADirectory) {
  std::filesystem::create_directory(directory_.file("a.pgm"));
  EXPECT_TRUE(contains(error_of(directory_.write("a.yaml", kYaml)), "Is a directory"));
}

TEST_F(BadMap, ImageIsADeviceWithoutEnd) {
  std::filesystem::create_symlink("/dev/zero", directory_.file("a.pgm"));
  EXPECT_TRUE(contains(error_of(directory_.write("a.yaml", kYaml)), "not a regular file"));
}

TEST_F(BadMap, ImageIsTheYamlItself) {
  const std::string message =
      error_of(directory_.write("a.yaml", "image: a.yaml\n" + kYaml.substr(kYaml.find('\n') + 1)));
  EXPECT_TRUE(contains(message, "no image of a kind that is read"));
}

TEST_F(BadMap, BadImages) {
  EXPECT_TRUE(contains(image_error(""), "the file is empty"));
  EXPECT_TRUE(contains(image_error("hello"), "no image of a kind that is read"));
  EXPECT_TRUE(
      contains(image_error("P5\n65536 65536\n255\n"), "65536 x 65536 pixels exceed the limit of 268435456"));
  EXPECT_TRUE(contains(image_error("P5\n3 2\n255\nabcde"), "the image data end early"));
  EXPECT_TRUE(contains(image_error("\x89PNG\r\n\x1a\n"), "the file ends early"));
}

TEST_F(BadMap, OtherKindsAreNamed) {
  const std::string nul(1, '\0');
  const std::pair<std::string, std::string> kinds[] = {{"GIF89a", "a GIF image"},
                                                       {"II*" + nul, "a TIFF image"},
                                                       {"MM" + nul + "*", "a TIFF image"},
                                                       {"P4\n8 1\n\xff", "a PBM image"},
                                                       {"P7\n", "a PAM image"},
                                                       {"RIFF....WEBP", "a WebP"},
                                                       {"<!DOCTYPE html>", "a web page"},
                                                       {"<svg>", "an SVG image"},
                                                       {"%PDF-1.4", "a PDF document"},
                                                       {"\x1f\x8b\x08", "a gzip archive"},
                                                       {"PK\x03\x04", "a ZIP archive"},
                                                       {"P1\n1 1\n1", "a PBM image"},
                                                       {"<?xml version", "an XML file"},
                                                       {"<!doctype html>", "a web page"},
                                                       {"<html>", "a web page"}};
  for (const auto& [bytes, name] : kinds) {
    for (const std::string& message : {image_error(bytes), error_of(directory_.write("bare", bytes))}) {
      EXPECT_TRUE(contains(message, name));
      EXPECT_TRUE(contains(message, "must be PGM, PPM, PNG, BMP or JPEG"));
    }
  }
}

TEST_F(BadMap, GitLfsPointers) {
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\noid sha256:0123456789abcdef\nsize 12345\n";
  const std::string expected = "a Git LFS pointer, not the file itself: fetch it with 'git lfs pull'";
  EXPECT_TRUE(contains(image_error(pointer), expected));
  EXPECT_EQ(yaml_error(pointer), expected);
}

TEST_F(BadMap, ImageThatWasRenamedWithItsYaml) {
  directory_.write("b.pgm", "P2 1 1 255 0");
  const std::string message = error_of(directory_.write("b.yaml", kYaml));
  EXPECT_TRUE(contains(message, directory_.file("a.pgm") + ": No such file or directory"));
  EXPECT_TRUE(contains(message, "b.pgm lies beside it: if that is the image, name it in 'image'"));
}

TEST_F(BadMap, ImageOfMoreThanAllowedCells) {
  directory_.write("a.pgm", "P5 2 1 255\n" + std::string(3 << 20, 'x'));
  EXPECT_TRUE(contains(error_of(directory_.file("a.pgm"), {.resolution = 1.0, .max_cells = 1}),
                       "2 x 1 pixels exceed the limit of 1"));
}

TEST_F(BadMap, BareImageWithoutResolution) {
  const std::string path = directory_.write("a.pgm", "P2 1 1 255 0");
  EXPECT_EQ(error_of(path), path +
                                ": an image without a YAML needs a resolution in metres per cell: "
                                "--resolution, or resolution= in Python");
}

TEST_F(BadMap, BareImageWithAnImpossibleResolution) {
  const std::string path = directory_.write("a.pgm", "P2 1 1 255 0");
  for (const double resolution : {-1.0, 1e300, 1e-9, std::numeric_limits<double>::quiet_NaN(),
                                  std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(contains(error_of(path, {.resolution = resolution}), "the resolution")) << resolution;
  }
}

}  // namespace
}  // namespace gridmerge
