// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/online/team.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "grid/equal_grids.hpp"
#include "gridmerge/grid/execution.hpp"
#include "online/solver.hpp"

namespace gridmerge {

namespace {

/// A team that nobody asks keeps so many events. Each is a line for people: more than they read at once.
constexpr std::size_t kEventsKept = 1000;
/// Beyond it no wait is distinguishable from one for ever. Added to any time of a clock, it does not
/// overflow.
constexpr std::chrono::hours kLongestWait{365 * 24};

}  // namespace

using namespace internal;

namespace {

/// The answer, but without poses of robots that were forgotten since: they are of maps that are gone.
std::shared_ptr<const TeamAnswer> without_forgotten(std::shared_ptr<const TeamAnswer> answer,
                                                    const News& news) {
  const auto is_forgotten = [&](const RobotStatus& status) {
    const auto found = news.find(status.name);
    return found != news.end() && found->second.is_gone;
  };
  if (std::none_of(answer->robots.begin(), answer->robots.end(), is_forgotten)) return answer;
  auto told = std::make_shared<TeamAnswer>(*answer);
  for (RobotStatus& status : told->robots) {
    if (!is_forgotten(status)) continue;
    const std::string name = std::move(status.name);
    status = {};
    status.name = name;
    status.why = "it was forgotten, and what was heard since is being looked at";
  }
  told->settled = false;
  return told;
}

}  // namespace

void validate(const TeamOptions& options) {
  validate(options.merge);
  if (!(options.search_again >= 0.0 && options.search_again <= 1.0))
    throw std::invalid_argument("search_again must lie in [0, 1]");
  if (options.confirmations < 1) throw std::invalid_argument("confirmations must be at least 1");
  if (options.quiet.count() < 0) throw std::invalid_argument("quiet must not be negative");
  if (options.quiet > kLongestWait) throw std::invalid_argument("quiet must be at most 31536000 s, a year");
  if (options.merge.transform != MapTransform::rigid)
    throw std::invalid_argument(
        "a transform other than rigid is for merge() alone: a team does not bend maps");
  if (options.max_robots < 1) throw std::invalid_argument("max_robots must be at least 1");
}

const char* name_of(RobotState state) {
  switch (state) {
    case RobotState::waiting:
      return "waiting";
    case RobotState::placed:
      return "placed";
    case RobotState::left_out:
      return "left_out";
  }
  return "";
}

MergeResult merge_result(const TeamAnswer& answer) {
  MergeResult result = answer.merge->result;
  for (std::size_t i = 0; i < result.components.size(); ++i)
    result.components[i].fused.grid = *answer.components.at(i).map;
  return result;
}

class __attribute__((visibility("hidden"))) Team::Worker {  // or it is as public as Team
 public:
  Worker(TeamOptions options, OnAnswer on_answer)
      : options_(std::move(options)),
        on_answer_(std::move(on_answer)),
        solver_(options_),
        thread_([this] { work(); }) {}

  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
      is_cancelled_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void hear(const std::string& robot, OccupancyGrid map) {
    validate(map);
    auto shared = std::make_shared<OccupancyGrid>(std::move(map));
    const std::lock_guard lock(mutex_);
    require_room_for(robot);
    const auto [newest, is_first] = newest_.try_emplace(robot, shared);
    if (!is_first && !has_failed_ && are_equal(*newest->second, *shared)) {
      count_repeated(robot);
      return;
    }
    newest->second = shared;
    put_map(robot, std::move(shared), is_first);
  }

  bool hear_part(const std::string& robot, int column, int row, const OccupancyGrid& part) {
    validate(part);
    const std::lock_guard lock(mutex_);
    const auto newest = newest_.find(robot);
    if (newest == newest_.end()) return false;
    const OccupancyGrid& whole = *newest->second;
    if (column < 0 || row < 0 || part.width > whole.width - column || part.height > whole.height - row)
      return false;
    if (!has_failed_ && has_drawn(part, column, row, whole)) {
      count_repeated(robot);
      return true;
    }
    // The solver may be at work on what it was given; what still lies in the inbox is ours, but a known pose
    // may be of the map as it was.
    const auto waiting = news_.find(robot);
    const bool is_ours = waiting != news_.end() && waiting->second.map == newest->second &&
                         waiting->second.map_of_pose != newest->second;
    auto map = is_ours ? newest->second : std::make_shared<OccupancyGrid>(whole);
    draw(part, column, row, *map);
    newest->second = map;
    put_map(robot, std::move(map), false);
    return true;
  }

