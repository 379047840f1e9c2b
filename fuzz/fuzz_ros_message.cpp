// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "dds/message.hpp"
#include "fuzz_target.hpp"

namespace {

/// Takes numbers off the front of the input; zeros when it has run out.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <typename Number>
  Number take() {
    Number number{};
    const std::size_t count = std::min(sizeof number, size_);
    std::memcpy(&number, data_, count);
    data_ += count;
    size_ -= count;
    return number;
  }

  std::string_view take_text() {
    const std::size_t count = std::min<std::size_t>(take<std::uint8_t>(), size_);
    const std::string_view text(reinterpret_cast<const char*>(data_), count);
    data_ += count;
    size_ -= count;
    return text;
  }

  std::span<const std::int8_t> rest() const { return {reinterpret_cast<const std::int8_t*>(data_), size_}; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  using namespace gridmerge::internal;
  Input input(data, size);
  MapSample message;
  UpdateSample update;
  message.frame = update.frame = input.take_text();
  message.resolution = input.take<float>();
  message.width = update.width = input.take<std::uint16_t>();
  message.height = update.height = input.take<std::uint16_t>();
  update.x = input.take<std::int32_t>();
  update.y = input.take<std::int32_t>();
  for (double& part : message.position) part = input.take<double>();
  for (double& part : message.orientation) part = input.take<double>();
  message.data = update.data = input.rest();
  try {
    const HeardMap heard = read_map(message);
    validate(heard.grid);
    fuzz::require(!heard.frame.empty() && heard.grid.cells.size() == message.data.size());
    fuzz::require(std::isfinite(heard.grid.origin.theta));
  } catch (const RefusedMessage&) {
  }
  try {
    const HeardPart part = read_update(update);
    fuzz::require(part.x >= 0 && part.y >= 0 && part.grid.cells.size() == update.data.size());
  } catch (const RefusedMessage&) {
  }
  return 0;
}
