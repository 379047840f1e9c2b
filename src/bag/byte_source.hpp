// SPDX-License-Identifier: Apache-2.0
// Streams of bytes that are read once, from the beginning: part of a file, and what it unpacks to. However
// much that is, no more of it is in memory than is asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "bag/random_access_file.hpp"

namespace gridmerge::internal {

/// A stream of bytes.
class ByteSource {
 public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// Reads up to `count` bytes; fewer only where the stream ends. Throws ParseError for what does not unpack,
  /// FileError for a file that cannot be read.
  virtual std::size_t read(char* to, std::size_t count) = 0;
};

/// The bytes of a file from `begin` on, up to `end`. The file must outlive it.
std::unique_ptr<ByteSource> file_part(const RandomAccessFile& file, std::uint64_t begin, std::uint64_t end);

/// The bytes of a text, which must outlive it.
std::unique_ptr<ByteSource> text_source(std::string_view text);

/// What the frames of a Zstandard stream unpack to. Windows above 128 MiB are refused.
std::unique_ptr<ByteSource> unpack_zstd(std::unique_ptr<ByteSource> packed);

/// What the frames of an LZ4 stream unpack to.
std::unique_ptr<ByteSource> unpack_lz4(std::unique_ptr<ByteSource> packed);

/// Whether bytes begin as a Zstandard frame does.
bool looks_like_zstd(std::string_view bytes);

/// All that is left of the stream. Throws ParseError where it is more than `max_bytes`.
std::string read_all(ByteSource& source, std::size_t max_bytes);

}  // namespace gridmerge::internal
