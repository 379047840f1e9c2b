// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merger.hpp"

#include <map>
#include <utility>

#include "cache.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "merge.hpp"
#include "rounds.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

/// A Merger that keeps its maps. One thread at a time may use it, which the package sees to: most of it runs
/// without the interpreter's lock.
class MapMerger {
 public:
  MapMerger(int threads, double accept, double max_false_joins, double max_missed, double output_resolution,
            const std::string& transform, const std::string& search)
      : merger_(make_options(threads, accept, max_false_joins, max_missed, output_resolution, transform,
                             search, progress_)) {}

  std::size_t add(const Map& map, const std::optional<Known>& known) {
    std::optional<std::size_t> id;
    try {
      run_in_worker(nb::none(),
                    [&](const Report& /*report*/) { id = merger_.add(*map.grid, to_known_pose(known)); });
    } catch (...) {
      if (id) merger_.remove(*id);  // an interrupt that came too late to cancel it
      throw;
    }
    maps_.emplace(*id, map);
    return *id;
  }

  void update(std::size_t id, const Map& map) { replace(id, map, &Merger::update); }

  void grow(std::size_t id, const Map& map) { replace(id, map, &Merger::grow); }

  void search_again(std::size_t id) { merger_.search_again(id); }

  void remove(std::size_t id) {
    merger_.remove(id);
    maps_.erase(id);
  }

  /// These maps and no others, where an interrupt came between this and what Python knows of it.
  void keep(const std::vector<std::pair<std::size_t, Map>>& wanted) {
    std::map<std::size_t, Map> others = maps_;
    for (const auto& [id, map] : wanted) others.erase(id);
    for (const auto& [id, map] : others) remove(id);
    for (const auto& [id, map] : wanted) {
      if (maps_.at(id).grid != map.grid) update(id, map);
    }
  }

  /// Fixed, moving, search.
  using Due = std::tuple<std::size_t, std::size_t, std::string>;

  /// The matches that solve() would make next.
  std::vector<Due> due() {
    const std::vector<DueMatch> due =
        compute_in_worker(nb::none(), [&](const Report& /*report*/) { return merger_.due(); });
    std::vector<Due> told;
    told.reserve(due.size());
    for (const DueMatch& one : due) told.emplace_back(one.fixed, one.moving, name_of(one.search));
    return told;
  }

  void hand_in(std::size_t fixed, std::size_t moving, const std::string& search, const nb::bytes& match) {
    merger_.hand_in({fixed, moving, search_method(search).value()}, match_from_bytes(to_string(match)));
  }

  /// What hand_in() takes.
  std::vector<std::tuple<std::size_t, std::size_t, std::string, nb::bytes>> matches() const {
    std::vector<std::tuple<std::size_t, std::size_t, std::string, nb::bytes>> told;
    for (const auto& [made, match] : merger_.matches())
      told.emplace_back(made.fixed, made.moving, name_of(made.search), to_nb_bytes(to_bytes(match)));
    return told;
  }

  /// Of the matches that are due: the probability from which on maps are joined, and how many hypotheses are
  /// kept.
  std::pair<double, std::size_t> match_options() const {
    const MatchOptions options = merger_.match_options(SearchMethod::exhaustive);
    return {options.accept_probability, options.max_hypotheses};
  }

  /// Before matches that the cache lacks are made elsewhere.
  void warn_of_other_shards(Cache& cache) const {
    const OthersRun meanwhile;
    gridmerge::warn_of_other_shards(merger_, cache.matches());
  }

  /// With a cache, matches are those that it has, or are kept there.
  Merged solve(Cache* cache, const nb::object& progress) {
    MergeResult result = compute_in_worker(progress, [&](const Report& report) {
      *progress_ = [&report, rounds = RoundsShare()](std::size_t done, std::size_t total) mutable {
        report(rounds.of(done, total));
      };
      if (cache != nullptr) match_with_cache(*cache);
      return merger_.solve();
    });
    std::vector<Map> maps;
    maps.reserve(maps_.size());
    for (const auto& [id, map] : maps_) maps.push_back(map);
    return {std::move(maps), std::make_shared<const MergeResult>(std::move(result))};
  }

 private:
  using Progress = std::function<void(std::size_t, std::size_t)>;

  void match_with_cache(Cache& cache) {
    MatchWorkOptions work;
    work.progress = *progress_;
    const MatchWork done = gridmerge::match_with_cache(merger_, cache.matches(), work);
    cache.count(done.found, done.made);
  }

  void replace(std::size_t id, const Map& map, void (Merger::*put)(Merger::MapId, OccupancyGrid)) {
    bool is_replaced = false;
    try {
      run_in_worker(nb::none(), [&](const Report& /*report*/) {
        (merger_.*put)(id, *map.grid);
        is_replaced = true;
      });
    } catch (...) {
      if (is_replaced) merger_.update(id, *maps_.at(id).grid);
      throw;
    }
    maps_.at(id) = map;
  }

  static MergeOptions make_options(int threads, double accept, double max_false_joins, double max_missed,
                                   double output_resolution, const std::string& transform,
                                   const std::string& search, std::shared_ptr<Progress> progress) {
    MergeOptions options;
    options.match.threads = threads;
    set_search(options.match, search, accept);
    options.max_false_joins = max_false_joins;
    options.max_missed = max_missed;
    options.resolution = output_resolution;
    options.transform = map_transform(transform).value();
    options.progress = [progress = std::move(progress)](std::size_t done, std::size_t total) {
      (*progress)(done, total);
    };
    return options;
  }

  std::shared_ptr<Progress> progress_ = std::make_shared<Progress>();  // of the solve() that is at work
  Merger merger_;
  std::map<std::size_t, Map> maps_;
};

}  // namespace

void bind_merger(nb::module_& module) {
  nb::class_<MapMerger>(module, "Merger")
      .def(nb::init<int, double, double, double, double, const std::string&, const std::string&>(),
           nb::arg("threads"), nb::arg("accept"), nb::arg("max_false_joins"), nb::arg("max_missed"),
           nb::arg("output_resolution"), nb::arg("transform"), nb::arg("search"))
      .def("add", &MapMerger::add, nb::arg("map"), nb::arg("known").none())
      .def("update", &MapMerger::update, nb::arg("id"), nb::arg("map"))
      .def("grow", &MapMerger::grow, nb::arg("id"), nb::arg("map"))
      .def("search_again", &MapMerger::search_again, nb::arg("id"))
      .def("remove", &MapMerger::remove, nb::arg("id"))
      .def("keep", &MapMerger::keep, nb::arg("wanted"))
      .def("due", &MapMerger::due)
      .def("hand_in", &MapMerger::hand_in, nb::arg("fixed"), nb::arg("moving"), nb::arg("search"),
           nb::arg("match"))
      .def("matches", &MapMerger::matches)
      .def("match_options", &MapMerger::match_options)
      .def("warn_of_other_shards", &MapMerger::warn_of_other_shards, nb::arg("cache"))
      .def("solve", &MapMerger::solve, nb::arg("cache").none(), nb::arg("progress").none());
}

}  // namespace gridmerge::python
