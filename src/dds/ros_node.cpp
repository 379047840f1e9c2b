// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/dds/ros_node.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <utility>

#include "dds/ages.hpp"
#include "dds/entity.hpp"
#include "dds/environment.hpp"
#include "dds/listener.hpp"
#include "dds/map_times.hpp"
#include "dds/message.hpp"
#include "dds/network.hpp"
#include "dds/node_log.hpp"
#include "dds/options.hpp"
#include "dds/participant.hpp"
#include "dds/player.hpp"
#include "dds/publisher.hpp"
#include "dds/selection.hpp"
#include "dds/status.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

using namespace internal;

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kTick{100};                 // transforms on /tf, and looks at the clock
constexpr milliseconds kDiagnosesEvery{1000};      // as ROS's own tools expect
constexpr milliseconds kDiagnosesApart{250};       // however fast answers come
constexpr milliseconds kNetworkEvery{1000};        // looks at the machine's addresses
constexpr milliseconds kQuiet{3000};               // `once`: so long nothing new has come up
constexpr milliseconds kFlush{5000};               // `once`: so long subscribers may take
constexpr double kWaitOnce = 10.0;                 // `once`: for a first map, and for robots to come [s]
constexpr double kRemindAfter = 10.0;              // without `wait`: then it is said what is waited for [s]
constexpr std::uint64_t kHeadOfMessage = 1 << 16;  // beside the cells
constexpr std::uint64_t kLargestMessage = kMaxGridCells + kHeadOfMessage;

}  // namespace

class __attribute__((visibility("hidden"))) RosNode::State {  // or it is as public as RosNode
 public:
  explicit State(RosNodeOptions options)
      : options_(completed(std::move(options))),
        selection_(select(options_)),
        environment_(read_ros_environment(process_environment, options_.enclave)),
        network_(network_addresses()),
        participant_(std::in_place, environment_, kLargestMessage, network_.begun_with()),
        waitset_(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "a wait set"),
        wake_(dds_create_guardcondition(DDS_CYCLONEDDS_HANDLE), "a guard condition"),
        deaf_waitset_(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "a wait set"),
        publisher_(std::in_place, *participant_, options_),
        player_(*participant_, options_.played, options_.play_rate, options_.warn),
        listener_(*participant_, waitset_.get(), selection_, callbacks()),
        ages_(std::in_place, *participant_),
        team_(options_.team, [this](const std::shared_ptr<const TeamAnswer>&) { wake(); }) {
    for (const DdsEntity* waitset : {&waitset_, &deaf_waitset_})
      require_dds(dds_waitset_attach(waitset->get(), wake_.get(), 0), "waiting for answers");
    for (const auto& [robot, pose] : options_.known_poses) team_.set_known_pose(robot, pose);
    publish_node();
  }

  End run();

  void stop() {
    stopped_ = true;
    wake();
  }

  std::string describe() const { return describe_team(*team_.answer(), listener_.robots()); }

 private:
  MapListener::Callbacks callbacks();
  void take_map(const std::string& robot, HeardMap map, bool restarted);
  void look_at_network();
  void begin_anew();
  bool play();
  void count_restart(const std::string& robot);
  void hear_ages();
  void wait();
  void tell_changes();
  void publish();
  void publish_diagnoses(const TeamAnswer& answer);
  void publish_node();
  void check_wait();
  std::optional<End> check_once();
  bool is_complete() const;

  void wake() { dds_set_guardcondition(wake_.get(), true); }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
  bool has_maps() const {
    const std::vector<HeardRobot> robots = listener_.robots();
    return std::any_of(robots.begin(), robots.end(), [](const HeardRobot& robot) { return robot.maps > 0; });
  }

