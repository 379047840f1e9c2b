// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/io/map_file.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>
#include <utility>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "io/add_map.hpp"
#include "io/blaming.hpp"
#include "io/file_reader.hpp"
#include "io/image.hpp"
#include "io/interpret.hpp"
#include "io/map_yaml.hpp"
#include "io/pnm.hpp"
#include "io/raw_pixels.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::size_t kMaxYamlBytes = std::size_t{1} << 20;

static_assert(LoadOptions{}.max_cells == kMaxGridCells,
              "a file may have as many cells as a grid that is made");

NamedBy named_by(const LoadOptions& options) {
  return options.regular_files_only ? NamedBy::file : NamedBy::user;
}

MapImage read_image(FileReader& file, const LoadOptions& options) {
  // What is no image, a device without end for one, is not worth reading further, nor is what follows the
  // pixels that the header promises.
  if (!looks_like_image(file.read_up_to(kTellingBytes)))
    return decode_image(file.read_up_to(kTellingBytes), options.max_cells);
  const std::size_t most = most_image_bytes(file.read_up_to(kHeaderBytes), options.max_cells);
  return decode_image(file.read_up_to(most), options.max_cells);
}

LoadedMap load_bare_image(const std::filesystem::path& path, FileReader& file, const LoadOptions& options) {
  if (options.resolution == 0.0) {
    throw FileError(path,
                    "an image without a YAML needs a resolution in metres per cell: --resolution, or "
                    "resolution= in Python");
  }
  return blaming(path, [&] {
    MapYaml yaml;
    yaml.resolution = options.resolution;
    check_resolution(yaml.resolution);
    LoadedMap map = interpret(yaml, read_image(file, options), options.literal_thresholds);
    map.files = {path};
    return map;
  });
}

MapYaml read_yaml(const std::filesystem::path& path, FileReader& file) {
  return blaming(path, [&] {
    refuse_other_kinds(file.read_up_to(kTellingBytes));
    const std::string& text = file.read_all(kMaxYamlBytes);
    if (text.empty()) throw ParseError("the file is empty");
    return parse_map_yaml(text);
  });
}

bool is_there(const std::filesystem::path& path) {
  std::error_code error;  // a folder that may not be looked into holds nothing for us
  return std::filesystem::exists(path, error) && !error;
}

// The image's path, or, where nothing is there (it is another machine's), the file of its name beside the
// YAML. Windows parts names by backslashes.
std::filesystem::path image_of(const MapYaml& yaml, const std::filesystem::path& yaml_path) {
  std::filesystem::path there = yaml_path.parent_path() / yaml.image;
  if (is_there(there)) return there;
  const std::string name = yaml.image.substr(yaml.image.find_last_of("/\\") + 1);
  const std::filesystem::path beside = yaml_path.parent_path() / name;
  return !name.empty() && is_there(beside) ? beside : there;
}

// A picture that was renamed together with its YAML, which still has the old name. It may be any picture, so
// it is named, not taken.
std::string hint_of_image(const std::filesystem::path& yaml_path) {
  for (const char* ending : {".pgm", ".png", ".ppm", ".bmp", ".jpg", ".jpeg"}) {
    const std::filesystem::path candidate = std::filesystem::path(yaml_path).replace_extension(ending);
    if (is_there(candidate))
      return fmt::format("; {} lies beside it: if that is the image, name it in 'image'",
                         candidate.filename().string());
  }
  return {};
}

LoadedMap load_image_of(const MapYaml& yaml, const std::filesystem::path& yaml_path,
                        const LoadOptions& options) {
  const std::filesystem::path path = image_of(yaml, yaml_path);
  try {
    FileReader file(path, NamedBy::file);
    LoadedMap map =
        blaming(path, [&] { return interpret(yaml, read_image(file, options), options.literal_thresholds); });
    map.files = {yaml_path, path};
    if (path != yaml_path.parent_path() / yaml.image) {
      map.warnings.push_back(
          {MapWarningKind::image_elsewhere,
           fmt::format("the image is not at '{}': {} beside the YAML is taken", yaml.image, path.string())});
    }
    return map;
  } catch (const FileError& error) {
    throw FileError(fmt::format("{} (the image of {}{})", error.what(), yaml_path.string(),
                                is_there(path) ? "" : hint_of_image(yaml_path)));
  }
}

