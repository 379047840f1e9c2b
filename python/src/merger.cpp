// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merger.hpp"

#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "merge.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

/// A Merger that keeps its maps, and of which one thread at a time may ask something: result() runs without
/// the interpreter's lock.
class SharedMerger {
 public:
  SharedMerger(int threads, double accept, double output_resolution)
      : merger_(make_options(threads, accept, output_resolution, share_)) {}

  std::size_t add(const Map& map, const std::optional<Known>& known) {
    const std::unique_lock lock = take();
    const std::size_t id = merger_.add(*map.grid, to_known_pose(known));
    maps_.emplace(id, map);
    return id;
  }

  void update(std::size_t id, const Map& map) {
    const std::unique_lock lock = take();
    merger_.update(id, *map.grid);
    maps_.at(id) = map;
  }

  void set_known_pose(std::size_t id, const std::optional<Known>& known) {
    const std::unique_lock lock = take();
    merger_.set_known_pose(id, to_known_pose(known));
  }

  void remove(std::size_t id) {
    const std::unique_lock lock = take();
    merger_.remove(id);
    maps_.erase(id);
  }

  std::vector<std::size_t> ids() {
    const std::unique_lock lock = take();
    return merger_.maps();
  }

  Merged result(const nb::object& progress) {
    const std::unique_lock lock = take();
    MergeResult result = compute_in_worker(progress, [&](const Report& report) {
      *share_ = report;
      return merger_.result();
    });
    std::vector<Map> maps;
    maps.reserve(maps_.size());
    for (const auto& [id, map] : maps_) maps.push_back(map);
    return {std::move(maps), std::make_shared<const MergeResult>(std::move(result))};
  }

 private:
  std::unique_lock<std::mutex> take() {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) throw std::runtime_error("the Merger is at work in another thread");
    return lock;
  }

  static MergeOptions make_options(int threads, double accept, double output_resolution,
                                   std::shared_ptr<Report> share) {
    MergeOptions options;
    options.match.threads = threads;
    options.match.accept_probability = accept;
    options.resolution = output_resolution;
    options.progress = [share = std::move(share)](std::size_t done, std::size_t total) {
      (*share)(static_cast<double>(done) / static_cast<double>(total));
    };
    return options;
  }

  std::mutex mutex_;
  std::shared_ptr<Report> share_ = std::make_shared<Report>();  // of the result() that is at work
  Merger merger_;
  std::map<std::size_t, Map> maps_;
};

}  // namespace

void bind_merger(nb::module_& module) {
  nb::class_<SharedMerger>(module, "Merger")
      .def(nb::init<int, double, double>(), nb::arg("threads"), nb::arg("accept"),
           nb::arg("output_resolution"))
      .def("add", &SharedMerger::add, nb::arg("map"), nb::arg("known").none())
      .def("update", &SharedMerger::update, nb::arg("id"), nb::arg("map"))
      .def("set_known_pose", &SharedMerger::set_known_pose, nb::arg("id"), nb::arg("known").none())
      .def("remove", &SharedMerger::remove, nb::arg("id"))
      .def("ids", &SharedMerger::ids)
      .def("result", &SharedMerger::result, nb::arg("progress").none());
}

}  // namespace gridmerge::python