  RosNodeOptions options_;
  RobotSelection selection_;
  RosEnvironment environment_;
  NetworkWatch network_;
  std::optional<Participant> participant_;  // as the others, made anew for another network
  DdsEntity waitset_;                       // these three stay: the team's thread wakes the node
  DdsEntity wake_;
  DdsEntity deaf_waitset_;  // wakes for the team alone, not for what is heard
  std::optional<Publisher> publisher_;
  Player player_;
  MapListener listener_;
  std::optional<AgeListener> ages_;
  MapTimes times_;
  std::map<std::string, TeamTime> told_ages_;  // to the team, of each robot
  std::atomic<bool> stopped_{false};
  Clock::time_point began_ = Clock::now();
  Clock::time_point news_at_ = began_;
  Clock::time_point next_tick_ = began_;
  Clock::time_point next_diagnoses_ = began_;
  Clock::time_point diagnosed_ = began_ - kDiagnosesEvery;
  Clock::time_point next_look_ = began_;
  std::uint64_t news_ = 0;
  std::uint64_t told_answer_ = 0;
  std::set<std::string> introduced_;  // robots whose first map was told
  std::map<std::string, Restarts> restarts_;
  std::uint64_t undecodable_ = 0;  // of participants before
  NodeLog log_{options_.tell, options_.warn};
  bool all_sent_ = true;
  bool reminded_ = false;
  bool enough_ = false;  // `once`: what is heard is what is merged
  Team team_;            // last: its thread uses what is above
};

MapListener::Callbacks RosNode::State::callbacks() {
  return {[this](const std::string& robot, HeardMap map, bool restarted) {
            take_map(robot, std::move(map), restarted);
          },
          [this](const std::string& robot, const HeardPart& part) {
            const bool fits = team_.hear_part(robot, part.x, part.y, part.grid);
            if (fits) times_.hear_part(robot, part.stamp);
            return fits;
          },
          [this](const std::string& kind, const std::string& text) { log_.warn(kind, text); }};
}

void RosNode::State::take_map(const std::string& robot, HeardMap map, bool restarted) {
  const std::string content = fmt::format("{} x {} cells of {:.4g} m in the frame {}", map.grid.width,
                                          map.grid.height, map.grid.resolution, map.frame);
  const auto known = options_.known_poses.find(robot);
  if (restarted) {
    // What was known of the old frame says nothing of the new one, whatever its name.
    team_.forget(robot);
    times_.forget(robot);
    team_.set_known_pose(robot, std::nullopt);
    log_.tell("anew " + robot, fmt::format("{}: started anew: {}", robot, content));
    count_restart(robot);
    if (known != options_.known_poses.end()) {
      log_.warn("pose " + robot,
                fmt::format("{}: started anew, so that the pose given for it holds no longer", robot));
      options_.known_poses.erase(known);
    }
  } else if (introduced_.insert(robot).second) {
    log_.tell("first map " + robot, fmt::format("{}: first map: {}", robot, content));
  }
  try {
    team_.hear(robot, std::move(map.grid));
    times_.hear_map(robot, map.stamp);
  } catch (const std::invalid_argument& error) {
    throw RefusedMessage(error.what());
  }
}

void RosNode::State::count_restart(const std::string& robot) {
  Restarts& restarts = restarts_[robot];
  const Clock::time_point now = Clock::now();
  restarts.count(now);
  if (!restarts.are_many(now)) return;
  const std::vector<HeardRobot> robots = listener_.robots();
  const auto heard =
      std::find_if(robots.begin(), robots.end(), [&](const HeardRobot& one) { return one.name == robot; });
  if (heard != robots.end())
    log_.warn("many restarts " + robot, robot + ": " + say_many_restarts(heard->topic));
}

RosNode::End RosNode::State::run() {
  began_ = Clock::now();
  news_at_ = began_;
  options_.tell(fmt::format(
      "hears {} in domain {}{}, and publishes {}", selection_.describe(), environment_.domain,
      environment_.enclave_files.empty() ? "" : fmt::format(", secure as {}", environment_.enclave),
      options_.output));
  while (!stopped_) {
    look_at_network();
    if (!play()) break;
    wait();
    if (!enough_) listener_.hear();
    hear_ages();
    tell_changes();
    publish();
    check_wait();
    if (const std::optional<End> end = check_once()) return *end;
  }
  return End::stopped;
}

