// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "gridmerge/export.hpp"
#include "gridmerge/match/match.hpp"

namespace gridmerge {

/// Matches on disk, by what they are matches of: match_key(). A file of a few kilobytes holds one, in one of
/// 256 folders, with a digest of all that it holds. Several processes may use a directory at once, on one
/// machine or on a shared file system: files are written whole, and renamed into place.
///
/// A file that is damaged, or that somebody else has put there, counts as missing. Matches of other maps,
/// options or engines have other names, and so are never found.
class GRIDMERGE_EXPORT MatchCache {
 public:
  /// Takes a line for the user.
  using Warn = std::function<void(const std::string&)>;

  /// The directory is made if need be. Throws FileError, an error that names it, when it cannot be written
  /// to.
  explicit MatchCache(std::filesystem::path directory, Warn warn = {});

  /// The match of this key if there is one. Of the first file that is damaged it warns.
  std::optional<MatchResult> find(const std::string& key);

  /// Throws FileError; what was kept is as before then. May be called by several threads at once.
  void keep(const std::string& key, const MatchResult& match) const;

  /// How many damaged files were found.
  std::size_t damaged() const { return damaged_; }

  /// Tells the user something, as the cache does.
  void warn(const std::string& message) const;

 private:
  std::filesystem::path file_of(const std::string& key) const;

  std::filesystem::path directory_;
  Warn warn_;
  std::size_t damaged_ = 0;
};

}  // namespace gridmerge
