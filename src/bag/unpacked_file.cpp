// SPDX-License-Identifier: Apache-2.0
#include "bag/unpacked_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include "bag/byte_source.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

struct Temporary {
  std::filesystem::path path;
  int descriptor;
};

Temporary make_temporary(const std::filesystem::path& packed) {
  std::error_code error;
  std::filesystem::path directory = std::filesystem::temp_directory_path(error);
  if (error) directory = "/tmp";
  std::string pattern = (directory / "gridmerge-bag-XXXXXX").string();
  const int descriptor = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor < 0)
    throw FileError(packed, fmt::format("has to be unpacked, and no file can be made in {}: {}",
                                        directory.string(), std::generic_category().message(errno)));
  return {pattern, descriptor};
}

void write_all(int descriptor, const char* bytes, std::size_t count, const std::filesystem::path& packed) {
  while (count > 0) {
    const ssize_t written = ::write(descriptor, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0)
      throw FileError(packed, fmt::format("cannot be unpacked into the folder of temporary files: {}",
                                          std::generic_category().message(errno)));
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

void unpack(const std::filesystem::path& packed, int descriptor, std::uint64_t max_bytes) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  const RandomAccessFile file(packed);
  const auto source = unpack_zstd(file_part(file, 0, file.size()));
  std::vector<char> piece(kStep);
  std::uint64_t total = 0;
  try {
    for (std::size_t got = kStep; got == kStep;) {
      got = source->read(piece.data(), kStep);
      total += got;
      if (total > max_bytes)
        throw FileError(
            packed, fmt::format("unpacks to more than {} bytes: unpack it yourself (zstd -d)", max_bytes));
      write_all(descriptor, piece.data(), got, packed);
    }
  } catch (const ParseError& error) {
    throw FileError(packed, error.what());
  }
}

}  // namespace

UnpackedFile::UnpackedFile(const std::filesystem::path& packed, std::uint64_t max_bytes) {
  const Temporary temporary = make_temporary(packed);
  try {
    unpack(packed, temporary.descriptor, max_bytes);
    path_ = temporary.path;
  } catch (...) {
    ::close(temporary.descriptor);
    ::unlink(temporary.path.c_str());
    throw;
  }
  ::close(temporary.descriptor);
}

UnpackedFile::~UnpackedFile() {
  ::unlink(path_.c_str());
}

}  // namespace gridmerge::internal