  void forget(const std::string& robot) {
    const std::lock_guard lock(mutex_);
    newest_.erase(robot);
    known_.erase(robot);
    RobotNews news;
    news.is_gone = true;
    put(robot, std::move(news));
    answer_ = without_forgotten(std::move(answer_), news_);
  }

  void set_known_pose(const std::string& robot, std::optional<KnownPose> known_pose) {
    if (known_pose) validate(*known_pose);
    const std::lock_guard lock(mutex_);
    require_room_for(robot);
    RobotNews news;
    news.known_pose = known_pose;
    put(robot, std::move(news));
  }

  void hear_age(const std::string& robot, TeamTime heard_first) {
    const std::lock_guard lock(mutex_);
    if (!newest_.contains(robot)) return;  // until it is heard here its age plays no role
    RobotNews news;
    news.since = heard_first;
    put(robot, std::move(news));
  }

  std::shared_ptr<const TeamAnswer> answer() const {
    const std::lock_guard lock(mutex_);
    return answer_;
  }

  std::vector<TeamEvent> take_events() {
    const std::lock_guard lock(mutex_);
    std::vector<TeamEvent> events(events_.begin(), events_.end());
    events_.clear();
    return events;
  }

  bool wait_until_settled(std::chrono::milliseconds longest) const {
    std::unique_lock lock(mutex_);
    const auto wait = std::clamp<std::chrono::milliseconds>(longest, {}, kLongestWait);
    return changed_.wait_for(lock, wait, [&] { return news_.empty() && !is_at_work_ && answer_->settled; });
  }

  bool is_at_rest() const {
    const std::lock_guard lock(mutex_);
    return !has_news_ && !is_at_work_ && !has_unfinished_ && is_all_done_;
  }

 private:
  static bool has_drawn(const OccupancyGrid& part, int column, int row, const OccupancyGrid& map) {
    if (!part.probability.empty() || !map.probability.empty()) return false;  // seldom, and then it is drawn
    for (int y = 0; y < part.height; ++y) {
      const Cell* const cells = &part.cells[part.index(0, y)];
      if (!std::equal(cells, cells + part.width, &map.cells[map.index(column, row + y)])) return false;
    }
    return true;
  }

