// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridmerge {

/// A scanning laser range finder.
struct RangeFinder {
  double field_of_view = 4.71238898038469;    ///< [rad], about the heading: 270 degrees
  double angular_step = 0.00872664625997165;  ///< between two beams [rad]: half a degree
  double range = 8.0;                         ///< [m]: what is farther gives no echo
  double cleared_share = 0.5;                 ///< of the range: what a beam without an echo counts as free
  double noise = 0.02;                        ///< standard deviation of a range [m]
  double stray_share = 0.002;  ///< beams that end before what they should meet: dust, edges, people
  double missed_share = 0.02;  ///< beams that come back with nothing

  /// Throws std::invalid_argument, saying what is wrong, for a range finder that cannot be.
  void validate() const;
};

}  // namespace gridmerge
