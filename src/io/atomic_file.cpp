// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "io/destination.hpp"
#include "io/durable.hpp"
#include "io/temporary_file.hpp"

namespace gridmerge::internal {

StagedFile::StagedFile(std::filesystem::path path) : path_(std::move(path)) {
  check_destination(path_);
  // A link such as /dev/stdout can lead to a regular file: a rename must not take the place of the link.
  std::error_code absent;
  if (std::filesystem::exists(path_, absent) && std::filesystem::is_symlink(path_, absent))
    path_ = std::filesystem::canonical(path_);
  remove_abandoned(path_.parent_path());
  TemporaryFile created = create_beside(path_);
  descriptor_ = created.descriptor;
  temporary_ = std::move(created.path);
}

StagedFile::StagedFile(std::filesystem::path path, std::string_view bytes) : StagedFile(std::move(path)) {
  append(bytes);
  flush();
}

StagedFile::~StagedFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  ::close(descriptor_);
}

void StagedFile::append(std::string_view bytes) {
  is_flushed_ = false;
  if (const int error = write_all(descriptor_, bytes); error != 0) fail_to_write(path_, error);
}

void StagedFile::flush() {
  if (const int error = flush_descriptor(descriptor_); error != 0) fail_to_write(path_, error);
  is_flushed_ = true;
}

void StagedFile::hand_over(const std::filesystem::path& name) {
  if (!is_flushed_) flush();
  if (std::rename(temporary_.c_str(), name.c_str()) != 0) fail_to_write(path_, errno);
  temporary_.clear();
}

void StagedFile::commit() {
  hand_over(path_);
  if (const int error = flush_path(path_.parent_path()); error != 0) fail_to_write(path_, error);
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  StagedFile(path, bytes).commit();
}

}  // namespace gridmerge::internal
