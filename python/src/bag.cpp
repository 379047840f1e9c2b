// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/bag/bag.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "bag/growing_map.hpp"
#include "bindings.hpp"
#include "io/blaming.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

/// A bag's maps one after another, and the bag, whose files they have.
struct Recording {
  Bag bag;
  BagMaps maps;
};

/// A map, the frame that it names, when it was recorded [ns], and whether an update made it.
using RecordedMap = std::tuple<Map, nb::str, std::int64_t, bool>;

RecordedMap to_python(const Recording& recording, BagMap map) {
  Map held = to_map({std::move(map.grid), std::move(map.warnings), recording.bag.files()});
  return {std::move(held), to_str(map.frame_id), map.time, map.is_update};
}

RecordedMap load_topic(const nb::bytes& path, const nb::bytes& topic) {
  const std::string file = to_string(path), name = to_string(topic);
  BagMap map;
  std::optional<Recording> recording;
  {
    const OthersRun meanwhile;
    const Bag bag(file);
    recording = Recording{bag, BagMaps(bag, name)};
    map = recording->maps.last();
  }
  return to_python(*recording, std::move(map));
}

Recording open_recording(const nb::bytes& path, const nb::bytes& topic) {
  const std::string file = to_string(path), name = to_string(topic);
  const OthersRun meanwhile;
  Bag bag(file);
  BagMaps maps(bag, name);
  return {std::move(bag), std::move(maps)};
}

std::optional<RecordedMap> next_map(Recording& recording) {
  std::optional<BagMap> map;
  {
    const OthersRun meanwhile;
    map = recording.maps.next();
  }
  if (!map) return std::nullopt;
  return to_python(recording, std::move(*map));
}

std::vector<std::tuple<nb::str, nb::str, std::uint64_t>> topics_of(const nb::bytes& path) {
  const std::string file = to_string(path);
  std::optional<Bag> bag;
  {
    const OthersRun meanwhile;
    bag.emplace(file);
  }
  std::vector<std::tuple<nb::str, nb::str, std::uint64_t>> topics;
  for (const BagTopic& topic : bag->topics())
    topics.emplace_back(to_str(topic.name), to_str(topic.type), topic.messages);
  return topics;
}

/// The last map that messages in CDR draw: whether each is an update, and its bytes.
std::pair<Map, nb::str> draw_map(const nb::bytes& path,
                                 const std::vector<std::pair<bool, nb::bytes>>& messages) {
  const std::filesystem::path file = to_string(path);
  std::vector<std::pair<bool, std::string_view>> contents;  // of bytes that the caller holds
  for (const auto& [is_update, message] : messages)
    contents.emplace_back(is_update, std::string_view(message.c_str(), message.size()));
  internal::GrowingMap map(LoadOptions{}.max_cells);
  LoadedMap loaded;
  {
    const OthersRun meanwhile;
    internal::blaming(file, [&] {
      for (const auto& [is_update, bytes] : contents)
        is_update ? map.take_update(bytes) : map.take_map(bytes);
    });
    if (!map.is_there()) throw FileError(file, "has no map with cells on that topic");
    loaded.grid = map.grid();
    loaded.warnings = map.warnings(loaded.grid);
    loaded.files = {file};
  }
  return {to_map(std::move(loaded)), to_str(map.frame_id())};
}

std::pair<nb::bytes, nb::str> parse_name(const nb::bytes& name) {
  const std::string text = to_string(name);
  const MapName parts = [&] {
    const OthersRun meanwhile;
    return parse_map_name(text);
  }();
  const std::string file = parts.file.string();
  return {nb::bytes(file.data(), file.size()), to_str(parts.topic)};
}

}  // namespace

void bind_bag(nb::module_& module) {
  nb::class_<Recording>(module, "Recording").def("next", &next_map);
  module.def("open_recording", &open_recording, nb::arg("path"), nb::arg("topic"));
  module.def("load_topic", &load_topic, nb::arg("path"), nb::arg("topic"));
  module.def("topics_of", &topics_of, nb::arg("path"));
  module.def("draw_map", &draw_map, nb::arg("path"), nb::arg("messages"));
  module.def("parse_map_name", &parse_name, nb::arg("name"));
  module.def(
      "is_bag",
      [](const nb::bytes& path) {
        const std::filesystem::path file = to_string(path);
        const OthersRun meanwhile;
        return is_bag(file);
      },
      nb::arg("path"));
}

}  // namespace gridmerge::python
