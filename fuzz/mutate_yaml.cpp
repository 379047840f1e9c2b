// SPDX-License-Identifier: Apache-2.0
// Changes the keys, values and style of a map's YAML, and leaves what follows its end mark, a line "...", as
// it is.
#include <yaml-cpp/yaml.h>

#include <array>
#include <utility>
#include <vector>

#include "mutator.hpp"

namespace {

using namespace gridmerge::fuzz;

struct Entry {
  std::string key;
  std::string value;  // as YAML text, on one line
};

constexpr std::array kKeys{"image", "resolution", "origin", "occupied_thresh", "free_thresh", "negate",
                           "mode",  "Mode",       "<<"};
constexpr std::array kValues{
    "a.pgm",        "'a b.png'",      "\"a\\0b\"", "\"\\u20ac\"", "0",      "1",
    "0.05",         "1e-9",           "1e400",     "-0",          "0x1p-3", "nan",
    ".inf",         "-.NaN",          "TRUE",      "Off",         "y",      "~",
    "trinary",      "SCALE",          "raw",       "[0, 0, 0]",   "[1, 2]", "[0, 0, nan]",
    "[1, 2, 3, 4]", "[1e7, -1e7, 9]", "[]",        "{}",          "{a: b}", "*a",
    "&a 0.1",       "!!str 1",        "!x 0.5",    "0.1 # m",     "? a"};

// Throws YAML::Exception unless the text is a map.
std::vector<Entry> entries_of(const std::string& text) {
  std::vector<Entry> entries;
  const YAML::Node document = YAML::Load(text);
  if (!document.IsMap()) return entries;
  for (const auto& entry : document) {
    YAML::Emitter value;
    value << YAML::Flow << entry.second;
    entries.push_back({YAML::Dump(entry.first), value.c_str()});
  }
  return entries;
}

void change(std::vector<Entry>& entries, Random& random) {
  if (entries.empty()) {
    entries.push_back({any_of(kKeys, random), any_of(kValues, random)});
    return;
  }
  Entry& entry = any_of(entries, random);
  switch (random() % 8) {
    case 0:
    case 1:
      entry.value = any_of(kValues, random);
      break;
    case 2:
      entry.key = any_of(kKeys, random);
      break;
    case 3:
      entry.value = with_changed_bytes(std::move(entry.value), 8);
      break;
    case 4:
      std::swap(entry.value, any_of(entries, random).value);
      break;
    case 5:
      std::swap(entry, any_of(entries, random));
      break;
    case 6:
      std::swap(entry, entries.back());
      entries.pop_back();
      break;
    default:
      entries.push_back({any_of(kKeys, random), entry.value});
  }
}

std::string written(const std::vector<Entry>& entries, Random& random) {
  const bool flow = random() % 4 == 0;
  const char* const end = flow ? ", " : random() % 8 == 0 ? "\r\n" : "\n";
  std::string text = flow ? "{" : random() % 8 == 0 ? "---\n" : "";
  for (const Entry& entry : entries) text += entry.key + ": " + entry.value + end;
  return flow ? text + "}\n" : text;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  Random random(seed);
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(bytes.find("\n...\n"), size);
  // Deep text would take yaml-cpp, which calls itself, too long; bytes do for it.
  if (random() % 4 == 0 || end > 1000) return LLVMFuzzerMutate(data, size, max_size);
  try {
    std::vector<Entry> entries = entries_of(std::string(bytes.substr(0, end)));
    for (std::size_t changes = 1 + below(3, random); changes > 0; --changes) change(entries, random);
    return put(written(entries, random) + std::string(bytes.substr(end)), data, size, max_size);
  } catch (const YAML::Exception&) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
}
