// SPDX-License-Identifier: Apache-2.0
#include "dds/line_limiter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace gridmerge::internal {

LineLimiter::LineLimiter(std::size_t at_once, std::function<void(const std::string&)> write)
    : at_once_(at_once), write_(std::move(write)) {}

void LineLimiter::write(const std::string& kind, const std::string& line, Clock::time_point now,
                        std::uint64_t count) {
  tell_more(now);
  const bool has_room = kinds_.contains(kind) || kinds_.size() < kMaxKinds;
  Kind& found = kinds_.try_emplace(has_room ? kind : std::string(), Kind{now, 0, 0, {}}).first->second;
  found.untold += count;
  found.last = line;
  if (found.written == at_once_) return;
  ++found.written;
  --found.untold;
  write_(line);
}

void LineLimiter::tell_more(Clock::time_point now) {
  for (auto at = kinds_.begin(); at != kinds_.end();) {
    Kind& kind = at->second;
    if (now - kind.began < kWindow) {
      ++at;
    } else if (kind.untold == 0) {
      at = kinds_.erase(at);
    } else {
      write_(fmt::format("{} ({} more like it in {} s)", kind.last, kind.untold, kWindow.count()));
      kind.began = now;
      kind.untold = 0;
      ++at;
    }
  }
}

std::string kind_of_line(const std::string& line) {
  constexpr int kWords = 3;
  constexpr std::size_t kLongest = 64;
  std::istringstream words(line);
  std::string kind, word;
  for (int count = 0; count < kWords && words >> word;) {
    if (std::any_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; })) continue;
    if (count++ > 0) kind += ' ';
    kind.append(word, 0, kLongest);
  }
  return kind;
}

}  // namespace gridmerge::internal