void RosNode::State::look_at_network() {
  if (Clock::now() < next_look_) return;
  next_look_ = Clock::now() + kNetworkEvery;
  switch (network_.look(network_addresses())) {
    case NetworkWatch::Change::none:
      return;
    case NetworkWatch::Change::gone:
      return log_.warn("network is gone",
                       "the network is gone: other machines are not heard until it is back");
    case NetworkWatch::Change::replaced:
      log_.tell("network is replaced",
                "this machine has other addresses in the network: the node joins it anew");
      return begin_anew();
  }
}

/// Cyclone DDS never looks again at the network that it began with. What was heard is kept.
void RosNode::State::begin_anew() {
  log_.warn_of_dds(participant_->take_log());  // which goes with it
  undecodable_ += participant_->undecodable();
  ages_.reset();
  listener_.leave();
  player_.leave();
  publisher_.reset();
  participant_.reset();
  participant_.emplace(environment_, kLargestMessage, network_.begun_with());
  publisher_.emplace(*participant_, options_);
  player_.join(*participant_);
  listener_.join(*participant_);
  ages_.emplace(*participant_);
  all_sent_ = false;
}

/// False where it was stopped meanwhile: a recording may be long, or made to be.
bool RosNode::State::play() {
  try {
    with_cancellation(stopped_, [this] { player_.play(seconds()); });
    return true;
  } catch (const Cancelled&) {
    return false;
  }
}

void RosNode::State::hear_ages() {
  for (const RobotAge& age : ages_->take()) listener_.hear_age(age);
  for (const HeardRobot& robot : listener_.robots()) {
    if (robot.maps == 0) continue;
    TeamTime& told = told_ages_[robot.name];
    if (told == robot.heard_first) continue;
    told = robot.heard_first;
    team_.hear_age(robot.name, told);
  }
}

void RosNode::State::wait() {
  const std::chrono::nanoseconds longest = std::max(next_tick_ - Clock::now(), Clock::duration(0));
  // What is not taken any more would wake the node on and on.
  const DdsEntity& waitset = enough_ ? deaf_waitset_ : waitset_;
  require_dds(dds_waitset_wait(waitset.get(), nullptr, 0, longest.count()), "waiting");
  bool was_set = false;
  dds_take_guardcondition(wake_.get(), &was_set);
}

void RosNode::State::tell_changes() {
  log_.warn_of_dds(participant_->take_log());
  log_.tell_gone(listener_.robots());
  log_.tell_more();
  if (listener_.news() == news_) return;
  news_ = listener_.news();
  news_at_ = Clock::now();
}

void RosNode::State::publish() {
  const std::shared_ptr<const TeamAnswer> answer = team_.answer();
  const std::vector<HeardRobot> robots = listener_.robots();
  const bool is_new = answer->number != told_answer_;
  if (is_new) {
    told_answer_ = answer->number;
    const std::vector<TeamEvent> events = team_.take_events();
    log_.tell_events(events);
    for (const TeamEvent& event : events)
      if (event.kind == TeamEvent::Kind::restarted) count_restart(event.robot);
    for (const RobotStatus& robot : answer->robots)  // of a pose that was lost its event has told
      if (!robot.has_known_pose) options_.known_poses.erase(robot.name);
    options_.detail(fmt::format("answer {}: {:.3f} s, {} merged maps of {} robots{}", answer->number,
                                answer->seconds, answer->components.size(), answer->robots.size(),
                                answer->problem.empty() ? "" : "; " + answer->problem));
    if (options_.answered) options_.answered(answer);
  }
  if (is_new || !all_sent_) all_sent_ = publisher_->publish_maps(*answer, times_.newest_of(*answer));
  const TeamTransforms transforms = team_transforms(*answer, robots, options_.world_frame);
  const Clock::time_point now = Clock::now();
  const bool is_tick = now >= next_tick_;
  if (is_tick) next_tick_ = std::max(next_tick_ + kTick, now);
  if (is_tick || options_.transforms == TransformTopic::tf_static)
    publisher_->publish_transforms(transforms.transforms);
  log_.warn_of_withheld(transforms.withheld);
  publish_node();
  if (is_new) next_diagnoses_ = std::min(next_diagnoses_, diagnosed_ + kDiagnosesApart);
  if (Clock::now() >= next_diagnoses_) publish_diagnoses(*answer);
}

