// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "console.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "io/atomic_file.hpp"
#include "report/distance_picture.hpp"
#include "report/json_lines.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

struct MeasureCommandOptions {
  CommonOptions common;
  std::string fixed;
  std::vector<std::string> moving;
  std::vector<std::string> poses;  // of the moving maps
  double c_lock = 0.0;
  LoadOptions load;
  std::string dmap;
  int dmap_of = 0;
  std::string dmap_class = "occupied";
  std::string dmap_pass = "backward";
  bool json = false;
};

struct DistancePass {
  const char* name;
  DistanceMap DistanceMapPasses::*map;
};
constexpr std::array kPasses{DistancePass{"start", &DistanceMapPasses::start},
                             DistancePass{"forward", &DistanceMapPasses::forward},
                             DistancePass{"backward", &DistanceMapPasses::backward}};

struct DistanceClass {
  const char* name;
  Cell cell;
};
constexpr std::array kClasses{DistanceClass{"occupied", Cell::occupied}, DistanceClass{"free", Cell::free},
                              DistanceClass{"unknown", Cell::unknown}};

/// The names of a list of choices.
template <typename Choices>
std::vector<std::string> names_of(const Choices& choices) {
  std::vector<std::string> names;
  names.reserve(choices.size());
  for (const auto& choice : choices) names.emplace_back(choice.name);
  return names;
}

/// The choice of that name, which is there.
template <typename Choices>
const auto& choice_of(const Choices& choices, const std::string& name) {
  return *std::find_if(choices.begin(), choices.end(),
                       [&](const auto& choice) { return choice.name == name; });
}

bool is_csv(const std::string& path) {
  return std::filesystem::path(path).extension() == ".csv";
}

/// Rows from the upper one down, as in the picture.
std::string distance_map_csv(const DistanceMap& map) {
  std::string text;
  for (int row = map.height - 1; row >= 0; --row) {
    for (int column = 0; column < map.width; ++column) {
      const std::uint16_t distance = map.at(column, row);
      text += distance == kNoDistance ? "inf" : std::to_string(distance);
      text += column + 1 < map.width ? ',' : '\n';
    }
  }
  return text;
}

std::string describe_pair(const PoseMeasure& measure, const MeasureCommandOptions& options) {
  const ImageSimilarity& similarity = measure.similarity;
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "  {:<27}{}\n", name, value);
  };
  const bool has_common = similarity.agreement + similarity.disagreement > 0;
  if (!has_common) text += "  no known cell in common: the maps say nothing of this pose\n";
  const auto term = [&](const std::string& name, const DirectedDistance& distance) {
    line("  " + name, distance.defined() ? fmt::format("{:.6g} cells", distance.mean())
                                         : "undefined: a map has no such cell; counts as 0");
  };
  line("T_fixed_moving", describe_pose(measure.T_fixed_moving));
  line("omega", fmt::format("{} of {} cells are equal", similarity.omega, measure.cells));
  line("psi", fmt::format("{:.6g}", similarity.psi()));
  term("fixed-moving, occupied", similarity.fixed_to_moving_occupied);
  term("fixed-moving, free", similarity.fixed_to_moving_free);
  term("moving-fixed, occupied", similarity.moving_to_fixed_occupied);
  term("moving-fixed, free", similarity.moving_to_fixed_free);
  line("agreement", fmt::format("{} cells: {} occupied, {} free", similarity.agreement,
                                measure.common.occupied_occupied, measure.common.free_free));
  line("disagreement", fmt::format("{} cells", similarity.disagreement));
  line("Delta", fmt::format("{:.6g} with c_lock {}", similarity.delta(options.c_lock), options.c_lock));
  line("acceptance index", has_common ? fmt::format("{:.4f}", similarity.acceptance_index())
                                      : "undefined: no known cell in common; counts as 0");
  line("the engine says", fmt::format("probability {:.4f}", measure.engine.probability));
  for (const PoseFigure& figure : pose_figures())
    line(std::string("  ") + figure.name,
         fmt::format("{:.4g} {}", measure.engine.figures.*figure.value, figure.unit));
  return text;
}

std::string describe(const JointMeasure& measure, const MeasureCommandOptions& options) {
  std::string text;
  if (measure.pairs.size() > 1) {
    fmt::format_to(std::back_inserter(text), "omega of all {} maps: {} of {} cells are equal\n",
                   measure.pairs.size() + 1, measure.omega, measure.cells);
  }
  for (std::size_t i = 0; i < measure.pairs.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{} on {}\n", escape_controls(options.moving[i]),
                   escape_controls(options.fixed));
    text += describe_pair(measure.pairs[i], options);
  }
  return text;
}

struct Inputs {
  std::vector<OccupancyGrid> maps;  // the fixed one first
  std::vector<std::filesystem::path> files;

  /// At the poses that the command line gives.
  std::vector<PlacedMap> placed(const MeasureCommandOptions& options) const {
    std::vector<PlacedMap> placed{{&maps.front(), {}}};
    for (std::size_t i = 0; i < options.poses.size(); ++i)
      placed.push_back({&maps[i + 1], to_pose(options.poses[i])});
    return placed;
  }
};

