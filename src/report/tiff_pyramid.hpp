// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "io/spool_file.hpp"

namespace gridmerge::internal {

/// A picture of occupancies in percent that is too large to be held: a cloud-optimised GeoTIFF, in tiles of
/// 512 x 512 pixels, with overviews, each of half the size of the one before. It is drawn from its top, a row
/// of tiles at a time.
///
/// Written here, for the libraries of Debian that write TIFF need one under the GPL.
class TiffPyramid {
 public:
  static constexpr int kTile = 512;
  static constexpr std::uint8_t kUnknown = 255;

  /// For a file that is to be `file`, on whose disk tiles wait. Throws FileError.
  TiffPyramid(const std::filesystem::path& file, int width, int height);
  ~TiffPyramid();

  int width() const;
  int height() const;
  /// How many rows of pixels the next row of tiles has: kTile, or what is left; 0 at the end.
  int rows_left() const;

  /// The next rows_left() rows, `width` bytes each. Runs in the calling TBB arena. Throws FileError.
  /// O(bytes).
  void add_rows(const std::vector<std::uint8_t>& rows);

  /// Where the picture lies, in its own file.
  struct Place {
    Point2 top_left;          ///< the corner of the first pixel [m]
    double resolution = 1.0;  ///< [m] a pixel
    std::string frame;        ///< what to call the frame
    std::string description;  ///< of the picture
  };

  /// Writes all of it, once all rows are there. Throws FileError. O(bytes of the file).
  void write(StagedFile& file, const Place& place) const;

 private:
  struct Level;
  void add_tiles(std::size_t level);

  std::vector<std::unique_ptr<Level>> levels_;  // the picture itself, then its overviews
};

}  // namespace gridmerge::internal
