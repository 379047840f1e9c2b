// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace gridmerge::python {

/// The share that is done of work in rounds, where nobody knows how many follow: each round takes half of
/// what is left, so that the share never falls.
class RoundsShare {
 public:
  /// With so many of the round's `total` done; all of them end the round.
  double of(std::size_t done, std::size_t total) {
    if (total == 0) return begin_;
    const double share =
        begin_ + 0.5 * (1.0 - begin_) * static_cast<double>(done) / static_cast<double>(total);
    if (done == total) begin_ = share;
    return share;
  }

 private:
  double begin_ = 0.0;  // of the round
};

}  // namespace gridmerge::python
