// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "grid/sha256.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "match/bytes.hpp"

namespace gridmerge {

using namespace internal;

namespace {

template <typename Value>
std::string_view bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

void add(std::string_view bytes, Sha256& sha) {
  constexpr std::size_t kAtOnce = std::size_t{1} << 16;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kAtOnce, bytes.size()))) {
    throw_if_cancelled();
    sha.add(bytes.substr(0, kAtOnce));
  }
}

}  // namespace

std::string content_id(const OccupancyGrid& grid) {
  ByteWriter head;
  head.whole(static_cast<std::uint64_t>(grid.width));
  head.whole(static_cast<std::uint64_t>(grid.height));
  head.number(grid.resolution);
  head.pose(grid.origin);
  head.byte(grid.probability.empty() ? 0 : 1);
  Sha256 sha;
  sha.add(head.take());
  add(bytes_of(grid.cells), sha);
  add(bytes_of(grid.probability), sha);
  return to_hex(sha.digest());
}

std::string match_key(const std::string& fixed_content, const std::string& moving_content,
                      const MatchOptions& options) {
  if (options.search == SearchMethod::random_walk)
    throw std::invalid_argument("a random walk has more options than a match's name tells");
  ByteWriter key;
  key.text(engine_id());
  key.text(fixed_content);
  key.text(moving_content);
  key.text(name_of(options.search));
  key.whole(options.max_hypotheses);
  key.number(options.accept_probability);
  if (options.scales) {
    key.number(options.scales->least);
    key.number(options.scales->most);
  }
  return to_hex(Sha256().add(key.take()).digest());
}

}  // namespace gridmerge
