// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/online/team.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "merge.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

using Answer = std::shared_ptr<const TeamAnswer>;

/// A component, with the answer that it is part of.
struct ComponentOf {
  Answer answer;
  std::size_t index = 0;

  const TeamComponent& component() const { return answer->components[index]; }
};

/// An answer that Python holds: its maps are not copied.
struct HeldAnswer {
  Answer answer;
};

std::vector<ComponentOf> components_of(const HeldAnswer& held) {
  std::vector<ComponentOf> components;
  for (std::size_t i = 0; i < held.answer->components.size(); ++i) components.push_back({held.answer, i});
  return components;
}

/// Of the clocks' time, which ends after 292 years. Throws std::invalid_argument beyond 285 years.
std::chrono::duration<double> time_of(const char* name, double seconds) {
  constexpr double kMost = 9e9;
  if (!(std::abs(seconds) <= kMost))
    throw std::invalid_argument(std::string(name) + ": must lie within 9e9 s");
  return std::chrono::duration<double>(seconds);
}

class PythonTeam {
 public:
  explicit PythonTeam(const TeamOptions& options) : team_(std::make_unique<Team>(options)) {}
  PythonTeam(const PythonTeam&) = delete;
  PythonTeam& operator=(const PythonTeam&) = delete;
  ~PythonTeam() {
    // It would wait for a thread that a forked process does not have.
    if (fork_count() != made_after_forks_) (void)team_.release();
  }

  // Without the interpreter's lock: a map takes a while to copy.
  void hear(const nb::bytes& robot, const Map& map) {
    const std::string name = to_string(robot);
    const OthersRun meanwhile;
    team().hear(name, *map.grid);
  }

  bool hear_part(const nb::bytes& robot, int column, int row, const Map& part) {
    const std::string name = to_string(robot);
    const OthersRun meanwhile;
    return team().hear_part(name, column, row, *part.grid);
  }

  void hear_age(const nb::bytes& robot, double seconds) {
    const auto since = time_of("heard_first", seconds);
    team().hear_age(to_string(robot), TeamTime(std::chrono::duration_cast<TeamTime::duration>(since)));
  }

  void forget(const nb::bytes& robot) { team().forget(to_string(robot)); }

  void set_known_pose(const nb::bytes& robot, const std::optional<Known>& known) {
    team().set_known_pose(to_string(robot), to_known_pose(known));
  }

  std::vector<TeamEvent> take_events() { return team().take_events(); }

  Answer answer() const { return team().answer(); }

  /// With the robots' names.
  std::pair<Merged, std::vector<nb::str>> merged() const {
    Merged merged;
    const Answer answer = team().answer();
    {
      const OthersRun meanwhile;
      for (const auto& map : answer->merge->maps) merged.maps.push_back({map, {}, {}});
      merged.result = std::make_shared<const MergeResult>(merge_result(*answer));
    }
    return {std::move(merged), to_strs(answer->merge->names)};
  }

  bool wait_until_settled(double seconds) const {
    const auto longest = std::chrono::duration_cast<std::chrono::milliseconds>(time_of("seconds", seconds));
    const OthersRun meanwhile;
    return team().wait_until_settled(longest);
  }

 private:
  Team& team() const {
    if (fork_count() != made_after_forks_)
      throw std::runtime_error("the Team is in the process that this one was forked from: make another one");
    return *team_;
  }

  int made_after_forks_ = fork_count();
  std::unique_ptr<Team> team_;
};

double seconds_of(TeamTime time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

const char* name_of(TeamEvent::Kind kind) {
  switch (kind) {
    case TeamEvent::Kind::joined:
      return "joined";
    case TeamEvent::Kind::left:
      return "left";
    case TeamEvent::Kind::jumped:
      return "jumped";
    case TeamEvent::Kind::restarted:
      return "restarted";
    case TeamEvent::Kind::renumbered:
      return "renumbered";
  }
  return "";
}

}  // namespace

