// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/simulate/simulate.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands.hpp"
#include "console.hpp"
#include "evaluate/dataset.hpp"
#include "io/number.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct SimulateCommandOptions {
  CommonOptions common;
  std::string output;
  std::string kind = "office";
  std::string size = "40x25";
  std::vector<std::string> starts;
  std::vector<double> headings;  // [degrees]
  int others = 1;
  double field_of_view = 270.0;  // [degrees]
  double angular_step = 0.5;     // [degrees]
  SimulateOptions simulation;
  DatasetOptions dataset;
};

/// Two numbers with `separator` between them.
std::optional<std::array<double, 2>> parse_two(const std::string& text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return std::nullopt;
  const auto first = parse_number(text.substr(0, at)), second = parse_number(text.substr(at + 1));
  return first && second ? std::optional(std::array{*first, *second}) : std::nullopt;
}

CLI::Validator two_numbers(char separator, const std::string& example) {
  return {[separator, example](std::string& text) {
            return parse_two(text, separator) ? std::string()
                                              : "'" + text + "' is not two numbers such as " + example;
          },
          ""};
}

SimulateOptions make_options(const SimulateCommandOptions& options) {
  SimulateOptions simulation = options.simulation;
  simulation.kind = *building_kind(options.kind);
  const auto size = *parse_two(options.size, 'x');
  simulation.width = size[0];
  simulation.height = size[1];
  for (const std::string& text : options.starts) {
    const auto start = *parse_two(text, ',');
    simulation.starts.push_back({start[0], start[1]});
  }
  for (const double heading : options.headings) simulation.headings.push_back(heading * kDegree);
  simulation.sensor.field_of_view = options.field_of_view * kDegree;
  simulation.sensor.angular_step = options.angular_step * kDegree;
  simulation.threads = options.common.threads;
  return simulation;
}

/// Throws CLI::ValidationError for options that no simulation can have, and names the first.
void check_usage(const SimulateOptions& wanted) {
  SimulateOptions options;  // those that were looked at, and otherwise what is usual
  const auto check = [&](const char* name) {
    try {
      validate(options);
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError(name, error.what());
    }
  };
  const auto add = [&](const char* name, auto member) {
    options.*member = wanted.*member;
    check(name);
  };
  const auto add_of_sensor = [&](const char* name, auto member) {
    options.sensor.*member = wanted.sensor.*member;
    check(name);
  };
  add("--size", &SimulateOptions::width);
  add("--size", &SimulateOptions::height);
  add("--robots", &SimulateOptions::robots);
  add("--overlap", &SimulateOptions::overlap);
  add("--start", &SimulateOptions::starts);
  add("--heading", &SimulateOptions::headings);
  add("--longest-way", &SimulateOptions::longest_way);
  add("--steps", &SimulateOptions::steps);
  add("--clutter", &SimulateOptions::clutter);
  add("--drift", &SimulateOptions::drift);
  add("--resolution", &SimulateOptions::resolution);
  add("--tidy", &SimulateOptions::tidy);
  add_of_sensor("--range", &RangeFinder::range);
  add_of_sensor("--noise", &RangeFinder::noise);
  add_of_sensor("--stray", &RangeFinder::stray_share);
  add_of_sensor("--missed", &RangeFinder::missed_share);
  options = wanted;
  check("--field-of-view, --angular-step");  // of which one bounds the other
}

std::string describe(const Simulation& simulation, const std::string& output) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < simulation.maps.size(); ++i) {
    const SimulatedMap& map = simulation.maps[i];
    const double area =
        static_cast<double>(count_cells(map.grid).known()) * map.grid.resolution * map.grid.resolution;
    fmt::format_to(out, "robot_{}.yaml: {} x {} cells, {:.0f} m^2 known, {} scans, bent by {:.2f} m\n", i + 1,
                   map.grid.width, map.grid.height, area, map.path.size(), map.bend);
  }
  if (simulation.maps.size() > 1) {
    fmt::format_to(out,
                   "overlap {:.3f} of each robot with the one that it shares most with, on average; {} pairs "
                   "share a place, {} share none\n",
                   simulation.overlap, simulation.pairs.size(), simulation.strangers.size());
  }
  fmt::format_to(out, "the truth: {}/pairs.tsv, negatives.tsv, sets.tsv\n", escape_controls(output));
  return text;
}

int run_simulate(const SimulateCommandOptions& options) {
  Console console(options.common);
  SimulateOptions simulation_options = make_options(options);
  prepare_dataset(options.output, {static_cast<std::size_t>(simulation_options.robots),
                                   static_cast<std::size_t>(simulation_options.steps),
                                   static_cast<std::size_t>(options.others)});
  // Each building takes about as long as another.
  const auto show = [&](int done, double share) {
    console.progress("simulating", (done + share) / (1.0 + options.others));
  };
  simulation_options.progress = [&](double share) { show(0, share); };
  const Simulation simulation = simulate(simulation_options);
  std::vector<Simulation> elsewhere;
  for (int i = 0; i < options.others; ++i) {
    SimulateOptions other = gridmerge::elsewhere(simulation_options, i);
    other.progress = [&, i](double share) { show(i + 1, share); };
    elsewhere.push_back(simulate(other));
  }
  console.clear();
  const std::vector<std::filesystem::path> removed =
      write_dataset(options.output, simulation, elsewhere, options.dataset);
  print(describe(simulation, options.output) + describe_removed(removed, "dataset"));
  return kDone;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const BuildingKind kind : building_kinds()) names.emplace_back(name_of(kind));
  return names;
}

