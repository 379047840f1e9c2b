// SPDX-License-Identifier: Apache-2.0
#include "report/tiff_tags.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace gridmerge::internal {

enum class TiffTags::Type : std::uint16_t {
  text = 2,
  word16 = 3,
  word32 = 4,
  real64 = 12,
  word64 = 16,
};

namespace {

constexpr std::uint64_t kInline = 8;     // bytes of values that stand in the tag itself
constexpr std::uint64_t kTagSize = 20;   // number, type, count, values or where they are
constexpr std::uint64_t kCountSize = 8;  // of a directory
constexpr std::uint64_t kNextSize = 8;   // where the next directory is
constexpr std::uint64_t kHeaderSize = 16;

template <typename Word>
void put(std::string& bytes, Word value) {
  for (std::size_t i = 0; i < sizeof(Word); ++i)
    bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF));
}

template <typename Word>
std::string words(const std::vector<Word>& values) {
  std::string bytes;
  bytes.reserve(values.size() * sizeof(Word));
  for (const Word value : values) put(bytes, value);
  return bytes;
}

/// Values begin at even places.
std::uint64_t padded(std::uint64_t size) {
  return size + size % 2;
}

}  // namespace

std::string TiffTags::header() {
  std::string bytes = "II";
  put<std::uint16_t>(bytes, 43);  // BigTIFF
  put<std::uint16_t>(bytes, 8);   // bytes of a place in the file
  put<std::uint16_t>(bytes, 0);
  put<std::uint64_t>(bytes, kHeaderSize);
  return bytes;
}

void TiffTags::add(std::uint16_t tag, Type type, std::uint64_t count, std::string values) {
  const auto at =
      std::find_if(tags_.begin(), tags_.end(), [tag](const Tag& other) { return other.tag > tag; });
  tags_.insert(at, {tag, type, count, std::move(values)});
}

void TiffTags::add_shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
  add(tag, Type::word16, values.size(), words(values));
}

void TiffTags::add_longs(std::uint16_t tag, const std::vector<std::uint32_t>& values) {
  add(tag, Type::word32, values.size(), words(values));
}

void TiffTags::add_offsets(std::uint16_t tag, const std::vector<std::uint64_t>& values) {
  add(tag, Type::word64, values.size(), words(values));
}

void TiffTags::add_doubles(std::uint16_t tag, const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  add(tag, Type::real64, values.size(), words(bits));
}

void TiffTags::add_text(std::uint16_t tag, std::string_view text) {
  std::string bytes(text);
  bytes.push_back('\0');
  const std::uint64_t count = bytes.size();
  add(tag, Type::text, count, std::move(bytes));
}

std::uint64_t TiffTags::size() const {
  std::uint64_t size = kCountSize + tags_.size() * kTagSize + kNextSize;
  for (const Tag& tag : tags_) {
    if (tag.values.size() > kInline) size += padded(tag.values.size());
  }
  return size;
}

std::string TiffTags::bytes(std::uint64_t offset, bool has_next) const {
  std::string directory, values;
  const std::uint64_t first_value = offset + kCountSize + tags_.size() * kTagSize + kNextSize;
  put<std::uint64_t>(directory, tags_.size());
  for (const Tag& tag : tags_) {
    put<std::uint16_t>(directory, tag.tag);
    put<std::uint16_t>(directory, static_cast<std::uint16_t>(tag.type));
    put<std::uint64_t>(directory, tag.count);
    if (tag.values.size() <= kInline) {
      directory += tag.values;
      directory.append(kInline - tag.values.size(), '\0');
    } else {
      put<std::uint64_t>(directory, first_value + values.size());
      values += tag.values;
      values.append(values.size() % 2, '\0');
    }
  }
  put<std::uint64_t>(directory, has_next ? first_value + values.size() : 0);
  return directory + values;
}

}  // namespace gridmerge::internal
