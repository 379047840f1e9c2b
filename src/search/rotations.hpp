// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "grid/parallel.hpp"
#include "search/exhaustive.hpp"
#include "search/search_frame.hpp"

namespace gridmerge::internal {

inline constexpr std::size_t kPilotStep = 8;  // every 8th rotation tells what the others have to reach

/// What the last of `max_candidates` will score at least, by the peaks of the pilots: so that all rotations
/// have `margin` times as many peaks, most of which lie beside better ones. 0 if they have not.
inline int foreseen_score(std::vector<Peak> pilots, std::size_t max_candidates, std::size_t margin) {
  const std::size_t wanted = margin * max_candidates / kPilotStep;
  if (wanted == 0 || pilots.size() <= wanted) return 0;
  std::nth_element(pilots.begin(), pilots.begin() + static_cast<std::ptrdiff_t>(wanted), pilots.end());
  return pilots[wanted].score;
}

/// The best peaks of all rotations, best first. `make_finder()` makes what finds those of one rotation, in
/// memory that it keeps: `find_all(rotation)`, and `find_from(least, rotation)`, which may pass over what
/// scores less than `least` and so is faster. The result is the same whichever is called.
template <typename MakeFinder>
std::vector<PoseCandidate> search_rotations(const SearchFrame& frame, std::size_t max_candidates,
                                            std::size_t margin, MakeFinder make_finder) {
  tbb::enumerable_thread_specific<decltype(make_finder())> finders(make_finder);
  std::vector<std::vector<Peak>> peaks(static_cast<std::size_t>(frame.rotations));
  const auto in_rotations = [&](bool pilots, auto find) {
    parallel_for(peaks.size(), [&](std::size_t i) {
      if ((i % kPilotStep == 0) == pilots) peaks[i] = find(finders.local(), static_cast<int>(i));
    });
  };
  const auto find_all = [](auto& finder, int rotation) { return finder.find_all(rotation); };

  in_rotations(true, find_all);
  const int least = foreseen_score(together(peaks), max_candidates, margin);
  // The best ones are the same whatever lies below `least`, if there are enough of them from there on.
  std::vector<Peak> kept;
  if (least > 0) {
    in_rotations(false, [&](auto& finder, int rotation) { return finder.find_from(least, rotation); });
    std::vector<Peak> from_least = together(peaks);
    std::erase_if(from_least, [&](const Peak& peak) { return peak.score < least; });
    kept = keep_distinct(std::move(from_least), frame.rotations, max_candidates);
  }
  if (kept.size() < max_candidates) {
    in_rotations(false, find_all);
    kept = keep_distinct(together(peaks), frame.rotations, max_candidates);
  }
  std::vector<PoseCandidate> candidates;
  candidates.reserve(kept.size());
  for (const Peak& peak : kept) candidates.push_back({frame.pose(peak), peak.score});
  return candidates;
}

}  // namespace gridmerge::internal
