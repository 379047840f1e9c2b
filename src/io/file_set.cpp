// SPDX-License-Identifier: Apache-2.0
#include "io/file_set.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/destination.hpp"
#include "io/directory_names.hpp"
#include "io/durable.hpp"
#include "io/temporary_file.hpp"

namespace gridmerge::internal {

namespace {

namespace fs = std::filesystem;

constexpr const char* kWork = ".gridmerge.tmp";
constexpr const char* kCurrent = "current";
constexpr const char* kOld = "old";
constexpr const char* kNew = "new";

[[noreturn]] void fail(const fs::path& path, int error) {
  throw FileError(path, "cannot be written: " + describe_errno(error));
}

/// For calls that return 0 or set errno. `path` is what the user knows of.
void check(int result, const fs::path& path) {
  if (result != 0) fail(path, errno);
}

void flush(const fs::path& directory, const fs::path& path) {
  if (const int error = flush_path(directory); error != 0) fail(path, error);
}

fs::path current(const std::string& name) {
  return fs::path(kWork) / kCurrent / name;
}

/// The names in the directory that are links of ours.
std::vector<std::string> linked_names(const fs::path& directory) {
  std::error_code error;
  std::vector<std::string> names = names_in(directory, error);
  if (error) throw fs::filesystem_error("cannot be read", directory, error);
  std::erase_if(names, [&](const std::string& name) {
    std::error_code no_link;
    return fs::read_symlink(directory / name, no_link) != current(name);
  });
  return names;
}

/// Puts in the place of each link what it leads to, and takes away what a set was made with. Each step leaves
/// what the names show as it is, so it may end anywhere and begin again. Throws FileError.
void settle(const fs::path& directory) {
  const fs::path work = directory / kWork;
  struct stat status {};
  if (::lstat(work.c_str(), &status) != 0 && errno == ENOENT) return;
  if (!S_ISDIR(status.st_mode)) throw FileError(work, "is in the way of what is to be written");
  try {
    for (const std::string& name : linked_names(directory)) {
      const fs::path link = directory / name;
      if (std::rename((directory / current(name)).c_str(), link.c_str()) == 0) continue;
      if (errno != ENOENT) fail(link, errno);
      check(::unlink(link.c_str()), link);
    }
    flush(directory, directory);
    remove_directory(work);
  } catch (const fs::filesystem_error& error) {
    throw FileError(directory, "cannot be written to: " + error.code().message());
  }
}

/// A file system such as FAT, which has no links. Folders that a virtual machine shares with its host say
/// that they are read-only, or speak of the protocol, though files can be written.
bool has_no_links(int error) {
  return error == EPERM || error == ENOSYS || error == ENOTSUP || error == EOPNOTSUPP || error == EROFS ||
         error == EPROTO || error == EINVAL;
}

}  // namespace

FileSet::FileSet(fs::path directory, IfMissing if_missing)
    : directory_(directory.empty() ? "." : std::move(directory)), lock_(directory_, if_missing) {
  settle(directory_);
  remove_abandoned(directory_);
  const fs::path work = directory_ / kWork;
  check(::mkdir(work.c_str(), 0777), directory_);
  if (::mkdir((work / kNew).c_str(), 0777) == 0) return;
  const int error = errno;
  ::rmdir(work.c_str());
  fail(directory_, error);
}

FileSet::~FileSet() {
  try {
    settle(directory_);
  } catch (const std::exception&) {  // the next set in this directory tries again
  }
}

void FileSet::add(const std::string& name, std::string_view bytes) {
  throw_if_cancelled();
  const fs::path path = directory_ / name;
  check_destination(path);
  const int descriptor = ::open(staged(name).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(path, errno);
  int error = write_all(descriptor, bytes);
  if (error == 0) error = flush_descriptor(descriptor);
  ::close(descriptor);
  if (error != 0) fail(path, error);
  added_.push_back(name);
}

void FileSet::add(StagedFile& file) {
  throw_if_cancelled();
  const std::string name = file.path().filename().string();
  check_destination(directory_ / name);
  file.hand_over(staged(name));
  added_.push_back(name);
}

fs::path FileSet::staged(const std::string& name) const {
  return directory_ / kWork / kNew / name;
}

void FileSet::remove(const std::string& name) {
  removed_.push_back(name);
}

// The same file under a second name, or a copy of it.
void FileSet::keep_old(const std::string& name) {
  const fs::path path = directory_ / name, kept = directory_ / kWork / kOld / name;
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return;
  if (::linkat(AT_FDCWD, path.c_str(), AT_FDCWD, kept.c_str(), AT_SYMLINK_FOLLOW) == 0) return;
  check_destination(path);
  std::error_code error;
  fs::copy_file(path, kept, error);
  if (!error) error = {flush_path(kept), std::generic_category()};
  if (error) throw FileError(path, "cannot be replaced: " + error.message());
}

void FileSet::put_link(const std::string& name) {
  const fs::path link = directory_ / kWork / "link", path = directory_ / name;
  check(::symlink(current(name).c_str(), link.c_str()), path);
  check(std::rename(link.c_str(), path.c_str()), path);
}

void FileSet::commit() {
  const fs::path work = directory_ / kWork;
  if (::symlink(kOld, (work / kCurrent).c_str()) != 0) {
    if (!has_no_links(errno)) fail(directory_, errno);
    return replace_one_by_one();
  }
  check(::mkdir((work / kOld).c_str(), 0777), directory_);
  std::vector<std::string> names = added_;
  names.insert(names.end(), removed_.begin(), removed_.end());
  for (const std::string& name : names) keep_old(name);
  for (const char* part : {kOld, kNew, ""}) flush(work / part, directory_);
  for (const std::string& name : names) put_link(name);
  flush(directory_, directory_);

  check(::symlink(kNew, (work / "next").c_str()), directory_);
  check(std::rename((work / "next").c_str(), (work / kCurrent).c_str()), directory_);  // the turn
  flush(work, directory_);
  settle(directory_);
}

void FileSet::replace_one_by_one() {
  for (const std::string& name : added_) {
    const fs::path path = directory_ / name;
    check(std::rename(staged(name).c_str(), path.c_str()), path);
  }
  for (const std::string& name : removed_) check(::unlink((directory_ / name).c_str()), directory_ / name);
  flush(directory_, directory_);
}

void check_directory(const fs::path& directory) {
  const FileSet trial(directory, FileSet::IfMissing::make);
}

}  // namespace gridmerge::internal
