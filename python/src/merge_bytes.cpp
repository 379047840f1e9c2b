// SPDX-License-Identifier: Apache-2.0
#include "merge_bytes.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "grid_bytes.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "match/pair_pose_bytes.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

// Of each thing, no more than what it takes at least: for ByteReader::count().
constexpr std::size_t kNumber = 8;

void write(const std::optional<double>& value, ByteWriter& writer) {
  writer.byte(value ? 1 : 0);
  writer.number(value.value_or(0.0));
}

std::optional<double> read_optional(ByteReader& reader) {
  const bool is_there = reader.byte() != 0;
  const double value = reader.number();
  return is_there ? std::optional(value) : std::nullopt;
}

void write(const Deformation& deformation, ByteWriter& writer) {
  writer.pose(deformation.T_map_lattice());
  writer.number(deformation.spacing());
  writer.whole(static_cast<std::uint64_t>(deformation.columns()));
  writer.whole(static_cast<std::uint64_t>(deformation.rows()));
  writer.whole(deformation.shifts().size());
  for (const Point2& shift : deformation.shifts()) {
    writer.number(shift.x);
    writer.number(shift.y);
  }
}

Deformation read_deformation(ByteReader& reader) {
  const SE2 T_map_lattice = reader.pose();
  const double spacing = reader.number();
  const auto columns = static_cast<int>(reader.whole()), rows = static_cast<int>(reader.whole());
  std::vector<Point2> shifts(reader.count(2 * kNumber));
  for (Point2& shift : shifts) {
    shift.x = reader.number();
    shift.y = reader.number();
  }
  if (shifts.empty()) return {};
  return {T_map_lattice, spacing, columns, rows, std::move(shifts)};
}

void write(const Component& component, ByteWriter& writer) {
  writer.whole(component.members.size());
  for (const Member& member : component.members) {
    writer.whole(member.map);
    writer.pose(member.T_component_map);
    write(member.probability, writer);
    write(member.sd ? std::optional(member.sd->position) : std::nullopt, writer);
    write(member.sd ? std::optional(member.sd->theta) : std::nullopt, writer);
    write(member.deformation, writer);
  }
  write_grid(component.fused.grid, writer);
  writer.whole(component.fused.agreeing);
  writer.whole(component.fused.conflicting);
  writer.byte(component.fused.omega ? 1 : 0);
  writer.whole(static_cast<std::uint64_t>(component.fused.omega ? component.fused.omega->equal : 0));
  writer.whole(static_cast<std::uint64_t>(component.fused.omega ? component.fused.omega->cells : 0));
  writer.byte(component.in_world_frame ? 1 : 0);
}

Component read_component(ByteReader& reader) {
  Component component;
  component.members.resize(reader.count(kNumber));
  for (Member& member : component.members) {
    member.map = reader.whole();
    member.T_component_map = reader.pose();
    member.probability = read_optional(reader);
    const std::optional<double> position = read_optional(reader), theta = read_optional(reader);
    if (position && theta) member.sd = PoseDeviation{*position, *theta};
    member.deformation = read_deformation(reader);
  }
  component.fused.grid = read_grid(reader);
  component.fused.agreeing = reader.whole();
  component.fused.conflicting = reader.whole();
  const bool has_omega = reader.byte() != 0;
  const auto equal = static_cast<std::int64_t>(reader.whole()),
             cells = static_cast<std::int64_t>(reader.whole());
  if (has_omega) component.fused.omega = EqualCells{equal, cells};
  component.in_world_frame = reader.byte() != 0;
  return component;
}

void write(const Join& join, ByteWriter& writer) {
  write_pair_pose(join, writer);
  writer.whole(join.fixed);
  writer.whole(join.moving);
  writer.byte(static_cast<std::uint8_t>(join.outcome));
  writer.byte(join.over_budget ? 1 : 0);
  writer.text(gridmerge::to_bytes(join.match));
}

Join read_join(ByteReader& reader) {
  Join join;
  read_pair_pose(reader, join);
  join.fixed = reader.whole();
  join.moving = reader.whole();
  join.outcome = static_cast<JoinOutcome>(reader.byte());
  join.over_budget = reader.byte() != 0;
  join.match = match_from_bytes(reader.text());
  return join;
}

