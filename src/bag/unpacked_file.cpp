// SPDX-License-Identifier: Apache-2.0
#include "bag/unpacked_file.hpp"

#include <fmt/format.h>

#include <vector>

#include "bag/byte_source.hpp"
#include "io/blaming.hpp"

namespace gridmerge::internal {

UnpackedFile::UnpackedFile(const std::filesystem::path& packed, std::uint64_t max_bytes) : file_(packed) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  const RandomAccessFile file(packed);
  const auto source = unpack_zstd(file_part(file, 0, file.size()));
  std::vector<char> piece(kStep);
  blaming(packed, [&] {
    for (std::size_t got = kStep; got == kStep;) {
      got = source->read(piece.data(), kStep);
      if (file_.size() + got > max_bytes)
        throw ParseError(
            fmt::format("unpacks to more than {} bytes: unpack it yourself (zstd -d)", max_bytes));
      file_.append({piece.data(), got});
    }
  });
}

}  // namespace gridmerge::internal
