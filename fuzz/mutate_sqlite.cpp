// SPDX-License-Identifier: Apache-2.0
// Changes an SQLite file within its pages, which stay where they are: a byte more would shift all that
// follows, and nothing would be a page any more.
#include <algorithm>

#include "mutator.hpp"

namespace {

using namespace gridmerge::fuzz;

constexpr std::size_t kHeader = 100;

/// As the header says; 0 for what SQLite would not take.
std::size_t page_size_of(std::string_view bytes) {
  if (!bytes.starts_with("SQLite format 3") || bytes.size() < kHeader) return 0;
  const std::size_t size = static_cast<std::uint8_t>(bytes[16]) * 256U + static_cast<std::uint8_t>(bytes[17]);
  return size >= 512 && (size & (size - 1)) == 0 ? size : 0;
}

/// A run of bytes, whose place and length stay.
void change_run(std::string& text, std::size_t begin, std::size_t end, Random& random) {
  const std::size_t from = begin + below(end - begin, random);
  const std::size_t count = std::min(end - from, 1 + below(24, random));
  std::string run = with_changed_bytes(text.substr(from, count), 0);
  run.resize(count);
  text.replace(from, count, run);
}

/// One of the numbers of two bytes at the beginning of a page, or of its cells' places.
void change_number(std::string& text, std::size_t page, std::size_t size, Random& random) {
  const std::size_t first = page == 0 ? kHeader : page;
  const std::size_t at = std::min(first + below(40, random), page + size - 2);
  const std::size_t value = random() % 3 == 0 ? below(65536, random) : below(size, random);
  text[at] = static_cast<char>(value >> 8);
  text[at + 1] = static_cast<char>(value);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  Random random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t page = page_size_of(text);
  const std::size_t pages = page == 0 ? 0 : size / page;
  if (pages == 0 || random() % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);
  for (std::size_t changes = 1 + below(3, random); changes > 0; --changes) {
    const std::size_t at = below(pages, random) * page, other = below(pages, random) * page;
    switch (random() % 8) {
      case 0:
        change_run(text, 0, kHeader, random);
        break;
      case 1:
      case 2:
        change_number(text, at, page, random);
        break;
      case 3:
        text.replace(at, page, std::string(text, other, page));
        break;
      case 4:
        if (at > 0) return put(text.substr(0, at), data, size, max_size);
        break;
      default:
        change_run(text, at, at + page, random);
    }
  }
  return put(text, data, size, max_size);
}
