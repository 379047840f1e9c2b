// SPDX-License-Identifier: Apache-2.0
#include "io/durable.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace gridmerge::internal {

std::string describe_errno(int error) {
  return std::generic_category().message(error);
}

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// Some file systems have no such call; their word is all there is then.
int flush_descriptor(int descriptor) {
  while (::fsync(descriptor) != 0) {
    if (errno == EINVAL || errno == ENOTSUP) return 0;
    if (errno != EINTR) return errno;
  }
  return 0;
}

int flush_path(const std::filesystem::path& path) {
  const int descriptor = ::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_CLOEXEC);
  // A directory that may be written to but not listed cannot be flushed.
  if (descriptor < 0) return errno == EACCES ? 0 : errno;
  const int error = flush_descriptor(descriptor);
  ::close(descriptor);
  return error;
}

}  // namespace gridmerge::internal