void RosNode::State::publish_diagnoses(const TeamAnswer& answer) {
  const std::vector<HeardRobot> robots = listener_.robots();
  publisher_->publish_diagnoses(diagnose(answer, robots,
                                         team_transforms(answer, robots, options_.world_frame),
                                         {options_.name, undecodable_ + participant_->undecodable(),
                                          listener_.over_limit(), log_.dds_warnings(), restarts_}));
  diagnosed_ = Clock::now();
  next_diagnoses_ = diagnosed_ + kDiagnosesEvery;
}

void RosNode::State::publish_node() {
  std::vector<dds_guid_t> readers = listener_.readers();
  readers.push_back(guid_of(ages_->reader()));
  publisher_->publish_node(readers, player_.writers());
}

void RosNode::State::check_wait() {
  const bool is_bounded = options_.wait || options_.once;
  const double most = options_.wait.value_or(options_.once ? kWaitOnce : kRemindAfter);
  if (reminded_ || seconds() < most) return;
  reminded_ = true;
  if (has_maps()) return;
  const std::string text =
      fmt::format("no map within {:.3g} s: waiting for {} in domain {}; {}", most, selection_.describe(),
                  environment_.domain, explain_silence(listener_.robots(), listener_.near_misses()));
  if (is_bounded) throw std::runtime_error(text);
  options_.warn(text);
}

/// `once`: whether every robot that is to be heard was.
bool RosNode::State::is_complete() const {
  const std::vector<HeardRobot> robots = listener_.robots();
  const auto has_sent = [](const HeardRobot& robot) { return robot.maps > 0; };
  for (const auto& [name, topic] : selection_.named()) {
    const bool is_heard = std::any_of(
        robots.begin(), robots.end(),
        [&, topic = topic](const HeardRobot& robot) { return robot.topic == topic && has_sent(robot); });
    if (!is_heard) return false;
  }
  return robots.size() > 1 && player_.is_over() && std::all_of(robots.begin(), robots.end(), has_sent);
}

std::optional<RosNode::End> RosNode::State::check_once() {
  if (!options_.once || !has_maps() || !all_sent_) return std::nullopt;
  const bool is_over = player_.is_over() && seconds() >= options_.wait.value_or(kWaitOnce);
  // From now on nothing newer is heard: robots that map on would keep the team from ever being settled.
  enough_ = enough_ || is_over || (is_complete() && Clock::now() - news_at_ >= kQuiet);
  if (!enough_ || !team_.is_at_rest()) return std::nullopt;
  const std::shared_ptr<const TeamAnswer> answer = team_.answer();
  if (answer->number != told_answer_) return std::nullopt;  // it is published first
  publish_diagnoses(*answer);                               // who listens is told how it ended
  publisher_->flush(kFlush);
  if (!answer->problem.empty()) throw std::runtime_error("the maps cannot be merged: " + answer->problem);
  const bool all =
      answer->components.size() == 1 && answer->components.front().robots.size() == answer->robots.size();
  return all ? End::merged : End::refused;
}

RosNode::RosNode(RosNodeOptions options) : state_(std::make_unique<State>(std::move(options))) {}

RosNode::~RosNode() = default;

RosNode::End RosNode::run() {
  return state_->run();
}

void RosNode::stop() {
  state_->stop();
}

std::string RosNode::describe() const {
  return state_->describe();
}

}  // namespace gridmerge