  static void draw(const OccupancyGrid& part, int column, int row, OccupancyGrid& map) {
    if (part.probability.empty()) map.probability.clear();
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        const std::size_t to = map.index(column + x, row + y), from = part.index(x, y);
        map.cells[to] = part.cells[from];
        if (!map.probability.empty()) map.probability[to] = part.probability[from];
      }
    }
  }

  // The following ones with mutex_ held.

  void require_room_for(const std::string& robot) {
    if (known_.contains(robot)) return;
    if (known_.size() >= options_.max_robots)
      throw std::invalid_argument("there are already " + std::to_string(options_.max_robots) +
                                  " robots: " + robot + " is one too many");
    known_.insert(robot);
  }

  void put_map(const std::string& robot, std::shared_ptr<const OccupancyGrid> map, bool is_first) {
    RobotNews news;
    news.map = std::move(map);
    news.maps_heard = 1;
    // Once: a clock that is set back later makes nobody older.
    if (is_first) news.since = std::chrono::system_clock::now();
    put(robot, std::move(news));
  }

  /// Nothing follows from what was there already: it neither ends what is at work nor puts off a search of
  /// all. Where the work on it failed it is worth another try instead: there may be memory now.
  void count_repeated(const std::string& robot) {
    ++news_[robot].maps_heard;
    changed_.notify_all();
  }

  void put(const std::string& robot, RobotNews news) {
    add_news(news_[robot], std::move(news));
    has_news_ = true;
    heard_ = std::chrono::steady_clock::now();
    // Work on older maps ends; but not twice in a row, so that answers come however often maps do.
    if (is_at_work_ && may_be_cancelled_) is_cancelled_ = true;
    changed_.notify_all();
  }

  void keep_events(const std::vector<TeamEvent>& events) {
    events_.insert(events_.end(), events.begin(), events.end());
    while (events_.size() > kEventsKept) events_.pop_front();
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
      // What failed would fail again: once more in full, when all is quiet, is enough.
      const bool goes_further = !has_news_ && !has_unfinished_ && !has_failed_ && !solver_.is_complete();
      if (!has_news_ && !has_unfinished_ && !goes_further) {
        const auto wakes = [&] { return ends_ || !news_.empty(); };
        if (is_all_done_) {
          changed_.wait(lock, wakes);
        } else {
          changed_.wait_until(lock, heard_ + options_.quiet, wakes);
        }
        if (ends_) return;
      }
      const bool is_idle = !has_news_ && !has_unfinished_ && !goes_further;
      const bool is_quiet =
          is_idle && !is_all_done_ && std::chrono::steady_clock::now() >= heard_ + options_.quiet;
      News news = std::exchange(news_, {});
      has_news_ = false;
      is_at_work_ = true;
      is_cancelled_ = false;
      lock.unlock();
      using Effort = TeamSolver::Effort;
      const Effort effort = is_quiet ? Effort::full : goes_further ? Effort::further : Effort::soon;
      std::shared_ptr<const TeamAnswer> answer = solve(std::move(news), effort);
      lock.lock();
      may_be_cancelled_ = answer != nullptr;
      has_unfinished_ = !answer;
      if (answer) {
        has_failed_ = !answer->problem.empty();
        is_all_done_ = answer->settled || is_quiet || (is_all_done_ && is_idle);
        // Where nothing differs but how often robots were heard, it is the answer before.
        const bool is_new = answer->number != answer_->number || answer->problem != answer_->problem;
        if (is_new) keep_events(answer->events);
        answer = without_forgotten(std::move(answer), news_);
        answer_ = answer;
        if (is_new && on_answer_) {  // by now answer() and take_events() have what it is given
          lock.unlock();
          on_answer_(answer);
          lock.lock();
        }
      }
      is_at_work_ = false;
      changed_.notify_all();
    }
  }

  /// Null when it was cancelled.
  std::shared_ptr<const TeamAnswer> solve(News news, TeamSolver::Effort effort) {
    auto answer = std::make_shared<TeamAnswer>();
    try {
      solver_.take(std::move(news));
      with_cancellation(is_cancelled_, [&] { *answer = solver_.solve(effort); });
    } catch (const Cancelled&) {
      return nullptr;
    } catch (const std::exception& error) {  // no memory for it
      *answer = *this->answer();
      answer->events.clear();
      answer->settled = false;
      answer->problem = error.what();
    }
    return answer;
  }

  const TeamOptions options_;
  const OnAnswer on_answer_;
  TeamSolver solver_;  // the thread's own

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  News news_;
  std::map<std::string, std::shared_ptr<OccupancyGrid>> newest_;
  std::deque<TeamEvent> events_;  // not taken yet
  std::set<std::string> known_;   // robots that were named
  std::chrono::steady_clock::time_point heard_ = std::chrono::steady_clock::now();
  std::shared_ptr<const TeamAnswer> answer_ = std::make_shared<const TeamAnswer>();
  bool ends_ = false, is_at_work_ = false, may_be_cancelled_ = true, has_unfinished_ = false,
       has_failed_ = false;
  bool has_news_ = false;    // of which more is known than how often robots were heard
  bool is_all_done_ = true;  // until something is heard
  std::atomic<bool> is_cancelled_ = false;

  std::thread thread_;  // last: it uses all of the above
};

Team::Team(TeamOptions options, OnAnswer on_answer) {
  validate(options);
  worker_ = std::make_unique<Worker>(std::move(options), std::move(on_answer));
}

Team::~Team() = default;

void Team::hear(const std::string& robot, OccupancyGrid map) {
  worker_->hear(robot, std::move(map));
}

bool Team::hear_part(const std::string& robot, int column, int row, const OccupancyGrid& part) {
  return worker_->hear_part(robot, column, row, part);
}

void Team::hear_age(const std::string& robot, TeamTime heard_first) {
  worker_->hear_age(robot, heard_first);
}

void Team::forget(const std::string& robot) {
  worker_->forget(robot);
}

void Team::set_known_pose(const std::string& robot, std::optional<KnownPose> known_pose) {
  worker_->set_known_pose(robot, known_pose);
}

std::shared_ptr<const TeamAnswer> Team::answer() const {
  return worker_->answer();
}

std::vector<TeamEvent> Team::take_events() {
  return worker_->take_events();
}

bool Team::wait_until_settled(std::chrono::milliseconds longest) const {
  return worker_->wait_until_settled(longest);
}

bool Team::is_at_rest() const {
  return worker_->is_at_rest();
}

}  // namespace gridmerge
