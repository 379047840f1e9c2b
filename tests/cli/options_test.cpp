// SPDX-License-Identifier: Apache-2.0
// How the values of options are read: all options of all commands, as --help lists them.
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "commands.hpp"
#include "fixture.hpp"

namespace gridmerge::test {
namespace {

using Words = std::vector<std::string>;

/// An entry of --help.
struct Option {
  std::string command;
  std::string name;        ///< "--output"; "MAP" of what has no name on the command line
  std::string short_name;  ///< "-o", if there is one
  bool takes_value = false;
  Words before{};    ///< positionals that stand before it
  std::string text;  ///< all its lines

  bool is_positional() const { return !name.starts_with('-'); }
};

/// Of all commands, but for --help.
std::vector<Option> all_options() {
  const std::regex heading("Positionals:|Options:|With --search random-walk:");
  const std::regex positional("  ([A-Z]+) [A-Z].*");
  const std::regex named("  (?:(-[a-z]),)?(--[a-z-]+)( [^ ]*[^ :](?= |$))?.*");
  std::vector<Option> options;
  for (const std::string& command : kCommands) {
    std::istringstream help(run({command, "--help"}).out);
    Words before;
    bool is_list = false;  // of options
    for (std::string line; std::getline(help, line);) {
      std::smatch found;
      is_list = (is_list && !line.empty()) || std::regex_match(line, heading);
      if (!is_list) continue;
      if (std::regex_match(line, found, named) && found[2] != "--help") {
        options.push_back({command, found[2], found[1], found[3].matched, {}, line});
      } else if (std::regex_match(line, found, positional)) {
        options.push_back({command, found[1], "", true, before, line});
        before.push_back(found[1]);
      } else if (!options.empty() && options.back().command == command) {
        options.back().text += line.substr(std::min(line.size(), line.find_first_not_of(' ') - 1));
      }
    }
  }
  return options;
}

/// What a command says of this word for an option before it does anything.
Outcome parse(const Option& option, const std::string& value) {
  Words words{option.command};
  words.insert(words.end(), option.before.begin(), option.before.end());
  if (!option.is_positional()) words.push_back(option.name);
  words.insert(words.end(), {value, "--help"});
  return run(words);
}

void expect_usage_error(const Outcome& outcome, const std::string& text) {
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err << "does not say " << text;
}

class EveryOption : public testing::Test {
 protected:
  template <typename Check>
  void for_each_value(const Check& check) {
    std::size_t checked = 0;
    for (const Option& option : all_options()) {
      if (!option.takes_value) continue;
      SCOPED_TRACE(option.command + " " + option.name);
      check(option);
      ++checked;
    }
    EXPECT_GE(checked, 100U);
  }
};

TEST_F(EveryOption, SaysWhatHoldsWithoutIt) {
  const std::regex says("[^=]* [^ ]*=[^ ].*|.*(REQUIRED|given).*");
  std::set<std::string> silent;
  for_each_value([&](const Option& option) {
    if (!option.is_positional() && !std::regex_match(option.text, says)) silent.insert(option.name);
  });
  // Without these something is not done, or not known.
  EXPECT_EQ(silent,
            (std::set<std::string>{"--bag", "--cache", "--dmap", "--features", "--heading", "--init",
                                   "--json", "--negatives", "--overlap", "--page", "--plan", "--root",
                                   "--resolution", "--scale", "--sets", "--shard", "--start", "--trace"}));
}

TEST_F(EveryOption, RefusesAnEmptyValue) {
  for_each_value([](const Option& option) {
    const std::string said = option.name + ": its value is empty";
    expect_usage_error(parse(option, ""), said);
    if (!option.is_positional()) expect_usage_error(run({option.command, option.name + "=", "--help"}), said);
  });
}

TEST_F(EveryOption, ReadsDigitsBehindAZero) {
  for_each_value([](const Option& option) {
    const Outcome outcome = parse(option, "08");
    EXPECT_EQ(outcome.exit_code, parse(option, "8").exit_code) << outcome.err;
  });
}

TEST_F(EveryOption, TakesNoOtherOptionForItsValue) {
  for_each_value([](const Option& option) {
    if (option.is_positional()) return;
    for (const char* value : {"--quiet", "-q", "--qiet", "--threads=1", "--"})
      expect_usage_error(run({option.command, option.name, value, "--help"}), "looks like an option");
  });
}

TEST_F(EveryOption, ReadsBracketsLiterally) {
  for_each_value([](const Option& option) {
    if (option.is_positional()) return;
    const Outcome outcome = parse(option, "[--quiet,8]");  // of a list the first would be an option
    EXPECT_EQ(outcome.err.find("looks like an option"), std::string::npos) << outcome.err;
  });
  std::map<std::string, Words> positionals;
  for (const Option& option : all_options()) {
    if (option.is_positional()) positionals[option.command].push_back(option.name);
  }
  EXPECT_EQ(positionals.size(), 7U);
  for (const auto& [command, names] : positionals) {
    Words words{command};
    words.insert(words.end(), names.size(), "[]");
    const std::string said = run(words).err;  // of empty lists nothing would be left
    for (const std::string& name : names)
      EXPECT_EQ(said.find(name + " is required"), std::string::npos) << command << said;
  }
}

TEST_F(EveryOption, OfOneLetterHasNoEqualsSignBeforeItsValue) {
  std::size_t checked = 0;
  for (const Option& option : all_options()) {
    if (option.short_name.empty() || !option.takes_value) continue;
    expect_usage_error(run({option.command, option.short_name + "=x", "--help"}), "begins with '='");
    EXPECT_EQ(run({option.command, option.short_name, "./=x", "--help"}).exit_code, 0);
    EXPECT_EQ(run({option.command, option.name + "=x", "--help"}).exit_code, 0);
    ++checked;
  }
  EXPECT_EQ(checked, 2U);  // -o of merge and simulate
}

TEST_F(EveryOption, WithoutAValueTakesNone) {
  std::size_t checked = 0;
  for (const Option& option : all_options()) {
    if (option.takes_value) continue;
    SCOPED_TRACE(option.command + " " + option.name);
    for (const char* value : {"false", "0", "no", "true", ""})
      expect_usage_error(run({option.command, option.name + "=" + value, "--help"}),
                         option.name + ": takes no value");
    ++checked;
  }
  EXPECT_GE(checked, 25U);
}

/// Works in the folder of the maps.
class OptionValues : public CliTest {
 protected:
  OptionValues() { std::filesystem::current_path(directory.path()); }
  ~OptionValues() override { std::filesystem::current_path(before); }