void bind_team(nb::module_& module) {
  nb::class_<TeamOptions>(module, "TeamOptions")
      .def(nb::init<>())
      .def_prop_rw(
          "threads", [](const TeamOptions& options) { return options.merge.match.threads; },
          [](TeamOptions& options, int threads) { options.merge.match.threads = threads; })
      .def_prop_rw(
          "accept", [](const TeamOptions& options) { return options.merge.match.accept_probability; },
          [](TeamOptions& options, double accept) { options.merge.match.accept_probability = accept; })
      .def_prop_rw(
          "max_false_joins", [](const TeamOptions& options) { return options.merge.max_false_joins; },
          [](TeamOptions& options, double joins) { options.merge.max_false_joins = joins; })
      .def_prop_rw(
          "output_resolution", [](const TeamOptions& options) { return options.merge.resolution; },
          [](TeamOptions& options, double resolution) { options.merge.resolution = resolution; })
      .def_prop_rw(
          "quiet",
          [](const TeamOptions& options) { return std::chrono::duration<double>(options.quiet).count(); },
          [](TeamOptions& options, double seconds) {
            options.quiet = std::chrono::duration_cast<std::chrono::milliseconds>(time_of("quiet", seconds));
          })
      .def(
          "set_search",
          [](TeamOptions& options, const std::string& search) {
            set_search(options.merge.match, search, std::nullopt);
          },
          nb::arg("search"))
      .def_rw("search_again", &TeamOptions::search_again)
      .def_rw("confirmations", &TeamOptions::confirmations)
      .def_rw("max_robots", &TeamOptions::max_robots);
  nb::class_<RobotStatus>(module, "RobotStatus")
      .def_prop_ro("name", [](const RobotStatus& robot) { return to_str(robot.name); })
      .def_prop_ro("state", [](const RobotStatus& robot) { return gridmerge::name_of(robot.state); })
      .def_prop_ro("reason", [](const RobotStatus& robot) { return gridmerge::name_of(robot.reason); })
      .def_prop_ro("why", [](const RobotStatus& robot) { return to_str(robot.why); })
      .def_ro("component", &RobotStatus::component)
      .def_prop_ro("transform", [](const RobotStatus& robot) { return to_pose(robot.T_world_map); })
      .def_ro("probability", &RobotStatus::probability)
      .def_ro("maps_heard", &RobotStatus::maps_heard)
      .def_ro("has_known_pose", &RobotStatus::has_known_pose)
      .def_prop_ro("heard_first", [](const RobotStatus& robot) { return seconds_of(robot.heard_first); });
  nb::class_<TeamEvent>(module, "TeamEvent")
      .def_prop_ro("kind", [](const TeamEvent& event) { return name_of(event.kind); })
      .def_prop_ro("robot", [](const TeamEvent& event) { return to_str(event.robot); })
      .def_prop_ro("text", [](const TeamEvent& event) { return to_str(event.text); });
  nb::class_<ComponentOf>(module, "TeamComponent")
      .def_prop_ro("number", [](const ComponentOf& one) { return one.component().number; })
      .def_prop_ro("anchor", [](const ComponentOf& one) { return to_str(one.component().anchor); })
      .def_prop_ro("robots", [](const ComponentOf& one) { return to_strs(one.component().robots); })
      .def_prop_ro("map", [](const ComponentOf& one) {
        return Map{one.component().map, {}, {}};
      });
  nb::class_<HeldAnswer>(module, "TeamAnswer")
      .def_prop_ro("number", [](const HeldAnswer& held) { return held.answer->number; })
      .def_prop_ro("robots", [](const HeldAnswer& held) { return held.answer->robots; })
      .def_prop_ro("events", [](const HeldAnswer& held) { return held.answer->events; })
      .def_prop_ro("components", &components_of)
      .def_prop_ro("seconds", [](const HeldAnswer& held) { return held.answer->seconds; })
      .def_prop_ro("settled", [](const HeldAnswer& held) { return held.answer->settled; })
      .def_prop_ro("problem", [](const HeldAnswer& held) { return to_str(held.answer->problem); });
  nb::class_<PythonTeam>(module, "Team")
      .def(nb::init<const TeamOptions&>(), nb::arg("options"))
      .def("hear", &PythonTeam::hear, nb::arg("robot"), nb::arg("map"))
      .def("hear_part", &PythonTeam::hear_part, nb::arg("robot"), nb::arg("column"), nb::arg("row"),
           nb::arg("part"))
      .def("hear_age", &PythonTeam::hear_age, nb::arg("robot"), nb::arg("seconds"))
      .def("forget", &PythonTeam::forget, nb::arg("robot"))
      .def("set_known_pose", &PythonTeam::set_known_pose, nb::arg("robot"), nb::arg("known").none())
      .def("answer", [](const PythonTeam& team) { return HeldAnswer{team.answer()}; })
      .def("merged", &PythonTeam::merged)
      .def("take_events", &PythonTeam::take_events)
      .def("wait_until_settled", &PythonTeam::wait_until_settled, nb::arg("seconds"));
}

}  // namespace gridmerge::python
