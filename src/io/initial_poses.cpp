// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/io/initial_poses.hpp"

#include <cmath>
#include <string>
#include <unordered_set>

#include "grid/pose_bounds.hpp"
#include "io/file_reader.hpp"
#include "io/text_table.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;  // bounds what a wrong argument makes us read

double place(const TextTable& table, std::size_t row, std::string_view column) {
  const double value = table.number(row, column);
  if (std::abs(value) > kFarthestPose) table.fail(row, std::string(column) + " is farther off than 10000 km");
  return value;
}

double deviation(const TextTable& table, std::size_t row, std::string_view column, double usual) {
  if (!table.has(column)) return usual;
  const double value = table.number(row, column);
  if (!is_deviation(value))
    table.fail(row, std::string(column) + " must be positive, from 0.000001 to 100000");
  return value;
}

}  // namespace

std::vector<InitialPose> parse_initial_poses(const std::filesystem::path& path, std::string_view text) {
  const TextTable table(path, text, {"map", "x", "y", "theta"}, {"sd", "sd_theta"});
  std::vector<InitialPose> poses;
  std::unordered_set<std::string> names;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    InitialPose pose;
    pose.name = table.text(row, "map");
    if (pose.name.find('\0') != std::string::npos) table.fail(row, "map holds a NUL character");
    if (!names.insert(pose.name).second) table.fail(row, "names '" + pose.name + "' a second time");
    pose.path = path.parent_path() / pose.name;
    pose.theta_as_written = table.number(row, "theta");
    pose.T_world_map = {place(table, row, "x"), place(table, row, "y"),
                        normalize_angle(pose.theta_as_written)};
    pose.sd_position = deviation(table, row, "sd", pose.sd_position);
    pose.sd_theta = deviation(table, row, "sd_theta", pose.sd_theta);
    poses.push_back(std::move(pose));
  }
  return poses;
}

std::vector<InitialPose> read_initial_poses(const std::filesystem::path& path) {
  FileReader reader(path);
  return parse_initial_poses(path, reader.read_all(kMaxBytes));
}

}  // namespace gridmerge
