// SPDX-License-Identifier: Apache-2.0
#include "bag/scratch_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "bag/random_access_file.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/durable.hpp"

namespace gridmerge::internal {

namespace {

int open_without_name(const std::filesystem::path& shown) {
  std::error_code error;
  std::filesystem::path directory = std::filesystem::temp_directory_path(error);
  if (error) directory = "/tmp";
  std::string pattern = (directory / "gridmerge-bag-XXXXXX").string();
  const int descriptor = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor < 0)
    throw FileError(shown, fmt::format("has to be unpacked, and no file can be made in {}: {}",
                                       directory.string(), std::generic_category().message(errno)));
  ::unlink(pattern.c_str());
  return descriptor;
}

}  // namespace

ScratchFile::ScratchFile(std::filesystem::path shown)
    : shown_(std::move(shown)), descriptor_(open_without_name(shown_)) {}

ScratchFile::~ScratchFile() {
  ::close(descriptor_);
}

void ScratchFile::append(std::string_view bytes) {
  if (const int error = write_all(descriptor_, bytes); error != 0)
    throw FileError(shown_, fmt::format("cannot be unpacked into the folder of temporary files: {}",
                                        std::generic_category().message(error)));
  size_ += bytes.size();
}

std::string ScratchFile::read(std::uint64_t offset, std::size_t count) const {
  std::string bytes(count, '\0');
  if (read_at(descriptor_, offset, bytes.data(), count, shown_) < count)
    throw FileError(shown_, "what it unpacked to is gone from the folder of temporary files");
  return bytes;
}

std::filesystem::path ScratchFile::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

}  // namespace gridmerge::internal
