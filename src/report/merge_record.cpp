// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/merge_record.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "gridmerge/io/map_file.hpp"
#include "io/file_reader.hpp"
#include "merge/joins.hpp"
#include "report/deformation_json.hpp"
#include "report/escaped_bytes.hpp"
#include "report/fused_places.hpp"
#include "report/json_reader.hpp"
#include "report/json_values.hpp"
#include "report/output_names.hpp"
#include "report/plan_json.hpp"
#include "report/record_file.hpp"
#include "report/record_values.hpp"
#include "report/told_joins.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::size_t kMaxEqual = 100;  // of one name: what is said of them is looked for among all pairs
constexpr double kInfinity = std::numeric_limits<double>::max();

class RecordReader {
 public:
  MergeRecord read(const JsonReader& json) {
    read_names(json.at("maps"));
    read_components(json.at("components"));
    read_joins(json.at("joins"));
    if (json.has("refused")) read_refused(json.at("refused"));  // of many maps
    read_left_out(json);
    if (json.has("open_ways")) read_open_ways(json.at("open_ways"));
    // Not in what earlier versions wrote, nor where the tree was asked for.
    if (json.has("expected_false_joins") && !json.at("expected_false_joins").is_null())
      record_.result.expected_false_joins = json.at("expected_false_joins").number_in(0.0, kInfinity);
    if (json.has("not_compared")) {
      const JsonReader left = json.at("not_compared");
      record_.result.not_compared = {static_cast<std::size_t>(left.at("pairs").count()),
                                     left.at("expected_joins").number_in(0.0, kInfinity)};
    }
    if (json.has("plan")) read_plan(json.at("plan"), record_.names, record_.result);
    for (std::size_t i = 0; i < is_placed_.size(); ++i) {
      if (!is_placed_[i]) throw JsonError("'" + record_.names[i] + "' is in no component and not left out");
    }
    if (json.has("names")) unescape_names(json);
    return std::move(record_);
  }