Inputs load_inputs(const MeasureCommandOptions& options, Console& console) {
  Inputs inputs;
  MapReader reader(options.load, console);
  std::vector<std::string> paths{options.fixed};
  paths.insert(paths.end(), options.moving.begin(), options.moving.end());
  for (const std::string& path : paths) {
    LoadedMap map = reader.read(path);
    inputs.maps.push_back(std::move(map.grid));
    inputs.files.insert(inputs.files.end(), map.files.begin(), map.files.end());
  }
  reader.tell_warnings();
  return inputs;
}

void write_distance_map(const std::vector<PlacedMap>& placed, const MeasureCommandOptions& options) {
  const OccupancyGrid& lattice = *placed.front().map;
  const PlacedMap& map = placed[static_cast<std::size_t>(options.dmap_of)];
  const DistanceMapPasses passes =
      trace_distance_map(draw_on_lattice(lattice, map), choice_of(kClasses, options.dmap_class).cell);
  const DistanceMap& wanted = passes.*choice_of(kPasses, options.dmap_pass).map;
  write_file_atomically(options.dmap,
                        is_csv(options.dmap) ? distance_map_csv(wanted) : distance_map_png(wanted));
}

int run_measure(const MeasureCommandOptions& options) {
  Console console(options.common);
  const Inputs inputs = load_inputs(options, console);
  const std::vector<PlacedMap> placed = inputs.placed(options);
  if (!options.dmap.empty()) try_output_file(options.dmap, inputs.files);
  try {
    const JointMeasure measure =
        measure_maps(*placed.front().map, std::span(placed).subspan(1), options.common.threads);
    if (!options.dmap.empty()) write_distance_map(placed, options);
    print(options.json ? measure_json(options.fixed, options.moving, measure, options.c_lock)
                       : describe(measure, options));
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(
        fmt::format("{} and {}: {}", options.fixed, fmt::join(options.moving, ", "), error.what()));
  }
  return kDone;
}

void check_usage(const MeasureCommandOptions& options) {
  if (options.poses.size() != options.moving.size())
    throw CLI::ValidationError("--pose", fmt::format("is given {} times for {} moving maps",
                                                     options.poses.size(), options.moving.size()));
  if (!options.dmap.empty() && !is_csv(options.dmap) &&
      std::filesystem::path(options.dmap).extension() != ".png")
    throw CLI::ValidationError("--dmap", "must end in .png or .csv");
  if (static_cast<std::size_t>(options.dmap_of) > options.moving.size())
    throw CLI::ValidationError("--dmap-of", fmt::format("there is no moving map {}", options.dmap_of));
}

void add_distance_map_options(CLI::App& command, MeasureCommandOptions& options) {
  CLI::Option* dmap =
      command
          .add_option("--dmap", options.dmap,
                      "Write a distance map (d-map) on FIXED's cells: FILE.png is a picture in "
                      "gray, with numbers in maps of at most 40 cells per side; FILE.csv is "
                      "numbers, the upper row first")
          ->type_name("FILE");
  command
      .add_option("--dmap-of", options.dmap_of, "Of which map: 0 is FIXED, 1 the first MOVING at its pose")
      ->type_name("N")
      ->transform(whole_number(0, 1 << 20))
      ->capture_default_str()
      ->needs(dmap);
  command.add_option("--dmap-class", options.dmap_class, "To which cells: occupied, free or unknown")
      ->type_name("CLASS")
      ->check(CLI::IsMember(names_of(kClasses)))
      ->capture_default_str()
      ->needs(dmap);
  command
      .add_option("--dmap-pass", options.dmap_pass,
                  "start: before the two passes of the paper's algorithm; forward: after the first, from the "
                  "upper left; backward: after both")
      ->type_name("PASS")
      ->check(CLI::IsMember(names_of(kPasses)))
      ->capture_default_str()
      ->needs(dmap);
}

}  // namespace

void add_measure(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("measure", "Say what a pose of maps is worth, found or not");
  const auto options = std::make_shared<MeasureCommandOptions>();
  command->add_option("FIXED", options->fixed, std::string(kMapHelp))->type_name("MAP")->required();
  command->add_option("MOVING", options->moving, "The maps that are laid on it")
      ->type_name("FILE")
      ->required()
      ->expected(1, -1);
  command
      ->add_option(
          "--pose", options->poses,
          "T_fixed_moving in metres and radians of the map frames; one for each MOVING, in their order")
      ->type_name("X,Y,THETA")
      ->required()
      ->check(kPose);
  command->add_option("--c-lock", options->c_lock, "The weight in Delta = psi + C (disagreement - agreement)")
      ->type_name("C")
      ->check(kNotNegative)
      ->capture_default_str();
  add_distance_map_options(*command, *options);
  command->add_flag("--json", options->json, "Print JSON");
  add_map_file_options(*command, options->load);
  add_common_options(*command, options->common);
  command->footer(
      "The measures of Birk & Carpin (2006) on FIXED's cells, and beside them what the engine says of the\n"
      "pose. omega counts equal cells, of all maps together; the rest is said of each MOVING on FIXED.\n"
      "A map that lies on none of the others is an error. Where maps lie on each other and know no cell in\n"
      "common, the output says so.\n\n"
      "Example:\n  gridmerge measure robot1.yaml robot2.yaml --pose 1.25,-3,0.52 --c-lock 7.5");
  command->callback([options, &action] {
    check_usage(*options);
    action = [options] { return run_measure(*options); };
  });
}

}  // namespace gridmerge::cli
