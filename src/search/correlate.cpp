// SPDX-License-Identifier: Apache-2.0
#include "search/correlate.hpp"

#include <algorithm>

#include "grid/multiversion.hpp"
#include "grid/unaligned.hpp"

namespace gridmerge::internal {

namespace {

// 32 lanes of 8 bits and 16 lanes of 16: one AVX2 register each, or two of SSE2.
using Bytes = std::int8_t __attribute__((vector_size(32)));
using Words = std::int16_t __attribute__((vector_size(32)));
constexpr int kLanes = 32;
constexpr std::size_t kGroup = 8;  // inputs that fit a sum of 8 bits
static_assert(kCorrelateBlock == 2 * kLanes);
static_assert(kMaxCorrelated * kGroup <= 127);

using HalfBytes = std::int8_t __attribute__((vector_size(16)));

inline void add_widened(const Bytes& sum, Words& low, Words& high) {
  const HalfBytes first =
      __builtin_shufflevector(sum, sum, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const HalfBytes second =
      __builtin_shufflevector(sum, sum, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
  low += __builtin_convertvector(first, Words);
  high += __builtin_convertvector(second, Words);
}

/// Two times 32 neighbouring outputs: sums of what lies at the offsets, shifted by `shift`, and `apart`
/// behind it. The sums stay in registers while all offsets are added: in 8 bits for a group of them, which
/// halves the memory to read, then in 16.
GRIDMERGE_MULTIVERSION
void add_up(const std::int8_t* values, std::ptrdiff_t shift, std::ptrdiff_t apart,
            const std::int32_t* offsets, std::size_t count, std::int16_t* output0, std::int16_t* output1) {
  Words sum0{}, sum1{}, sum2{}, sum3{};
  const auto add_group = [&](std::size_t first, std::size_t size) {
    Bytes group0{}, group1{};
    for (std::size_t i = first; i < first + size; ++i) {
      const std::int8_t* const at = values + (shift + offsets[i]);
      Bytes lanes0, lanes1;
      load(at, lanes0);
      load(at + apart, lanes1);
      group0 += lanes0;
      group1 += lanes1;
    }
    add_widened(group0, sum0, sum1);
    add_widened(group1, sum2, sum3);
  };
  std::size_t first = 0;
  for (; first + kGroup <= count; first += kGroup) add_group(first, kGroup);
  if (first < count) add_group(first, count - first);
  store(sum0, output0);
  store(sum1, output0 + kLanes / 2);
  store(sum2, output1);
  store(sum3, output1 + kLanes / 2);
}

/// Whether one of `count` values, a multiple of 8, is `least` or more.
GRIDMERGE_MULTIVERSION
bool any_reaches(const std::int16_t* values, int count, std::int16_t least) {
  std::int16_t found = 0;
  for (int i = 0; i < count; ++i) found |= static_cast<std::int16_t>(values[i] >= least);
  return found != 0;
}

/// The samples that fall on the image at some shift of a column of blocks, sorted by rows: so those that do
/// in one row of the output follow each other.
class BlockColumn {
 public:
  /// The samples must be sorted by y.
  void choose(const EvidenceImage& image, const std::vector<Sample>& samples, int x, int columns) {
    rows_.clear();
    offsets_.clear();
    const std::ptrdiff_t origin = static_cast<std::ptrdiff_t>(image.index(0, 0));
    for (const Sample& sample : samples) {
      const int from = sample.x + x;
      if (from <= -columns || from >= image.width()) continue;
      rows_.push_back(sample.y);
      const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(image.index(0, 0, sample.plane)) - origin;
      offsets_.push_back(static_cast<std::int32_t>(
          origin + plane + static_cast<std::ptrdiff_t>(sample.y) * image.stride() + from));
    }
    first_ = last_ = rows_.size();
  }

  /// Those on the image in one of the rows from `y` to `y + rows - 1`. `y` must not fall from call to call.
  void meet_rows(const EvidenceImage& image, int y, int rows) {
    while (first_ > 0 && rows_[first_ - 1] + y + rows - 1 >= 0) --first_;
    while (last_ > first_ && rows_[last_ - 1] + y >= image.height()) --last_;
  }

  const std::int32_t* offsets() const { return offsets_.data() + first_; }
  std::size_t count() const { return last_ - first_; }

 private:
  std::vector<int> rows_;
  std::vector<std::int32_t> offsets_;
  std::size_t first_ = 0;  // rows fall off below...
  std::size_t last_ = 0;   // ...and above
};

void sort_by_row(std::vector<Sample>& samples) {
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.y < b.y; });
}

constexpr int half(int value) {  // rounded down
  return value >> 1;
}

}  // namespace

EvidenceImage::EvidenceImage(int width, int height, int planes)
    : width_(width),
      height_(height),
      planes_(planes),
      values_(static_cast<std::size_t>(stride()) * (height + 2) * planes, 0) {}

void correlate(const EvidenceImage& image, std::vector<Sample> samples, ScoreImage& output) {
  sort_by_row(samples);
  BlockColumn column;
  for (int x = 0; x < output.width; x += kCorrelateBlock) {
    column.choose(image, samples, x, kCorrelateBlock);
    for (int y = 0; y < output.height; ++y) {
      column.meet_rows(image, y, 1);
      std::int16_t* const scores = output.values.data() + static_cast<std::size_t>(y) * output.width + x;
      add_up(image.data(), static_cast<std::ptrdiff_t>(y) * image.stride(), kLanes, column.offsets(),
             column.count(), scores, scores + kLanes);
    }
  }
}

EvidenceImage pool_pairs(const EvidenceImage& image) {
  EvidenceImage pooled(half(image.width()) + 2, half(image.height()) + 2, 4 * image.planes());
  for (int plane = 0; plane < image.planes(); ++plane) {
    for (int y = -1; y < image.height(); ++y) {
      for (int x = -1; x < image.width(); ++x) {
        pooled.at(half(x) + 1, half(y) + 1, 4 * plane + 2 * (y & 1) + (x & 1)) =
            std::max(std::max(image.at(x, y, plane), image.at(x + 1, y, plane)),
                     std::max(image.at(x, y + 1, plane), image.at(x + 1, y + 1, plane)));
      }
    }
  }
  return pooled;
}

std::vector<Sample> pool_pairs(const std::vector<Sample>& samples) {
  std::vector<Sample> pooled;
  pooled.reserve(samples.size());
  for (const Sample& sample : samples) {
    pooled.push_back(
        {half(sample.x) + 1, half(sample.y) + 1, 4 * sample.plane + 2 * (sample.y & 1) + (sample.x & 1)});
  }
  return pooled;
}

void pool_scores(const ScoreImage& scores, ScoreImage& pooled) {
  const int half_width = scores.width / 2;  // even, since scores come in blocks
  pooled.width = (half_width + kCorrelateBlock - 1) / kCorrelateBlock * kCorrelateBlock;
  pooled.height = (scores.height + 1) / 2;
  pooled.values.assign(static_cast<std::size_t>(pooled.width) * pooled.height, 0);
  for (int y = 0; y < pooled.height; ++y) {
    const std::int16_t* const row = scores.values.data() + static_cast<std::size_t>(2 * y) * scores.width;
    const std::int16_t* const next = 2 * y + 1 < scores.height ? row + scores.width : row;
    std::int16_t* const most = pooled.values.data() + static_cast<std::size_t>(y) * pooled.width;
    for (std::ptrdiff_t x = 0; x < half_width; ++x)
      most[x] = std::max(std::max(row[2 * x], row[2 * x + 1]), std::max(next[2 * x], next[2 * x + 1]));
  }
}

std::vector<ScoreBlock> correlate_where(const EvidenceImage& image, std::vector<Sample> samples,
                                        const ScoreImage& bounds, int least, ScoreImage& output) {
  static_assert(ScoreBlock::kColumns == kLanes);
  sort_by_row(samples);
  std::fill(output.values.begin(), output.values.end(), kNotLookedAt);
  std::vector<std::int16_t> beyond(kLanes);  // where the second row of the last pair goes, if there is none
  std::vector<ScoreBlock> looked_at;
  BlockColumn column;
  for (int x = 0; x < output.width; x += ScoreBlock::kColumns) {
    column.choose(image, samples, x, kLanes);
    for (int y = 0; y < output.height; y += ScoreBlock::kRows) {
      if (!any_reaches(bounds.values.data() + static_cast<std::size_t>(y / 2) * bounds.width + x / 2,
                       kLanes / 2, static_cast<std::int16_t>(least)))
        continue;
      column.meet_rows(image, y, ScoreBlock::kRows);
      std::int16_t* const scores = output.values.data() + static_cast<std::size_t>(y) * output.width + x;
      add_up(image.data(), static_cast<std::ptrdiff_t>(y) * image.stride(), image.stride(), column.offsets(),
             column.count(), scores, y + 1 < output.height ? scores + output.width : beyond.data());
      looked_at.push_back({x, y});
    }
  }
  return looked_at;
}

}  // namespace gridmerge::internal