 private:
  void read_names(const JsonReader& json) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      const std::string name = json.at(i).text();
      if (name.empty() || name.find('\0') != std::string::npos) json.at(i).fail("is no name of a file");
      named_[name].push_back(i);
      if (named_[name].size() > kMaxEqual) json.at(i).fail("is there too often: '" + name + "'");
      record_.names.push_back(name);
    }
    is_placed_.assign(record_.names.size(), false);
  }

  /// Of a merge with names that are not UTF-8, all of which are escaped: at the end, as the names tell of
  /// which map something is said.
  void unescape_names(const JsonReader& json) {
    if (json.at("names").text() != "escaped") json.at("names").fail("is not 'escaped'");
    const auto unescape = [](std::string& name, const JsonReader& place) {
      const std::optional<std::string> bytes = unescape_bytes(name);
      if (!bytes) place.fail("has an escape that is none: '" + name + "'");
      name = *bytes;
    };
    for (std::size_t i = 0; i < record_.names.size(); ++i) unescape(record_.names[i], json.at("maps").at(i));
    if (record_.result.plan) unescape(record_.result.plan->name, json.at("plan").at("source"));
  }

  /// All of that name, ascending: one, or a file that was given several times, which is equal maps.
  const std::vector<std::size_t>& maps_at(const JsonReader& json) const {
    const auto found = named_.find(json.text());
    if (found == named_.end()) json.fail("is none of the maps: '" + json.text() + "'");
    return found->second;
  }

  std::size_t map_at(const JsonReader& json) const { return maps_at(json).front(); }

  /// Of a map that nothing was said of before; of equal ones the first from `from` on, if there is one.
  std::size_t place(const JsonReader& json, std::size_t from) {
    std::optional<std::size_t> found;
    for (const std::size_t map : maps_at(json)) {
      if (!is_placed_[map] && (!found || *found < from)) found = map;
    }
    if (!found) json.fail("is in two places: '" + json.text() + "'");
    is_placed_[*found] = true;
    return *found;
  }

  void read_components(const JsonReader& json) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      const JsonReader component = json.at(i);
      if (component.at("map").text() != component_file(i))
        component.at("map").fail("is not '" + component_file(i) + "'");
      record_.result.components.push_back(read_component(component));
    }
  }

  Component read_component(const JsonReader& json) {
    Component component;
    const JsonReader members = json.at("members");
    for (std::size_t i = 0; i < members.size(); ++i) {
      component.members.push_back(read_member(members.at(i), i > 0 ? component.members.back().map : 0));
      if (i > 0 && component.members[i - 1].map > component.members[i].map)
        members.at(i).fail("is not in the order of the maps");
    }
    if (component.members.size() < 2) members.fail("holds fewer than two maps");
    if (json.has("omega")) component.fused.omega = read_omega(json);  // not in what earlier versions wrote
    component.in_world_frame = json.at("frame").is_null();
    if (component.in_world_frame) return component;
    // That of the first member, or of one that was fixed where its own frame has it.
    const std::size_t first = component.members.front().map, named = map_at(json.at("frame"));
    const std::size_t frame = record_.names[named] == record_.names[first] ? first : named;
    component.in_world_frame = frame != first;
    if (frame_of(component) != frame) json.at("frame").fail("is not the frame of its members");
    return component;
  }

  static std::optional<EqualCells> read_omega(const JsonReader& json) {
    const JsonReader cells = json.at("cells"), of_cells = json.at("omega_share");
    if (json.at("omega").is_null()) return std::nullopt;
    const EqualCells omega{json.at("omega").count(), cells.count()};
    if (omega.equal > omega.cells) cells.fail("is less than omega");
    (void)read_share(of_cells);
    return omega;
  }

  Member read_member(const JsonReader& json, std::size_t from) {
    Member member;
    member.map = place(json.at("source"), from);
    member.T_component_map = json.at("transform").transform(kFarthest);
    if (!json.at("probability").is_null()) member.probability = read_share(json.at("probability"));
    const JsonReader sd = json.at("sd");
    if (!sd.is_null())
      member.sd = {sd.at("position").number_in(0.0, kInfinity), sd.at("theta").number_in(0.0, kInfinity)};
    if (json.has("deformation")) member.deformation = read_deformation(json.at("deformation"), kFarthest);
    return member;
  }

  void read_joins(const JsonReader& json) {
    for (std::size_t i = 0; i < json.size(); ++i) record_.result.joins.push_back(read_join(json.at(i)));
  }

  /// Those that have no row are counted alone.
  void read_refused(const JsonReader& json) {
    const JsonReader columns = json.at("columns");
    std::array<std::size_t, 7> place{};  // of the columns that a row needs; others are passed over
    constexpr std::array kColumns{"fixed", "moving", "reason", "probability", "x", "y", "theta"};
    for (std::size_t c = 0; c < kColumns.size(); ++c) {
      while (columns.at(place[c]).text() != kColumns[c]) {
        if (++place[c] == columns.size()) columns.fail(std::string("has no '") + kColumns[c] + "'");
      }
    }
    std::map<Reason, std::size_t> rows;
    const JsonReader table = json.at("rows");
    for (std::size_t i = 0; i < table.size(); ++i) {
      const JsonReader row = table.at(i);
      Join join;
      join.fixed = map_number(row.at(place[0]));
      join.moving = map_number(row.at(place[1]));
      if (join.fixed == join.moving) row.fail("is of a map and itself");
      const Reason reason = read_reason(row.at(place[2]));
      if (reason == Reason::none) row.at(place[2]).fail("is none");
      join.over_budget = reason == Reason::over_budget;
      join.match.reason = join.over_budget ? Reason::several : reason;
      join.probability = read_share(row.at(place[3]));
      join.T_fixed_moving = {row.at(place[4]).number_in(-kFarthest, kFarthest),
                             row.at(place[5]).number_in(-kFarthest, kFarthest),
                             row.at(place[6]).number_in(-std::numbers::pi, std::numbers::pi)};
      static_cast<PairPose&>(join.match) = join;
      join.match.hypotheses = {{join.T_fixed_moving, 0.0, join.probability}};
      ++rows[reason];
      record_.result.joins.push_back(std::move(join));
    }
    // In the order in which the merge compared them.
    std::stable_sort(record_.result.joins.begin(), record_.result.joins.end(),
                     [](const Join& a, const Join& b) {
                       return std::pair(a.fixed, a.moving) < std::pair(b.fixed, b.moving);
                     });
    read_more_refused(json, rows);
  }

  void read_more_refused(const JsonReader& json, const std::map<Reason, std::size_t>& rows) {
    std::size_t counted = 0, in_rows = 0;
    const JsonReader reasons = json.at("reasons");
    for (int i = 0; i <= static_cast<int>(Reason::over_budget); ++i) {
      const auto reason = static_cast<Reason>(i);
      if (reason == Reason::none || !reasons.has(name_of(reason))) continue;
      const JsonReader count = reasons.at(name_of(reason));
      const std::size_t all = static_cast<std::size_t>(count.count());
      const std::size_t told = rows.count(reason) > 0 ? rows.at(reason) : 0;
      if (all < told) count.fail("is less than its rows");
      counted += all;
      in_rows += told;
      if (all > told) record_.result.refused_more.push_back({reason, all - told});
    }
    if (static_cast<std::size_t>(json.at("count").count()) != counted)
      json.at("count").fail("is not the sum of the reasons");
    if (in_rows != json.at("rows").size()) json.at("rows").fail("has a reason that is not counted");
  }

  std::size_t map_number(const JsonReader& json) const {
    const std::int64_t number = json.count();
    if (number >= static_cast<std::int64_t>(record_.names.size())) json.fail("is no number of a map");
    return static_cast<std::size_t>(number);
  }

  /// The maps of a join. Of equal ones those that are next in the order of joins: ascending, fixed < moving.
  std::pair<std::size_t, std::size_t> pair_of(const JsonReader& json) const {
    using Maps = std::pair<std::size_t, std::size_t>;
    const Maps before = record_.result.joins.empty()
                            ? Maps{}
                            : Maps{record_.result.joins.back().fixed, record_.result.joins.back().moving};
    std::optional<std::tuple<bool, bool, Maps>> best;
    for (const std::size_t fixed : maps_at(json.at("fixed"))) {
      for (const std::size_t moving : maps_at(json.at("moving"))) {
        const Maps maps{fixed, moving};
        const std::tuple one{fixed > moving, maps <= before, maps};
        if (fixed != moving && (!best || one < *best)) best = one;
      }
    }
    if (!best) json.fail("is of a map and itself");
    return std::get<Maps>(*best);
  }

  Join read_join(const JsonReader& json) const {
    Join join;
    std::tie(join.fixed, join.moving) = pair_of(json);
    join.outcome = one_of(json.at("outcome"),
                          std::array{JoinOutcome::refused, JoinOutcome::accepted, JoinOutcome::rescued,
                                     JoinOutcome::rejected, JoinOutcome::known});
    if (json.at("verdict").text() != name_of(join.verdict()))
      json.at("verdict").fail("does not go with the outcome");
    static_cast<PairPose&>(join) = read_pair_pose(json);
    join.match = read_match(json, join);
    // Where it is known, and not in what earlier versions wrote.
    if (join.used() && json.has("sd")) set_deviation(join, json.at("sd").number_in(0.0, kInfinity));
    const JsonReader reason = json.at("reason");
    const Reason told = reason.is_null() ? Reason::none : read_reason(reason);
    join.over_budget = told == Reason::over_budget && join.outcome == JoinOutcome::refused;
    if (told != join.reason() && json.has("by_themselves")) reason.fail("does not go with the outcome");
    return join;
  }

  static PairPose read_pair_pose(const JsonReader& json) {
    return {json.at("transform").transform(kFarthest), read_share(json.at("probability")),
            read_share(json.at("acceptance_index")),   json.at("agreement").count(),
            json.at("disagreement").count(),           read_share(json.at("overlap"))};
  }

  /// What the two say by themselves. What they have in common is told of the join's pose alone.
  static MatchResult read_match(const JsonReader& json, const PairPose& of_join) {
    MatchResult match;
    static_cast<PairPose&>(match) = of_join;
    match.T_fixed_moving = {};
    match.probability = 0.0;
    // Earlier versions told the reason of the two alone as that of the join.
    const JsonReader own = json.has("by_themselves") ? json.at("by_themselves") : json;
    const JsonReader reason = own.at("reason");
    match.verdict = reason.is_null() ? Verdict::accepted : Verdict::refused;
    match.reason = reason.is_null() ? Reason::none : read_reason(reason);
    if (json.has("by_themselves") && own.at("verdict").text() != name_of(match.verdict))
      own.at("verdict").fail("does not go with the reason");
    const JsonReader hypotheses = json.at("hypotheses");
    for (std::size_t i = 0; i < hypotheses.size(); ++i) {
      const JsonReader hypothesis = hypotheses.at(i);
      match.hypotheses.push_back({hypothesis.at("transform").transform(kFarthest),
                                  hypothesis.at("score").number_in(-kInfinity, kInfinity),
                                  read_share(hypothesis.at("probability"))});
    }
    if (!match.hypotheses.empty()) {
      match.T_fixed_moving = match.hypotheses.front().T_fixed_moving;
      match.probability = match.hypotheses.front().probability;
    }
    return match;
  }

  void read_left_out(const JsonReader& json) {
    const JsonReader maps = json.at("left_out");
    // Earlier versions wrote the reasons alone, in the same order.
    const bool has_objects = json.has("left_out_maps");
    const JsonReader reasons = json.at(has_objects ? "left_out_maps" : "left_out_reasons");
    if (maps.size() != reasons.size()) reasons.fail("does not go with left_out");
    std::vector<LeftOut>& left_out = record_.result.left_out;
    for (std::size_t i = 0; i < maps.size(); ++i) {
      left_out.push_back({place(maps.at(i), i > 0 ? left_out.back().map : 0)});
      if (i > 0 && left_out[i - 1].map > left_out[i].map) maps.at(i).fail("is not in the order of the maps");
    }
    for (std::size_t i = 0; i < maps.size(); ++i) {
      const JsonReader reason = reasons.at(i);
      if (has_objects && reason.at("source").text() != record_.names[left_out[i].map])
        reason.at("source").fail("does not go with left_out");
      left_out[i].reason = read_reason(has_objects ? reason.at("reason") : reason);
    }
  }

  /// Not in what earlier versions wrote. Of equal maps the first.
  void read_open_ways(const JsonReader& json) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      const JsonReader one = json.at(i);
      OpenWay way;
      way.fixed = map_at(one.at("fixed"));
      way.moving = map_at(one.at("moving"));
      if (way.fixed == way.moving) one.fail("is of a map and itself");
      way.T_fixed_moving = one.at("transform").transform(kFarthest);
      way.probability = read_share(one.at("probability"));
      record_.result.open_ways.push_back(way);
    }
  }

  MergeRecord record_;
  std::unordered_map<std::string, std::vector<std::size_t>> named_;  // maps by their name
  std::vector<bool> is_placed_;
};

