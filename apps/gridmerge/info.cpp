// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "console.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/io/map_file.hpp"

namespace gridmerge::cli {

namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  CommonOptions common;
  std::vector<std::string> maps;
  LoadOptions load;
  bool json = false;
};

// What a bag says of a map beside the map itself.
struct Recording {
  std::string topic;
  std::string frame_id;
  std::size_t maps = 0;     // whole ones
  std::size_t updates = 0;  // of parts of them
};

struct NamedMap {
  std::string name;
  LoadedMap map;
  std::optional<Recording> recording;  // nothing where the map is of a file
};

struct Size {
  double width = 0.0;   // [m]
  double height = 0.0;  // [m]
};

// Of the smallest rectangle along the grid's axes that holds every known cell.
Size known_size(const OccupancyGrid& grid) {
  if (count_cells(grid).known() == 0) return {};
  const OccupancyGrid known = crop_to_known(grid);
  return {known.width * known.resolution, known.height * known.resolution};
}

std::string describe(const NamedMap& named) {
  const OccupancyGrid& grid = named.map.grid;
  const CellCounts counts = count_cells(grid);
  const Size known = known_size(grid);
  const auto share = [&](std::size_t count) {
    return fmt::format("{} ({:.1f} %)", count,
                       100.0 * static_cast<double>(count) / static_cast<double>(grid.cells.size()));
  };
  std::string text = escape_controls(named.name) + "\n";
  const auto line = [&](const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "  {:<12}{}\n", name, value);
  };
  if (named.recording) {
    const Recording& recording = *named.recording;
    line("topic", fmt::format("{}, {} maps, {} updates", escape_controls(recording.topic), recording.maps,
                              recording.updates));
    line("frame", escape_controls(recording.frame_id));
  }
  line("size", fmt::format("{} x {} cells, {:.2f} m x {:.2f} m", grid.width, grid.height,
                           grid.width * grid.resolution, grid.height * grid.resolution));
  line("resolution", fmt::format("{} m", grid.resolution));
  line("origin", fmt::format("x {:.3f} m, y {:.3f} m, yaw {:.4f} rad ({:.2f} deg)", grid.origin.x,
                             grid.origin.y, grid.origin.theta, grid.origin.theta * 180.0 / std::numbers::pi));
  line("occupied", share(counts.occupied));
  line("free", share(counts.free));
  line("unknown", share(counts.unknown));
  line("known area", fmt::format("{:.2f} m x {:.2f} m", known.width, known.height));
  for (const MapWarning& warning : named.map.warnings) line("warning", escape_controls(warning.text));
  return text;
}

Json describe_json(const NamedMap& named) {
  const OccupancyGrid& grid = named.map.grid;
  const CellCounts counts = count_cells(grid);
  const Size known = known_size(grid);
  Json warnings = Json::array();
  for (const MapWarning& warning : named.map.warnings) warnings.push_back(warning.text);
  Json json{{"source", named.name},
            {"width", grid.width},
            {"height", grid.height},
            {"resolution", grid.resolution},
            {"origin", {{"x", grid.origin.x}, {"y", grid.origin.y}, {"theta", grid.origin.theta}}},
            {"occupied", counts.occupied},
            {"free", counts.free},
            {"unknown", counts.unknown},
            {"known_size", {{"width", known.width}, {"height", known.height}}},
            {"warnings", warnings}};
  if (named.recording) {
    const Recording& recording = *named.recording;
    json["bag"] = {{"topic", recording.topic},
                   {"frame_id", recording.frame_id},
                   {"maps", recording.maps},
                   {"updates", recording.updates}};
  }
  return json;
}

NamedMap read_topic(const Bag& bag, const std::string& topic) {
  BagMaps maps(bag, topic);
  BagMap last = maps.last();
  const MapName name{bag.path(), maps.topic()};
  return {
      format_map_name(name).string(),
      {std::move(last.grid), std::move(last.warnings), bag.files()},
      Recording{maps.topic(), std::move(last.frame_id), maps.messages() - maps.updates(), maps.updates()}};
}

// Of a bag without a topic, the map of each of its topics that has one: a robot that has seen nothing yet
// does not hide the others.
template <typename Use>
void for_each_map(const std::string& path, const LoadOptions& load, Console& console, const Use& use) {
  const auto [file, topic] = parse_map_name(path);
  if (!is_bag(file)) return use(NamedMap{path, load_any_map(path, load), std::nullopt});
  const Bag bag(file, load);
  const std::vector<BagTopic> topics = bag.map_topics();
  if (!topic.empty() || topics.empty()) return use(read_topic(bag, topic));
  std::vector<EmptyTopic> empty;
  for (const BagTopic& one : topics) {
    try {
      use(read_topic(bag, one.name));
    } catch (const EmptyTopic& error) {
      empty.push_back(error);
    }
  }
  if (empty.size() == topics.size()) throw empty.front();
  for (const EmptyTopic& error : empty) console.warn(error.what());
}

int info(const InfoOptions& options) {
  Console console(options.common);
  Json maps = Json::array();
  for (const std::string& path : options.maps) {
    for_each_map(path, options.load, console, [&](const NamedMap& map) {
      if (options.json) {
        maps.push_back(describe_json(map));
      } else {
        print(describe(map));
      }
    });
  }
  if (options.json) print(Json{{"maps", maps}}.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  return kDone;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("info", "Show size, resolution, origin, cell counts and warnings of maps");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("MAP", options->maps, std::string(kMapHelp))->type_name("MAP")->required();
  command->add_flag("--json", options->json, "Print JSON, on one line");
  add_map_file_options(*command, options->load);
  add_common_options(*command, options->common);
  command->footer(
      "Of a bag without a topic it shows the last map of each topic that has maps.\n\n"
      "Example:\n  gridmerge info robot1.yaml robot2.yaml\n  gridmerge info robot1.mcap");
  command->callback([options, &action] { action = [options] { return info(*options); }; });
}

}  // namespace gridmerge::cli
