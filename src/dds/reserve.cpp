// SPDX-License-Identifier: Apache-2.0
#include "dds/reserve.hpp"

#include <algorithm>
#include <utility>

namespace gridmerge::internal {

void Reserve::keep(Kept kept) {
  std::erase_if(kept_, [&](const Kept& other) { return other.writer.handle == kept.writer.handle; });
  if (kept_.size() == kMaxKept) kept_.erase(kept_.begin());
  kept_.push_back(std::move(kept));
}

bool Reserve::keep(const std::string& participant, HeardPart part, dds_time_t written) {
  const auto kept = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& one) {
    return one.writer.participant == participant && one.map.frame == part.frame;
  });
  if (kept == kept_.end()) return false;
  if (written > 0 && written < kept->written) return true;
  if (kept->parts.size() == kMaxParts) kept->parts.erase(kept->parts.begin());
  kept->parts.push_back(std::move(part));
  return true;
}

std::optional<Reserve::Kept> Reserve::take_newest() {
  if (kept_.empty()) return std::nullopt;
  Kept newest = std::move(kept_.back());
  kept_.pop_back();
  return newest;
}

void Reserve::keep_only(const std::function<bool(const RemoteWriter&)>& is_there) {
  std::erase_if(kept_, [&](const Kept& kept) { return !is_there(kept.writer); });
}

std::size_t Reserve::cells() const {
  std::size_t cells = 0;
  for (const Kept& kept : kept_) {
    cells += kept.map.grid.cells.size();
    for (const HeardPart& part : kept.parts) cells += part.grid.cells.size();
  }
  return cells;
}

}  // namespace gridmerge::internal
