// SPDX-License-Identifier: Apache-2.0
#include "io/file_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"

namespace gridmerge::internal {

namespace {

[[noreturn]] void throw_errno(const std::filesystem::path& path) {
  throw FileError(path, std::generic_category().message(errno));
}

}  // namespace

FileReader::FileReader(std::filesystem::path path, NamedBy named_by)
    : path_(std::move(path)),
      // A pipe without a writer would be waited for already here.
      descriptor_(
          ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | (named_by == NamedBy::file ? O_NONBLOCK : 0))) {
  if (descriptor_ < 0) throw_errno(path_);
  struct stat status {};
  const bool is_known = ::fstat(descriptor_, &status) == 0;
  if (is_known && S_ISREG(status.st_mode)) {
    size_hint_ = static_cast<std::size_t>(status.st_size);
  } else if (named_by == NamedBy::file && !S_ISDIR(status.st_mode)) {  // of a directory the system says so
    ::close(descriptor_);
    throw FileError(path_, "is not a regular file, which a file that another one names has to be");
  }
}

FileReader::~FileReader() {
  ::close(descriptor_);
}

const std::string& FileReader::read_up_to(std::size_t count) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  bytes_.reserve(std::min(count, size_hint_));
  while (bytes_.size() < count) {
    const std::size_t held = bytes_.size();
    const std::size_t step = std::min(count - held, kStep);
    bytes_.resize(held + step);
    const ssize_t got = ::read(descriptor_, bytes_.data() + held, step);
    if (got < 0 && errno != EINTR) throw_errno(path_);
    throw_if_cancelled();  // a pipe may never bring anything
    bytes_.resize(held + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0) break;
  }
  return bytes_;
}

const std::string& FileReader::read_all(std::size_t max_bytes) {
  // One byte beyond the limit tells a file that ends there from a longer one.
  read_up_to(max_bytes == std::numeric_limits<std::size_t>::max() ? max_bytes : max_bytes + 1);
  if (bytes_.size() > max_bytes) {
    throw FileError(path_, fmt::format("the file is larger than {} bytes", max_bytes));
  }
  return bytes_;
}

}  // namespace gridmerge::internal
