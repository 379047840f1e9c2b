// SPDX-License-Identifier: Apache-2.0
#include "simulate_bytes.hpp"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "grid_bytes.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

constexpr std::size_t kNumber = 8;  // bytes of a number: for ByteReader::count()

void write(const Building& building, ByteWriter& writer) {
  writer.text(name_of(building.kind));
  writer.number(building.width);
  writer.number(building.height);
  writer.whole(building.edges.size());
  for (const Edge& edge : building.edges) {
    for (const double value : {edge.a.x, edge.a.y, edge.b.x, edge.b.y, edge.echo}) writer.number(value);
  }
}

Building read_building(ByteReader& reader) {
  Building building;
  const std::optional<BuildingKind> kind = building_kind(reader.text());
  if (!kind) throw std::invalid_argument("is a building of no kind");
  building.kind = *kind;
  building.width = reader.number();
  building.height = reader.number();
  building.edges.resize(reader.count(5 * kNumber));
  for (Edge& edge : building.edges) {
    for (double* value : {&edge.a.x, &edge.a.y, &edge.b.x, &edge.b.y, &edge.echo}) *value = reader.number();
  }
  validate(building);
  return building;
}

void write(const SimulatedMap& map, ByteWriter& writer) {
  write_grid(map.grid, writer);
  writer.pose(map.T_building_map);
  writer.number(map.bend);
  writer.whole(map.path.size());
  for (const SE2& pose : map.path) writer.pose(pose);
  writer.whole(map.earlier.size());
  for (const OccupancyGrid& grid : map.earlier) write_grid(grid, writer);
}

SimulatedMap read_map(ByteReader& reader) {
  SimulatedMap map;
  map.grid = read_grid(reader);
  map.T_building_map = reader.pose();
  map.bend = reader.number();
  map.path.resize(reader.count(3 * kNumber));
  for (SE2& pose : map.path) pose = reader.pose();
  const std::size_t earlier = reader.count(kNumber);
  for (std::size_t i = 0; i < earlier; ++i) map.earlier.push_back(read_grid(reader));
  return map;
}

void write(const SimulatedPair& pair, ByteWriter& writer) {
  writer.whole(pair.fixed);
  writer.whole(pair.moving);
  writer.pose(pair.T_fixed_moving);
  for (const double value : {pair.tolerance, pair.overlap, pair.shared_wall}) writer.number(value);
  writer.byte(static_cast<std::uint8_t>(pair.tier));
}

SimulatedPair read_pair(ByteReader& reader) {
  SimulatedPair pair;
  pair.fixed = reader.whole();
  pair.moving = reader.whole();
  pair.T_fixed_moving = reader.pose();
  for (double* value : {&pair.tolerance, &pair.overlap, &pair.shared_wall}) *value = reader.number();
  pair.tier = static_cast<char>(reader.byte());
  return pair;
}

}  // namespace

std::string to_bytes(const Simulation& simulation) {
  ByteWriter writer;
  write(simulation.building, writer);
  writer.whole(simulation.maps.size());
  for (const SimulatedMap& map : simulation.maps) write(map, writer);
  writer.whole(simulation.pairs.size());
  for (const SimulatedPair& pair : simulation.pairs) write(pair, writer);
  writer.whole(simulation.strangers.size());
  for (const auto& [a, b] : simulation.strangers) {
    writer.whole(a);
    writer.whole(b);
  }
  writer.number(simulation.overlap);
  return writer.take();
}

Simulation simulation_from_bytes(std::string_view bytes) {
  ByteReader reader(bytes);
  Simulation simulation;
  simulation.building = read_building(reader);
  const std::size_t maps = reader.count(kNumber);
  for (std::size_t i = 0; i < maps; ++i) simulation.maps.push_back(read_map(reader));
  const std::size_t pairs = reader.count(kNumber);
  for (std::size_t i = 0; i < pairs; ++i) simulation.pairs.push_back(read_pair(reader));
  simulation.strangers.resize(reader.count(2 * kNumber));
  for (auto& [a, b] : simulation.strangers) {
    a = reader.whole();
    b = reader.whole();
  }
  simulation.overlap = reader.number();
  if (!reader.is_at_end()) throw std::invalid_argument("holds more than a simulation");
  return simulation;
}

}  // namespace gridmerge::python
