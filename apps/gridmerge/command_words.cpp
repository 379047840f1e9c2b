// SPDX-License-Identifier: Apache-2.0
#include "command_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace gridmerge::cli {

namespace {

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

// Where a word is the name of a file that is there: how to say so.
std::string file_hint(const std::string& word) {
  std::error_code ignored;
  return std::filesystem::exists(word, ignored) ? fmt::format(" (./{} is a file)", word) : std::string();
}

// What is wrong with a value, whatever the option makes of it. CLI11 takes any word behind an option for its
// value: of "-o --elastic" or "-o=out" a folder of that name would be made.
std::string what_is_wrong(const CLI::App& command, const CLI::Option& option, const std::string& value) {
  if (value.empty()) return "its value is empty: give one, or leave it out";
  if (option.get_positional()) return {};
  if (value.starts_with("--") || (value.starts_with('-') && command.get_option_no_throw(value) != nullptr))
    return fmt::format("'{}' looks like an option: a value is missing before it{}", value, file_hint(value));
  if (value.starts_with('=') && !option.get_snames().empty())
    return fmt::format("'{}' begins with '=': leave that out{}", value, file_hint(value));
  return {};
}

// CLI11 takes "[a,b]" for a list of two values, but for no name of a file, where an option takes no more
// than one at a time. Positionals then take more only as long as they wait for them.
void read_brackets_literally(CLI::Option& option) {
  if (!option.get_allow_extra_args()) return;
  option.allow_extra_args(false);
  if (!option.get_positional()) return;
  constexpr int kMany = CLI::detail::expected_max_vector_size;
  option.multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->expected(kMany, kMany);
}

}  // namespace

void settle_values(CLI::App& command) {
  for (CLI::Option* const option : command.get_options()) {
    if (!takes_value(*option)) continue;
    read_brackets_literally(*option);
    CLI::Validator is_value(
        [&command, option](const std::string& value) { return what_is_wrong(command, *option, value); }, "");
    option->transform(is_value.non_modifying());  // before what else is asked of it
  }
}

std::vector<std::string> words_to_parse(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> words;
  const CLI::App* command = &app;
  bool has_options = true;  // there are none behind "--"
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    for (const CLI::App* one : app.get_subcommands({})) {
      if (command == &app && word == one->get_name()) command = one;
    }
    has_options = has_options && word != "--";
    const std::size_t at = word.find('=');
    if (has_options && word.starts_with('-') && at != std::string::npos) {
      const std::string name = word.substr(0, at);
      const CLI::Option* const option = command->get_option_no_throw(name);
      if (option != nullptr && !takes_value(*option))
        throw CLI::ValidationError(name, "takes no value: leave it out if it is not meant");
      if (option != nullptr && word.starts_with("--")) {
        words.push_back(name);
        word.erase(0, at + 1);
      }
    }
    words.push_back(std::move(word));
  }
  std::reverse(words.begin(), words.end());
  return words;
}

std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv) {
  const std::vector<std::string> words = app.remaining(true);
  if (app.get_subcommands().empty() && !words.empty() && !words.front().starts_with('-'))
    return "there is no command '" + words.front() + "'";
  // It may be why something else is missing: of "info -d.yaml" a map. Words behind "--" are no options.
  const auto options_end = std::find(argv, argv + argc, std::string_view("--"));
  const auto unknown = std::find_if(words.begin(), words.end(), [&](const std::string& word) {
    return word.starts_with('-') && std::find(argv, options_end, word) != options_end;
  });
  if (unknown == words.end()) return error.what();
  return fmt::format("there is no option '{}'{}", *unknown, file_hint(*unknown));
}

}  // namespace gridmerge::cli
