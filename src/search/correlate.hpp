// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gridmerge::internal {

/// An integer image, row-major.
struct ScoreImage {
  int width = 0;
  int height = 0;
  std::vector<std::int16_t> values;
};

/// Scores are computed in blocks of this many columns.
inline constexpr int kCorrelateBlock = 64;

/// Evidence lies in [-kMaxCorrelated, kMaxCorrelated], so that eight of it fit a sum of 8 bits.
inline constexpr int kMaxCorrelated = 15;

/// Images of one size that are 0 beyond their sides: a margin of zeros as wide as a block is stored with
/// them, so that a block may begin anywhere where it touches an image.
class EvidenceImage {
 public:
  EvidenceImage(int width, int height, int planes = 1);

  int width() const { return width_; }
  int height() const { return height_; }
  int planes() const { return planes_; }
  int stride() const { return width_ + 2 * kCorrelateBlock; }

  /// Column in [-kCorrelateBlock, width + kCorrelateBlock), row in [-1, height].
  std::size_t index(int x, int y, int plane = 0) const {
    const std::size_t row = static_cast<std::size_t>(plane) * (height_ + 2) + static_cast<std::size_t>(y + 1);
    return row * stride() + static_cast<std::size_t>(x + kCorrelateBlock);
  }
  std::int8_t& at(int x, int y, int plane = 0) { return values_[index(x, y, plane)]; }
  std::int8_t at(int x, int y, int plane = 0) const { return values_[index(x, y, plane)]; }
  const std::int8_t* data() const { return values_.data(); }

 private:
  int width_;
  int height_;
  int planes_;
  std::vector<std::int8_t> values_;
};

/// Where a sample falls in an image at shift (0, 0): anywhere, also beyond its sides.
struct Sample {
  int x;
  int y;
  int plane = 0;
};

/// output(x, y) = sum over `samples`, at most 32767 / kMaxCorrelated of them, of the image's value at
/// (sample.x + x, sample.y + y). The output's width must be a multiple of kCorrelateBlock. O(output values *
/// samples that fall on the image); vectorised.
void correlate(const EvidenceImage& image, std::vector<Sample> samples, ScoreImage& output);

/// Four images of largest values of 2 x 2 cells for each plane, one for the parities of their first column
/// and row: of plane p a cell in plane 4 p + 2 * (y mod 2) + (x mod 2) at (floor(x / 2) + 1, floor(y / 2) +
/// 1) has the largest value of (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1). O(cells).
EvidenceImage pool_pairs(const EvidenceImage& image);

/// The samples in the pooled image: with them, correlate() gives at (x, y) what no score of the shifts (2 x,
/// 2 y) to (2 x + 1, 2 y + 1) exceeds.
std::vector<Sample> pool_pairs(const std::vector<Sample>& samples);

/// The largest of each 2 x 2 values. `pooled` is given half the width, rounded up to blocks, and half the
/// height.
void pool_scores(const ScoreImage& scores, ScoreImage& pooled);

/// What correlate_where() leaves where it does not look: less than any sum.
inline constexpr std::int16_t kNotLookedAt = -32768;

/// Neighbouring values that are computed together.
struct ScoreBlock {
  static constexpr int kColumns = 32;
  static constexpr int kRows = 2;
  int x;  // of the first
  int y;
};

/// As correlate(), but only where a score may be `least` or more by the `bounds` of 2 x 2 shifts; elsewhere
/// the output is kNotLookedAt or right. The bounds must be at least half as wide and high as the output.
/// Returns the blocks that were looked at; those at the top may reach a row beyond the output.
std::vector<ScoreBlock> correlate_where(const EvidenceImage& image, std::vector<Sample> samples,
                                        const ScoreImage& bounds, int least, ScoreImage& output);

}  // namespace gridmerge::internal