void add_world_options(CLI::App& command, SimulateCommandOptions& options) {
  SimulateOptions& simulation = options.simulation;
  command.add_option("--kind", options.kind, "What kind of building")
      ->type_name("KIND")
      ->check(CLI::IsMember(kind_names()))
      ->capture_default_str();
  command.add_option("--size", options.size, "Of the building, in metres")
      ->type_name("WxH")
      ->check(two_numbers('x', "40x25"))
      ->capture_default_str();
  command.add_option("--robots", simulation.robots, "How many robots map it")
      ->type_name("N")
      ->transform(whole_number(1, 1000))
      ->capture_default_str();
  command
      .add_option(
          "--overlap", simulation.overlap,
          "Wanted overlap of each robot with the one that it shares most with, on average: the share of the "
          "smaller area that both know. Pairs have less. Without it every robot goes wherever it can")
      ->type_name("SHARE")
      ->check(kProbability);
  command.add_option("--start", options.starts, "Where a robot starts, in metres; once for each")
      ->type_name("X,Y")
      ->check(two_numbers(',', "12.5,3"));
  command
      .add_option("--heading", options.headings,
                  "Which way a robot sets off, counter-clockwise from x; once for each. It goes only to "
                  "places ahead of its start")
      ->type_name("DEGREES")
      ->check(kNumber);
  command
      .add_option("--longest-way", simulation.longest_way,
                  "Metres after which a robot stops; 0 = when it has seen all")
      ->type_name("METRES")
      ->check(kNotNegative)
      ->capture_default_str();
  command
      .add_option("--steps", simulation.steps,
                  "Write each map at so many moments of the robot's way: robot_1_step_1.yaml and so on, "
                  "robot_1.yaml is the last")
      ->type_name("N")
      ->transform(whole_number(1, 1000))
      ->capture_default_str();
  command
      .add_option("--clutter", simulation.clutter,
                  "How much stands and walks about that differs from robot to robot")
      ->type_name("AMOUNT")
      ->check(kNotNegative)
      ->capture_default_str();
  command.add_option("--others", options.others, "How many maps of other buildings to add")
      ->type_name("N")
      ->transform(whole_number(0, 1000))
      ->capture_default_str();
}

void add_mapping_options(CLI::App& command, SimulateCommandOptions& options) {
  SimulateOptions& simulation = options.simulation;
  const auto number = [&](const char* name, double& value, const char* unit, const char* what) {
    command.add_option(name, value, what)->type_name(unit)->check(kNotNegative)->capture_default_str();
  };
  number("--drift", simulation.drift, "AMOUNT",
         "How much maps bend: 0 not at all, 1 as hand-held mapping does");
  number("--resolution", simulation.resolution, "METRES", "Metres per cell of the maps");
  number("--range", simulation.sensor.range, "METRES", "Of the range finder");
  number("--field-of-view", options.field_of_view, "DEGREES", "Of the range finder");
  number("--angular-step", options.angular_step, "DEGREES", "Between its beams");
  number("--noise", simulation.sensor.noise, "METRES", "Standard deviation of a range");
  number("--stray", simulation.sensor.stray_share, "SHARE", "Of beams that end before what they should meet");
  number("--missed", simulation.sensor.missed_share, "SHARE", "Of beams that come back with nothing");
  command
      .add_option(
          "--tidy", simulation.tidy,
          "Clean the maps as hand-held mappers do: remove specks, and make walls thicker by this much on "
          "each side. If not given, maps stay as the range finder drew them")
      ->type_name("METRES")
      ->check(kNotNegative);
  command.add_flag("--probabilities", options.dataset.probabilities,
                   "Write probabilities (mode raw), not only free, occupied and unknown");
}

}  // namespace

void add_simulate(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("simulate", "Make maps of an invented building, with ground truth");
  const auto options = std::make_shared<SimulateCommandOptions>();
  command->add_option("-o,--output", options->output, "Directory for the maps and the truth; made if need be")
      ->type_name("DIR")
      ->required();
  add_world_options(*command, *options);
  add_mapping_options(*command, *options);
  command->add_option("--seed", options->simulation.seed, "The same seed gives the same maps")
      ->type_name("N")
      ->transform(whole_number())
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer(
      "Robots explore the building, each from a start of its own, and draw what a range finder sees into a\n"
      "frame of their own. Writes robot_1.yaml and so on, elsewhere_1.yaml of other buildings, "
      "building.yaml,\n"
      "and the truth: pairs.tsv, negatives.tsv and sets.tsv, and building.tsv of the robots' maps on\n"
      "building.yaml, as 'gridmerge evaluate' reads them. simulation.sha256 lists these files. An earlier\n"
      "dataset in DIR is replaced; what this one has no file for is removed, and named. Other files that\n"
      "would be replaced are an error: choose another DIR.\n\n"
      "The less the maps overlap, and the more they bend, the fewer of them can be joined. These four "
      "can:\n\n"
      "Example:\n  gridmerge simulate --kind office --robots 4 --overlap 0.6 --seed 4 -o office\n"
      "  gridmerge merge office/robot_1.yaml office/robot_2.yaml office/robot_3.yaml office/robot_4.yaml -o "
      "merged\n"
      "  gridmerge evaluate office/pairs.tsv --negatives office/negatives.tsv --sets office/sets.tsv");
  command->callback([options, &action] {
    check_usage(make_options(*options));
    action = [options] { return run_simulate(*options); };
  });
}

}  // namespace gridmerge::cli
