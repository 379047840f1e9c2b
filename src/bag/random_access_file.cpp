// SPDX-License-Identifier: Apache-2.0
#include "bag/random_access_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"

namespace gridmerge::internal {

namespace {

[[noreturn]] void throw_errno(const std::filesystem::path& path, int error) {
  throw FileError(path, std::generic_category().message(error));
}

}  // namespace

BytesRead try_read_at(int descriptor, std::uint64_t offset, char* to, std::size_t count) {
  BytesRead read;
  while (read.count < count) {
    const ssize_t got =
        ::pread(descriptor, to + read.count, count - read.count, static_cast<off_t>(offset + read.count));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) read.error = errno;
    if (got <= 0) break;
    read.count += static_cast<std::size_t>(got);
  }
  return read;
}

std::size_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t count,
                    const std::filesystem::path& shown) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  std::size_t held = 0;
  while (held < count) {
    throw_if_cancelled();
    const std::size_t wanted = std::min(count - held, kStep);
    const BytesRead step = try_read_at(descriptor, offset + held, to + held, wanted);
    if (step.error != 0) throw_errno(shown, step.error);
    held += step.count;
    if (step.count < wanted) break;
  }
  return held;
}

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path, const std::filesystem::path& shown)
    // A pipe without a writer is not waited for.
    : path_(shown.empty() ? path : shown),
      descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) throw_errno(path_, errno);
  struct stat status {};
  const int error = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
  if (error == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::uint64_t>(status.st_size);
    return;
  }
  ::close(descriptor_);
  if (error != 0) throw_errno(path_, error);
  throw FileError(path_, "is not a regular file, which a bag has to be");
}

RandomAccessFile::~RandomAccessFile() {
  ::close(descriptor_);
}

std::size_t RandomAccessFile::read(std::uint64_t offset, char* to, std::size_t count) const {
  if (offset >= size_) return 0;
  return read_at(descriptor_, offset, to,
                 static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset)), path_);
}

std::string RandomAccessFile::read(std::uint64_t offset, std::size_t count) const {
  const std::uint64_t left = offset < size_ ? size_ - offset : 0;
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(count, left)), '\0');
  bytes.resize(read(offset, bytes.data(), bytes.size()));
  return bytes;
}

std::string_view BufferedReader::read(std::uint64_t offset, std::size_t count) {
  const bool is_held =
      offset >= begin_ && offset <= begin_ + held_.size() && count <= begin_ + held_.size() - offset;
  if (!is_held) {
    // Behind what was passed over, as much may be passed over again.
    constexpr std::size_t kFar = std::size_t{1} << 16, kAhead = std::size_t{1} << 16,
                          kFirst = std::size_t{1} << 10;
    const bool is_near = offset >= begin_ && offset - begin_ < held_.size() + kFar;
    held_ = file_.read(offset, std::max(count, is_near ? kAhead : kFirst));
    begin_ = offset;
  }
  return std::string_view(held_).substr(static_cast<std::size_t>(offset - begin_), count);
}

}  // namespace gridmerge::internal
