// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <ostream>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

// A map that no command can take. `make` writes it, as "bad…", and returns its path.
struct BadMap {
  const char* name;
  std::function<std::string(const TemporaryDirectory&)> make;
  const char* cause;           // what the message has to hold
  const char* blamed = "bad";  // the file that it has to name

  friend std::ostream& operator<<(std::ostream& stream, const BadMap& map) { return stream << map.name; }
};

std::string yaml(const TemporaryDirectory& directory, const std::string& resolution,
                 const std::string& origin) {
  directory.write("bad.pgm", std::string("P5\n2 2\n255\n\0\xfe\xfe\0", 15));
  return directory.write("bad.yaml", "image: bad.pgm\nresolution: " + resolution + "\norigin: " + origin +
                                         "\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

std::function<std::string(const TemporaryDirectory&)> with_resolution(const std::string& resolution) {
  return [=](const TemporaryDirectory& directory) { return yaml(directory, resolution, "[0, 0, 0]"); };
}

std::function<std::string(const TemporaryDirectory&)> with_origin(const std::string& origin) {
  return [=](const TemporaryDirectory& directory) { return yaml(directory, "0.1", origin); };
}

std::function<std::string(const TemporaryDirectory&)> with_text(const std::string& text) {
  return [=](const TemporaryDirectory& directory) { return directory.write("bad.yaml", text); };
}

// A good YAML beside an image with these bytes.
std::function<std::string(const TemporaryDirectory&)> with_image(const std::string& bytes) {
  return [=](const TemporaryDirectory& directory) {
    const std::string path = yaml(directory, "0.1", "[0, 0, 0]");
    directory.write("bad.pgm", bytes);
    return path;
  };
}

// A PNG of 64 x 64 gray pixels whose header says so, and nothing after it.
const std::string kPngHead =
    std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x40\0\0\0\x40\x08\0\0\0\0", 29);

const std::vector<BadMap> kBadMaps = {
    {"MissingFile", [](const TemporaryDirectory& directory) { return directory.file("bad.yaml"); },
     "No such file"},
    {"EmptyFile", with_text(""), "empty"},
    {"Directory",
     [](const TemporaryDirectory& directory) {
       std::filesystem::create_directory(directory.file("bad.yaml"));
       return directory.file("bad.yaml");
     },
     "directory"},
    {"MissingImage",
     with_text("image: bad.png\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
               "occupied_thresh: 0.65\nfree_thresh: 0.196\n"),
     "No such file", "bad.png"},
    {"EmptyImage", with_image(""), "", "bad.pgm"},
    {"TruncatedPgm", with_image("P5\n200 100\n255\nshort"), "", "bad.pgm"},
    {"TruncatedPlainPgm", with_image("P2\n3 3\n255\n1 2 3 4"), "", "bad.pgm"},
    {"TruncatedPgmHeader", with_image("P5\n200"), "", "bad.pgm"},
    {"TruncatedPng", with_image(kPngHead), "", "bad.pgm"},
    {"PgmOf65536Squared", with_image("P5\n65536 65536\n255\n"), "", "bad.pgm"},
    {"PgmOfSizesThatOverflow", with_image("P5\n99999999999999999999 2\n255\n"), "", "bad.pgm"},
    {"PgmOfNegativeSize", with_image("P5\n-4 4\n255\n0123456789abcdef"), "", "bad.pgm"},
    {"PgmWithWordsForSizes", with_image("P5\nwide high\n255\n0123456789abcdef"), "", "bad.pgm"},
    {"NotAnImage", with_image("GIF89a or something"), "", "bad.pgm"},
    {"YamlThatIsAList", with_text("- 1\n- 2\n"), ""},
    {"YamlThatIsAWord", with_text("hello"), ""},
    {"YamlThatIsBroken", with_text("image: [unclosed\n"), ""},
    {"NoImageKey",
     with_text("resolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
               "free_thresh: 0.196\n"),
     "image"},
    {"NoOriginKey",
     with_text("image: bad.pgm\nresolution: 0.1\nnegate: 0\noccupied_thresh: 0.65\n"
               "free_thresh: 0.196\n"),
     "origin"},
    {"ResolutionZero", with_resolution("0"), "resolution"},
    {"ResolutionNegative", with_resolution("-1"), "resolution"},
    {"ResolutionNan", with_resolution(".nan"), "resolution"},
    {"ResolutionNanWord", with_resolution("nan"), "resolution"},
    {"ResolutionHuge", with_resolution("1e300"), "resolution"},
    {"ResolutionWord", with_resolution("fine"), "resolution"},
    {"OriginNan", with_origin("[.nan, 0, 0]"), "origin"},
    {"OriginOfTwoNumbers", with_origin("[0, 0]"), "origin"},
    {"OriginThatIsANumber", with_origin("0"), "origin"},
};

class BadInput : public CliTest, public testing::WithParamInterface<BadMap> {
 protected:
  void expect_refused(const std::vector<std::string>& arguments) const {
    SCOPED_TRACE(arguments.front());
    expect_error(run(arguments), directory.path().string() + "/" + GetParam().blamed, GetParam().cause);
  }
};

TEST_P(BadInput, IsOneLineThatNamesFileAndCause) {
  const std::string bad = GetParam().make(directory);
  expect_refused({"info", bad});
  expect_refused({"info", "--json", left, bad});
  expect_refused({"match", bad, left, "--json"});
  expect_refused({"match", left, bad, "--json"});
  expect_refused({"measure", left, bad, "--pose", "0,0,0", "--json"});
  expect_refused({"evaluate", "--negatives", directory.write("n.tsv", "fixed\tmoving\nleft.yaml\tbad.yaml\n"),
                  "--json", directory.file("result.json")});
  EXPECT_FALSE(std::filesystem::exists(directory.file("result.json")));
  expect_refused({"merge", left, bad, "-o", directory.file("out")});
  EXPECT_FALSE(std::filesystem::exists(directory.file("out")));
}

INSTANTIATE_TEST_SUITE_P(Cli, BadInput, testing::ValuesIn(kBadMaps),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace gridmerge::test