// Pixels as map_saver writes them, top row first.
std::vector<std::uint8_t> to_pixels(const OccupancyGrid& grid) {
  constexpr std::uint8_t kPixels[] = {205, 254, 0};  // by Cell: unknown, free, occupied
  std::vector<std::uint8_t> pixels;
  pixels.reserve(grid.cells.size());
  for (int row = grid.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width; ++column) {
      pixels.push_back(kPixels[static_cast<std::size_t>(grid.at(column, row))]);
    }
  }
  return pixels;
}

void check_name(const std::filesystem::path& yaml) {
  if (yaml.extension() != ".yaml" && yaml.extension() != ".yml")
    throw FileError(yaml, "cannot be written: a map's name must end in .yaml or .yml");
}

void add_files(FileSet& files, const OccupancyGrid& grid, MapMode mode, const OccupancyThresholds& thresholds,
               const std::vector<std::uint8_t>& pixels, const std::filesystem::path& yaml_name) {
  check_name(yaml_name);
  const std::string image_name = std::filesystem::path(yaml_name).replace_extension(".pgm").string();
  const std::string yaml_text = blaming(yaml_name, [&] {
    MapYaml yaml;
    yaml.image = image_name;
    yaml.mode = mode;
    yaml.occupied_thresh = thresholds.occupied;
    yaml.free_thresh = thresholds.free;
    yaml.resolution = grid.resolution;
    yaml.origin = grid.origin;
    return format_map_yaml(yaml);
  });
  files.add(image_name, encode_pgm(grid.width, grid.height, pixels));
  files.add(yaml_name.string(), yaml_text);
}

template <typename Add>
void save(const std::filesystem::path& yaml_path, const Add& add) {
  check_name(yaml_path);
  FileSet files(yaml_path.parent_path());
  add(files, yaml_path.filename());
  files.commit();
}

}  // namespace

LoadedMap load_map(const std::filesystem::path& path, const LoadOptions& options) {
  FileReader file(path, named_by(options));
  if (looks_like_image(file.read_up_to(kTellingBytes))) return load_bare_image(path, file, options);
  return load_image_of(read_yaml(path, file), path, options);
}

std::vector<std::filesystem::path> map_files(const std::filesystem::path& path, const LoadOptions& options) {
  FileReader file(path, named_by(options));
  if (looks_like_image(file.read_up_to(kTellingBytes))) return {path};
  return {path, image_of(read_yaml(path, file), path)};
}

bool internal::is_bare_image(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    FileReader file(path, NamedBy::file);
    return looks_like_image(file.read_up_to(kTellingBytes));
  } catch (const FileError&) {
    return false;
  }
}

void save_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_path) {
  save(yaml_path, [&](FileSet& files, const std::filesystem::path& name) { add_map(files, grid, name); });
}

void save_probability_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_path) {
  save(yaml_path,
       [&](FileSet& files, const std::filesystem::path& name) { add_probability_map(files, grid, name); });
}

void internal::add_map(FileSet& files, const OccupancyGrid& grid, const std::filesystem::path& yaml_name) {
  validate(grid);
  add_files(files, grid, MapMode::trinary, {}, to_pixels(grid), yaml_name);
}

void internal::add_probability_map(FileSet& files, const OccupancyGrid& grid,
                                   const std::filesystem::path& yaml_name) {
  validate(grid);
  if (grid.probability.empty()) throw std::invalid_argument("the map has no probabilities");
  const RawPixels raw = to_raw_pixels(grid);
  add_files(files, grid, MapMode::raw, raw.thresholds, raw.pixels, yaml_name);
}

}  // namespace gridmerge
