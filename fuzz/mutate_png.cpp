// SPDX-License-Identifier: Apache-2.0
// Changes a PNG by the chunk, and the rows before they are deflated, then makes its checksums anew: with a
// wrong one a decoder looks no further.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mutator.hpp"

namespace {

using namespace gridmerge::fuzz;

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kHeaderBytes = 13;
constexpr std::size_t kMaxRows = 1 << 16;  // bytes of them

struct Chunk {
  std::string type;  // four letters
  std::string data;
};

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char byte : bytes.substr(0, 4)) value = value << 8 | static_cast<std::uint8_t>(byte);
  return value;
}

std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

// The chunks that are whole.
std::vector<Chunk> chunks_of(std::string_view bytes) {
  std::vector<Chunk> chunks;
  if (!bytes.starts_with(kSignature)) return chunks;
  bytes.remove_prefix(kSignature.size());
  while (bytes.size() >= 12) {
    const std::size_t size = big_endian(bytes);
    if (size > bytes.size() - 12) break;
    chunks.push_back({std::string(bytes.substr(4, 4)), std::string(bytes.substr(8, size))});
    bytes.remove_prefix(12 + size);
  }
  return chunks;
}

std::string png_of(const std::vector<Chunk>& chunks) {
  std::string png(kSignature);
  for (const auto& [type, data] : chunks) {
    const std::string signed_part = type + data;
    const auto sum =
        crc32(0, reinterpret_cast<const Bytef*>(signed_part.data()), static_cast<uInt>(signed_part.size()));
    png += big_endian(static_cast<std::uint32_t>(data.size())) + signed_part +
           big_endian(static_cast<std::uint32_t>(sum));
  }
  return png;
}

std::string inflated(const std::string& deflated) {
  std::string rows(kMaxRows, '\0');
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(deflated.data()));
  stream.avail_in = static_cast<uInt>(deflated.size());
  stream.next_out = reinterpret_cast<Bytef*>(rows.data());
  stream.avail_out = static_cast<uInt>(rows.size());
  inflate(&stream, Z_FINISH);
  rows.resize(stream.total_out);
  inflateEnd(&stream);
  return rows;
}

std::string deflated(const std::string& rows) {
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
           rows.size());
  packed.resize(size);
  return packed;
}

// The rows of all IDAT chunks, changed, in one of them or, now and then, in two.
void change_rows(std::vector<Chunk>& chunks, Random& random) {
  const auto is_data = [](const Chunk& chunk) { return chunk.type == "IDAT"; };
  const auto first = std::ranges::find_if(chunks, is_data);
  if (first == chunks.end()) return;
  const std::ptrdiff_t place = first - chunks.begin();
  std::string packed;
  for (const Chunk& chunk : chunks)
    if (is_data(chunk)) packed += chunk.data;
  std::erase_if(chunks, is_data);
  packed = deflated(with_changed_bytes(inflated(packed), 256));
  const std::size_t cut = random() % 4 == 0 ? below(packed.size(), random) : packed.size();
  if (cut < packed.size()) chunks.insert(chunks.begin() + place, {"IDAT", packed.substr(cut)});
  chunks.insert(chunks.begin() + place, {"IDAT", packed.substr(0, cut)});
}

// A header of sizes, depth and colours that rows may be of.
void change_header(Chunk& chunk, Random& random) {
  std::string& header = chunk.data;
  header.resize(kHeaderBytes);
  constexpr std::array<char, 5> kDepths{1, 2, 4, 8, 16}, kColours{0, 2, 3, 4, 6};
  switch (random() % 6) {
    case 0:
      header.replace(0, 4, big_endian(static_cast<std::uint32_t>(1 + below(64, random))));
      break;
    case 1:
      header.replace(4, 4, big_endian(static_cast<std::uint32_t>(1 + below(64, random))));
      break;
    case 2:
      header[8] = any_of(kDepths, random);
      break;
    case 3:
      header[9] = any_of(kColours, random);
      break;
    case 4:
      header[12] = static_cast<char>(header[12] == 0);  // interlaced
      break;
    default:
      header = with_changed_bytes(std::move(header), 0);
  }
}

void change(std::vector<Chunk>& chunks, Random& random) {
  constexpr std::array kTypes{"PLTE", "tRNS", "gAMA", "bKGD", "sBIT", "tEXt",
                              "zTXt", "iCCP", "IDAT", "IEND", "XXXX", "xxxx"};
  const std::size_t place = below(chunks.size(), random);
  Chunk& chunk = chunks[place];
  switch (random() % 8) {
    case 0:
    case 1:
      change_rows(chunks, random);
      break;
    case 2:
    case 3:
      change_header(chunks.front(), random);
      break;
    case 4:
      chunk.data = with_changed_bytes(std::move(chunk.data));
      break;
    case 5:
      std::swap(chunk, any_of(chunks, random));
      break;
    case 6:
      if (chunks.size() > 1) chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(place));
      break;
    default:
      chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(place),
                    {any_of(kTypes, random), std::string(below(8, random) * 3, static_cast<char>(random()))});
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  Random random(seed);
  std::vector<Chunk> chunks = chunks_of({reinterpret_cast<const char*>(data), size});
  if (chunks.empty() || random() % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);
  for (std::size_t changes = 1 + below(3, random); changes > 0; --changes) change(chunks, random);
  return put(png_of(chunks), data, size, max_size);
}
