// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "internal_export.hpp"
#include "io/atomic_file.hpp"
#include "io/directory_lock.hpp"

namespace gridmerge::internal {

/// Files of one directory that belong together and are replaced together. At every point of time, and so
/// after a kill at any point, who opens them by name finds all old ones or all new ones; other files of the
/// directory stay.
///
/// No call renames several files at once, but a name may be a link, and one rename turns a link that all
/// names lead through:
///
///     merged.yaml -> .gridmerge.tmp/current/merged.yaml      .gridmerge.tmp/current -> old, then new
///
/// commit() puts such links in the place of the old files, which are in `old` as well by then, turns
/// `current`, and puts the new files in the place of the links. No step but the turn changes what a name
/// shows. A set that a killed program has left so is put in order by the next one in the same directory, and
/// staged files of killed programs are removed.
/// Where the file system has no symbolic links (FAT), files are renamed one after the other, in the order of
/// add().
///
/// Every file is flushed to the disk before the turn, and the directories before and after it.
class GRIDMERGE_INTERNAL_EXPORT FileSet {
 public:
  using IfMissing = DirectoryLock::IfMissing;

  /// Waits for other writers to this directory, and keeps them waiting while this object lives. A directory
  /// that was made goes with an object that commits nothing. Throws FileError, and Cancelled.
  explicit FileSet(std::filesystem::path directory, IfMissing if_missing = IfMissing::fail);
  /// Without commit() all is as it was before.
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// A file of the new set; a link of its name is replaced, not followed. Each name once. Throws FileError,
  /// and Cancelled.
  void add(const std::string& name, std::string_view bytes);
  /// The same of a file that was staged in this directory, and is not committed then.
  void add(StagedFile& file);
  /// Where a file that was added can be read until commit().
  std::filesystem::path staged(const std::string& name) const;
  /// A file of the old set that has no successor.
  void remove(const std::string& name);
  /// Once only. Throws FileError: then the set is the old one, or, if it could not be tidied up after the
  /// turn, the new one.
  void commit();

 private:
  void keep_old(const std::string& name);
  void put_link(const std::string& name);
  void replace_one_by_one();

  std::filesystem::path directory_;
  DirectoryLock lock_;
  std::vector<std::string> added_;
  std::vector<std::string> removed_;
};

/// Throws FileError, and Cancelled, unless a set can be made in a directory, which is made for that if need
/// be, and not kept. Waits for another writer, and puts in order what a killed one has left.
GRIDMERGE_INTERNAL_EXPORT void check_directory(const std::filesystem::path& directory);

}  // namespace gridmerge::internal