void write(const PlanPlacement& plan, ByteWriter& writer) {
  writer.text(plan.name);
  writer.number(plan.scale);
  writer.number(plan.resolution);
  writer.whole(plan.parts.size());
  for (const PlanPart& part : plan.parts) {
    writer.whole(part.maps.size());
    for (const std::size_t map : part.maps) writer.whole(map);
    writer.pose(part.T_plan_first);
    writer.number(part.scale);
    writer.number(part.probability);
    writer.byte(static_cast<std::uint8_t>(part.reason));
  }
}

PlanPlacement read_plan(ByteReader& reader) {
  PlanPlacement plan;
  plan.name = reader.text();
  plan.scale = reader.number();
  plan.resolution = reader.number();
  plan.parts.resize(reader.count(kNumber));
  for (PlanPart& part : plan.parts) {
    part.maps.resize(reader.count(kNumber));
    for (std::size_t& map : part.maps) map = reader.whole();
    part.T_plan_first = reader.pose();
    part.scale = reader.number();
    part.probability = reader.number();
    part.reason = static_cast<Reason>(reader.byte());
  }
  return plan;
}

}  // namespace

std::string to_bytes(const MergeResult& result) {
  ByteWriter writer;
  writer.whole(result.components.size());
  for (const Component& component : result.components) write(component, writer);
  writer.whole(result.joins.size());
  for (const Join& join : result.joins) write(join, writer);
  writer.whole(result.left_out.size());
  for (const LeftOut& one : result.left_out) {
    writer.whole(one.map);
    writer.byte(static_cast<std::uint8_t>(one.reason));
  }
  writer.whole(result.open_ways.size());
  for (const OpenWay& way : result.open_ways) {
    writer.whole(way.fixed);
    writer.whole(way.moving);
    writer.pose(way.T_fixed_moving);
    writer.number(way.probability);
  }
  write(result.expected_false_joins, writer);
  writer.whole(result.refused_more.size());
  for (const RefusedCount& refused : result.refused_more) {
    writer.byte(static_cast<std::uint8_t>(refused.reason));
    writer.whole(refused.count);
  }
  writer.byte(result.not_compared ? 1 : 0);
  if (result.not_compared) {
    writer.whole(result.not_compared->pairs);
    writer.number(result.not_compared->expected_joins);
  }
  writer.byte(result.plan ? 1 : 0);
  if (result.plan) write(*result.plan, writer);
  return writer.take();
}

MergeResult merge_from_bytes(std::string_view bytes) {
  ByteReader reader(bytes);
  MergeResult result;
  const std::size_t components = reader.count(kNumber);
  for (std::size_t i = 0; i < components; ++i) result.components.push_back(read_component(reader));
  const std::size_t joins = reader.count(kNumber);
  for (std::size_t i = 0; i < joins; ++i) result.joins.push_back(read_join(reader));
  result.left_out.resize(reader.count(kNumber));
  for (LeftOut& one : result.left_out) {
    one.map = reader.whole();
    one.reason = static_cast<Reason>(reader.byte());
  }
  result.open_ways.resize(reader.count(kNumber));
  for (OpenWay& way : result.open_ways) {
    way.fixed = reader.whole();
    way.moving = reader.whole();
    way.T_fixed_moving = reader.pose();
    way.probability = reader.number();
  }
  result.expected_false_joins = read_optional(reader);
  result.refused_more.resize(reader.count(kNumber));
  for (RefusedCount& refused : result.refused_more) {
    refused.reason = static_cast<Reason>(reader.byte());
    refused.count = reader.whole();
  }
  if (reader.byte() != 0) {
    result.not_compared.emplace();
    result.not_compared->pairs = reader.whole();
    result.not_compared->expected_joins = reader.number();
  }
  if (reader.byte() != 0) result.plan = read_plan(reader);
  if (!reader.is_at_end()) throw std::invalid_argument("holds more than a merge");
  return result;
}

}  // namespace gridmerge::python
