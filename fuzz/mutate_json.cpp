// SPDX-License-Identifier: Apache-2.0
// Changes a JSON document's values, keys and order, so that what comes out is JSON as well.
#include <array>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "mutator.hpp"

namespace {

using namespace gridmerge::fuzz;
using Json = nlohmann::json;

// Every value of a document, itself included; a change of one leaves no pointers to what was in it.
void collect(Json& value, std::vector<Json*>& all) {
  all.push_back(&value);
  if (!value.is_structured()) return;
  for (Json& child : value) collect(child, all);
}

Json any_value(Random& random) {
  static const std::vector<Json> kValues{nullptr,
                                         true,
                                         false,
                                         0,
                                         1,
                                         -1,
                                         2,
                                         3,
                                         0.5,
                                         -0.0,
                                         1e-320,
                                         1e300,
                                         3.14159,
                                         1e7,
                                         -10000001.0,
                                         1e18,
                                         "",
                                         "a",
                                         "a/b",
                                         "..",
                                         Json::array(),
                                         Json::object(),
                                         std::numeric_limits<std::int64_t>::min(),
                                         std::numeric_limits<std::uint64_t>::max()};
  return any_of(kValues, random);
}

void change_number(Json& number, Random& random) {
  const double value = number.get<double>();
  const std::array changed{-value, value + 1.0, value - 1.0, value * 1e6, value / 3.0, 1.0 - value};
  number = any_of(changed, random);
}

void change_container(Json& container, const Json& elsewhere, Random& random) {
  const auto child =
      std::next(container.begin(), static_cast<std::ptrdiff_t>(below(container.size(), random)));
  if (random() % 3 == 0) {
    container.erase(child);
  } else if (container.is_array()) {
    Json copy = random() % 2 == 0 ? *child : elsewhere;
    container.insert(child, std::move(copy));
  } else {
    Json moved = std::move(*child);
    std::string key = child.key();
    container.erase(child);
    // Under a key of the format, or one that nobody knows.
    key = elsewhere.is_string() ? elsewhere.get<std::string>() : with_changed_bytes(std::move(key), 4);
    container[std::move(key)] = std::move(moved);
  }
}

void change(Json& document, Random& random) {
  std::vector<Json*> all;
  collect(document, all);
  Json& value = *any_of(all, random);
  Json elsewhere = *any_of(all, random);
  const auto kind = random() % 4;
  if (kind == 0) {
    value = any_value(random);
  } else if (kind == 1) {
    value = std::move(elsewhere);
  } else if (value.is_number()) {
    change_number(value, random);
  } else if (value.is_string()) {
    value = with_changed_bytes(value.get<std::string>());
  } else if (value.is_structured() && !value.empty()) {
    change_container(value, elsewhere, random);
  } else {
    value = Json::array({value, std::move(elsewhere)});
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  Random random(seed);
  Json document = Json::parse(data, data + size, nullptr, false);
  if (document.is_discarded() || random() % 8 == 0) return LLVMFuzzerMutate(data, size, max_size);
  for (std::size_t changes = 1 + below(3, random); changes > 0; --changes) change(document, random);
  return put(document.dump(-1, ' ', false, Json::error_handler_t::replace), data, size, max_size);
}
