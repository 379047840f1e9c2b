// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dds/discovery.hpp"
#include "dds/message.hpp"

namespace gridmerge::internal {

/// The newest map of each publisher of a topic that is not heard yet, with its updates: a publisher may send
/// its map once, before the one that is heard goes.
class Reserve {
 public:
  struct Kept {
    RemoteWriter writer;
    HeardMap map;
    dds_time_t written = 0;        // by its publisher's clock; 0 where it does not say
    std::vector<HeardPart> parts;  // since then, oldest first
  };

  /// Takes the place of the writer's map before. Beyond kMaxKept the oldest goes.
  void keep(Kept kept);
  /// Whether a map of this participant is kept, which the part belongs to. One that was written before the
  /// map is in it already. Beyond kMaxParts the oldest goes.
  bool keep(const std::string& participant, HeardPart part, dds_time_t written);

  /// The map that was kept last.
  std::optional<Kept> take_newest();

  /// Lets go of what is of other writers.
  void keep_only(const std::function<bool(const RemoteWriter&)>& is_there);
  void clear() { kept_.clear(); }

  /// Of all maps and parts.
  std::size_t cells() const;

  static constexpr std::size_t kMaxKept = 4;
  static constexpr std::size_t kMaxParts = 64;

 private:
  std::vector<Kept> kept_;  // oldest first
};

}  // namespace gridmerge::internal
