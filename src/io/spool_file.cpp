// SPDX-License-Identifier: Apache-2.0
#include "io/spool_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <string>
#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "io/durable.hpp"
#include "io/temporary_file.hpp"

namespace gridmerge::internal {

SpoolFile::SpoolFile(std::filesystem::path beside) : beside_(std::move(beside)) {
  const TemporaryFile created = create_beside(beside_);
  ::unlink(created.path.c_str());
  descriptor_ = created.descriptor;
}

SpoolFile::~SpoolFile() {
  ::close(descriptor_);
}

void SpoolFile::append(std::string_view bytes) {
  if (const int error = write_all(descriptor_, bytes); error != 0) fail_to_write(beside_, error);
  size_ += bytes.size();
}

void SpoolFile::copy_to(StagedFile& file) const {
  std::string piece(std::size_t{1} << 20, '\0');
  for (std::uint64_t at = 0; at < size_;) {
    throw_if_cancelled();
    const ssize_t count = ::pread(descriptor_, piece.data(), piece.size(), static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail_to_write(beside_, count < 0 ? errno : EIO);
    file.append({piece.data(), static_cast<std::size_t>(count)});
    at += static_cast<std::uint64_t>(count);
  }
}

}  // namespace gridmerge::internal
