// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "address.hpp"
#include "io/number.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

std::optional<SE2> parse_pose(const std::string& text) {
  const std::optional<std::vector<double>> numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 3) return std::nullopt;
  return SE2{(*numbers)[0], (*numbers)[1], normalize_angle((*numbers)[2])};
}

}  // namespace

std::optional<std::uint64_t> parse_whole(std::string_view text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::optional<std::vector<double>> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::optional<double> number = parse_number(text.substr(begin, end - begin));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

const CLI::Validator kProbability(
    [](std::string& text) {
      const auto value = parse_number(text);
      return value && *value >= 0.0 && *value <= 1.0 ? std::string()
                                                     : "'" + text + "' is not between 0 and 1";
    },
    "");

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](std::string& text) {
            const std::optional<std::uint64_t> value = parse_whole(text);
            if (!value || *value < least || *value > most)
              return fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
            text = std::to_string(*value);
            return std::string();
          },
          ""};
}

const CLI::Validator kNumber(
    [](std::string& text) { return parse_number(text) ? std::string() : "'" + text + "' is not a number"; },
    "");

const CLI::Validator kNotNegative(
    [](std::string& text) {
      const auto value = parse_number(text);
      return value && *value >= 0.0 ? std::string() : "'" + text + "' is not a number of 0 or more";
    },
    "");

const CLI::Validator kNumbersNotNegative(
    [](std::string& text) {
      const auto values = parse_numbers(text);
      return values && std::all_of(values->begin(), values->end(), [](double value) { return value >= 0.0; })
                 ? std::string()
                 : "'" + text + "' is not a number of 0 or more, nor several with commas between them";
    },
    "");

const CLI::Validator kMetresPerCell(
    [](std::string& text) {
      const auto value = parse_number(text);
      return value && is_resolution(*value)
                 ? std::string()
                 : fmt::format("'{}' is not between {} and {} metres", text, kMinResolution, kMaxResolution);
    },
    "");

const CLI::Validator kPort = whole_number(0, 65535);

const CLI::Validator kOneAddress(
    [](std::string& text) {
      const std::vector<Address> addresses = resolve(text);
      const bool any =
          std::any_of(addresses.begin(), addresses.end(), [](const Address& one) { return one.is_any; });
      return any ? "'" + text + "' is no single address: give the one by which others reach this machine"
                 : std::string();
    },
    "");

const CLI::Validator kPose(
    [](std::string& text) {
      return parse_pose(text) ? std::string() : "'" + text + "' is no pose: x,y,theta in metres and radians";
    },
    "");

SE2 to_pose(const std::string& text) {
  return parse_pose(text).value();
}

void add_common_options(CLI::App& command, CommonOptions& options) {
  CLI::Option* quiet = command.add_flag("-q,--quiet", options.quiet,
                                        "Print results and errors only: no warnings, no progress bar");
  command
      .add_flag("-v,--verbose", options.verbose,
                "Print details too: the files that were read, and figures of each pair")
      ->excludes(quiet);
  command
      .add_option("--threads", options.threads,
                  "Worker threads; 0 = one per core. Results do not depend on it")
      ->type_name("N")
      ->transform(whole_number(0, 1024))
      ->capture_default_str();
}

void add_map_file_options(CLI::App& command, LoadOptions& options) {
  command
      .add_option("--resolution", options.resolution,
                  "Metres per cell of maps that are images without a YAML")
      ->type_name("METRES")
      ->check(kMetresPerCell);
  command.add_flag("--literal-thresholds", options.literal_thresholds,
                   "Read a YAML's thresholds to the letter. Without it the gray that map savers write for "
                   "unknown (205) is unknown, also where free_thresh would make it free");
}

}  // namespace gridmerge::cli