std::uint64_t fingerprint_of(std::string_view text) {
  return std::hash<std::string_view>()(text);
}

}  // namespace

MergeRecord parse_transforms(const std::filesystem::path& file, std::string_view text) {
  try {
    const nlohmann::json json = parse_json(text);
    MergeRecord record = RecordReader().read(JsonReader(json));
    record.fingerprint = fingerprint_of(text);
    return record;
  } catch (const JsonError& error) {
    throw FileError(file, error.what());
  }
}

MergeRecord read_transforms(const std::filesystem::path& file) {
  FileReader reader(file, NamedBy::file);
  return parse_transforms(file, reader.read_all(kMaxRecordBytes));
}

MergeRecord read_merge_record(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / kTransforms;
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw FileError(directory, "holds no transforms.json: it is not what 'gridmerge merge' has written to");
  return read_transforms(file);
}

std::uint64_t internal::read_fingerprint(const std::filesystem::path& directory) {
  return fingerprint_of(FileReader(directory / kTransforms, NamedBy::file).read_all(kMaxRecordBytes));
}

std::vector<std::size_t> fuse_again(MergeRecord& record, const std::vector<OccupancyGrid>& maps,
                                    const std::filesystem::path& directory) {
  if (maps.size() != record.names.size()) throw std::invalid_argument("there are not as many maps as names");
  std::vector<const OccupancyGrid*> grids;
  grids.reserve(maps.size());
  for (const OccupancyGrid& map : maps) grids.push_back(&map);
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < record.result.components.size(); ++i) {
    Component& component = record.result.components[i];
    const std::filesystem::path file = directory / component_file(i);
    const OccupancyGrid merged = load_map(file, {.regular_files_only = true}).grid;
    const std::vector<std::size_t> places = fused_places(record.result, i, maps);
    try {
      component.fused = fuse_members(component.members, places, grids, merged.resolution);
    } catch (const std::invalid_argument& error) {
      throw FileError(file, std::string("cannot be made again: ") + error.what());
    }
    const OccupancyGrid& fused = component.fused.grid;
    if (fused.width != merged.width || fused.height != merged.height || fused.cells != merged.cells)
      changed.push_back(i);
  }
  return changed;
}

}  // namespace gridmerge
