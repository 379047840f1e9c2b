// SPDX-License-Identifier: Apache-2.0
// Changes an MCAP file by the record, also those of a chunk that is not packed, and makes lengths anew and
// checksums none: with a wrong one a reader looks no further.
#include <algorithm>
#include <array>
#include <vector>

#include "mutator.hpp"

namespace {

using namespace gridmerge::fuzz;

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::uint8_t kFooter = 2, kChunk = 6;

struct Record {
  std::uint8_t kind;
  std::string content;
};

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
  return value;
}

std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i);
  return text;
}

// The records that are whole.
std::vector<Record> records_of(std::string_view bytes) {
  std::vector<Record> records;
  while (bytes.size() >= 9) {
    const std::uint64_t size = little_endian(bytes.substr(1, 8));
    if (size > bytes.size() - 9) break;
    records.push_back({static_cast<std::uint8_t>(bytes[0]), std::string(bytes.substr(9, size))});
    bytes.remove_prefix(9 + size);
  }
  return records;
}

std::string text_of(const std::vector<Record>& records) {
  std::string text;
  for (const auto& [kind, content] : records)
    text += static_cast<char>(kind) + little_endian(content.size(), 8) + content;
  return text;
}

void change(std::vector<Record>& records, Random& random);

// Of a chunk that is not packed: 28 bytes, an empty name of a packer, and the records.
void change_chunk(std::string& content, Random& random) {
  constexpr std::size_t kHead = 28 + 4 + 8;
  if (content.size() <= kHead || little_endian(std::string_view(content).substr(28, 4)) != 0) {
    content = with_changed_bytes(std::move(content));
    return;
  }
  std::vector<Record> records = records_of(std::string_view(content).substr(kHead));
  if (!records.empty()) change(records, random);
  const std::string text = text_of(records);
  content = content.substr(0, 16) + little_endian(text.size(), 8) + std::string(8, '\0') +
            little_endian(text.size(), 8) + text;
}

void change(std::vector<Record>& records, Random& random) {
  constexpr std::array<std::uint8_t, 9> kKinds{2, 3, 4, 5, 6, 7, 11, 15, 0x99};
  const std::size_t place = below(records.size(), random);
  Record& record = records[place];
  switch (random() % 8) {
    case 0:
    case 1:
    case 2:
      if (record.kind == kChunk) {
        change_chunk(record.content, random);
      } else {
        record.content = with_changed_bytes(std::move(record.content));
      }
      break;
    case 3:
      std::swap(record, any_of(records, random));
      break;
    case 4:
      if (records.size() > 1) records.erase(records.begin() + static_cast<std::ptrdiff_t>(place));
      break;
    case 5:
      records.insert(records.begin() + static_cast<std::ptrdiff_t>(place), Record(any_of(records, random)));
      break;
    case 6:
      record.kind = any_of(kKinds, random);
      break;
    default:
      record.content.resize(below(record.content.size() + 1, random));
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  Random random(seed);
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (!bytes.starts_with(kMagic) || random() % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const bool has_end = bytes.size() > kMagic.size() && bytes.ends_with(kMagic);
  bytes.remove_prefix(kMagic.size());
  std::vector<Record> records = records_of(bytes);
  if (records.empty()) return LLVMFuzzerMutate(data, size, max_size);
  for (std::size_t changes = 1 + below(3, random); changes > 0; --changes) change(records, random);
  for (Record& record : records) {
    if (record.kind == kFooter && record.content.size() == 20) record.content.replace(16, 4, 4, '\0');
  }
  return put(std::string(kMagic) + text_of(records) + (has_end ? std::string(kMagic) : ""), data, size,
             max_size);
}