  const std::filesystem::path before = std::filesystem::current_path();
};

TEST_F(OptionValues, AreDecimal) {
  const Words walk{"match", left, right, "--search", "random-walk", "--c-lock", "1,2,3,4,5,6,7,8,9"};
  Words enough = walk, too_few = walk;
  enough.insert(enough.end(), {"--restarts", "010", "--patience", "08", "--starts", "01x01x010"});
  too_few.insert(too_few.end(), {"--restarts", "08"});
  EXPECT_NE(run(enough).exit_code, 2);
  expect_usage_error(run(too_few), "--restarts: is less than");
  expect_usage_error(run({"simulate", "-o", directory.file("out"), "--robots", "0x10"}),
                     "--robots: '0x10' is not a whole number from 1 to 1000");
}

TEST_F(OptionValues, AreWholeNumbersUpToTheMostAndNoFurther) {
  struct Most {
    Words words;  ///< of a command that fails once its options are read
    const char* option;
    const char* range;
    std::uint64_t most;
  };
  const Words walk{"match", "none.yaml", "none.yaml", "--search", "random-walk"};
  const Words simulate{"simulate", "-o", left + "/in_a_file"};
  for (const Most& one :
       {Most{{"match", "none.yaml", "none.yaml"}, "--threads", "0 to 1024", 1024},
        Most{walk, "--restarts", "1 to 1000", 1000},
        Most{walk, "--least-common-cells", "0 to 1099511627776", std::uint64_t{1} << 40},
        Most{{"measure", "none.yaml", "none.yaml", "--pose", "0,0,0", "--dmap", "d.png"},
             "--dmap-of",
             "0 to 1048576",
             1 << 20},
        Most{{"view", "none"}, "--port", "0 to 65535", 65535}, Most{simulate, "--robots", "1 to 1000", 1000},
        Most{simulate, "--steps", "1 to 1000", 1000}, Most{simulate, "--others", "0 to 1000", 1000}}) {
    const auto run_with = [&](std::uint64_t value) {
      Words words = one.words;
      words.insert(words.end(), {one.option, std::to_string(value)});
      return run(words);
    };
    const Outcome most = run_with(one.most);
    EXPECT_NE(most.exit_code, 0) << one.option;
    EXPECT_EQ(most.err.find("whole number"), std::string::npos) << most.err;
    expect_usage_error(run_with(one.most + 1), std::string(one.option) + ": '" +
                                                   std::to_string(one.most + 1) +
                                                   "' is not a whole number from " + one.range);
  }
}

TEST_F(OptionValues, AreWrittenAsPeopleWriteNumbers) {
  for (const char* accept : {"0x1p-1", " 0.5", "0.5 ", "1e-1x", "nan"})
    expect_usage_error(run({"match", left, right, "--accept", accept}), "--accept: ");
  for (const char* accept : {"5e-1", "+0.5", ".5"})
    EXPECT_NE(run({"match", left, right, "--accept", accept}).exit_code, 2) << accept;
  expect_usage_error(run({"simulate", "-o", "out", "--heading", "0x10"}),
                     "--heading: '0x10' is not a number");
  for (const char* const option : {"--cooling", "--first-step"})
    expect_usage_error(run({"match", left, right, "--search", "random-walk", option, "0x1"}),
                       std::string(option) + ": '0x1' is not a number");
}

TEST_F(OptionValues, ThatAreListsHaveNoEmptyPart) {
  for (const char* list : {"1,,2", "1,", ",1", ","})
    expect_usage_error(run({"match", left, right, "--search", "random-walk", "--c-lock", list}),
                       "--c-lock: ");
}

TEST_F(OptionValues, InBracketsAreNamesOfFiles) {
  std::filesystem::copy(left, "[right.yaml]");
  const Outcome info = run({"info", "--json", "[right.yaml]"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(Json::parse(info.out).at("maps").at(0).at("source"), "[right.yaml]");
  EXPECT_EQ(run({"merge", "[right.yaml]", right, "-o", "out"}).out.find("given twice"), std::string::npos);
  const Outcome measure =
      run({"measure", left, "[right.yaml]", "[right.yaml]", "--pose", "0,0,0", "--pose", "0,0,0"});
  EXPECT_NE(measure.out.find("\n[right.yaml] on " + left + "\n"), std::string::npos) << measure.err;
}

TEST_F(OptionValues, BehindTwoDashesAreNamesOfMaps) {
  for (const char* name : {"-d.yaml", "-q", "--json=x"}) {
    std::filesystem::copy(left, name);
    for (const Words& words : {Words{"info", "--", name}, Words{"info", left, "--quiet", "--", name}}) {
      const Outcome outcome = run(words);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_NE(outcome.out.find(std::string(name) + "\n"), std::string::npos) << outcome.out;
    }
  }
}

TEST_F(OptionValues, BehindTwoDashesMayBeTooMany) {
  expect_usage_error(run({"match", left, right, "--", "-c.yaml"}), "-c.yaml");
  EXPECT_EQ(run({"match", left, right, "--", "-c.yaml"}).err.find("there is no option"), std::string::npos);
}

TEST_F(OptionValues, ThatAreMissingAreNotTakenFromTheNextWord) {
  const std::string content = read_file(left);
  for (const std::string option : {"--output=", "--init=", "--trace="})
    expect_usage_error(run({"merge", right, option, left, "-o", directory.file("out")}),
                       "its value is empty");
  EXPECT_EQ(read_file(left), content);
}

TEST_F(OptionValues, OfAnOptionThatThereIsNotAreNoMaps) {
  expect_usage_error(run({"info", "-d.yaml"}), "there is no option '-d.yaml' (see");
  expect_usage_error(run({"merge", left, "--frobnicate", "-o", "out"}), "there is no option '--frobnicate'");
  std::filesystem::copy(left, "-d.yaml");
  expect_usage_error(run({"info", "-d.yaml"}), "there is no option '-d.yaml' (./-d.yaml is a file)");
  EXPECT_EQ(run({"info", "./-d.yaml"}).exit_code, 0);
  expect_usage_error(run({"info", "-q=false", left}), "-q: takes no value");
  // A hint of a file only where there is one.
  const std::string without = run({"match", left, right, "--threads", "--quiet"}).err;
  EXPECT_EQ(without.find("is a file"), std::string::npos) << without;
}

}  // namespace
}  // namespace gridmerge::test
