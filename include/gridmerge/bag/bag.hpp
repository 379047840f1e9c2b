// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/io/map_file.hpp"

namespace gridmerge {

/// A topic of maps that has no map with cells: its robot had not seen anything yet.
class GRIDMERGE_EXPORT EmptyTopic : public FileError {
 public:
  using FileError::FileError;
};

/// A topic of a bag.
struct BagTopic {
  std::string name;            ///< as ROS has it: "/tb1/map"
  std::string type;            ///< of its messages: "nav_msgs/msg/OccupancyGrid"
  std::string encoding;        ///< of its messages: ROS 2 writes "cdr"
  std::uint64_t messages = 0;  ///< how many there are
};

namespace internal {
class BagContent;
}

/// A recording of ROS 2: a file `.mcap` (its chunks plain, or packed by lz4 or zstd; with a summary or
/// without), a file `.db3` (SQLite), or a rosbag2 folder, which has a `metadata.yaml`. Each file may be
/// packed as a whole by zstd, and so may each message. Files are told apart by content, not by name.
///
/// A file is hostile until parsed: what it claims is checked before memory is taken for it, and its checksums
/// (of chunks and summaries of MCAP) have to be right. Nothing is written to it or beside it, except that
/// SQLite needs a file of its own where a recorder left a log (`-wal`). What has to be unpacked at once, or
/// is out of the order of its times, is kept in the folder of temporary files, without a name. Copies read
/// the same files: one thread at a time.
class GRIDMERGE_EXPORT Bag {
 public:
  /// Opens a bag, and lists its topics. Of `options` only `max_cells` counts. Throws FileError.
  /// O(topics) for an MCAP file with a summary, O(messages) for a `.db3`, O(bytes) for an MCAP without a
  /// summary and for a packed file, which is unpacked into the folder of temporary files.
  explicit Bag(const std::filesystem::path& path, const LoadOptions& options = {});
  ~Bag();
  /// Both read the same files then.
  Bag(const Bag&);
  /// Both read the same files then.
  Bag& operator=(const Bag&);

  /// All topics, in order of their names.
  const std::vector<BagTopic>& topics() const;

  /// Those that hold maps (nav_msgs/msg/OccupancyGrid), and at least one.
  std::vector<BagTopic> map_topics() const;

  /// What it was opened by.
  const std::filesystem::path& path() const;

  /// The files that it consists of.
  const std::vector<std::filesystem::path>& files() const;

 private:
  friend class BagMaps;
  std::shared_ptr<internal::BagContent> content_;
};

/// A map as it was at one moment of a recording.
struct BagMap {
  OccupancyGrid grid;      ///< its origin is that of the message, with the yaw of its quaternion
  std::string frame_id;    ///< the frame that the message names
  std::int64_t time = 0;   ///< when the message was recorded [ns since 1970, or whatever the clock had]
  bool is_update = false;  ///< whether an update of a part made it so
  std::vector<MapWarning> warnings;  ///< of the messages up to here
};

/// The maps of a topic, in the order in which they were recorded: each whole map
/// (nav_msgs/msg/OccupancyGrid), and each map that an update (map_msgs/msg/OccupancyGridUpdate, of the topic
/// `<topic>_updates`) makes of the one before.
///
/// Values are read as nav2 reads map files of mode `raw`: see grid_of_percentages(). Other values than -1 and
/// 0 to 100 are unknown, an orientation of four zeros is none; a map without cells, and an update that
/// reaches beyond its map, are passed over; `warnings` tell of them.
class GRIDMERGE_EXPORT BagMaps {
 public:
  /// A topic by its name, whose first '/' may be left out; "" stands for the only topic of maps. Throws
  /// FileError where there is no such topic, or more than one, and says which there are.
  /// O(bytes of the chunks, or messages, in which the topic is).
  explicit BagMaps(const Bag& bag, const std::string& topic = {});
  ~BagMaps();
  /// The other has nothing left: no topic, no messages, no maps.
  BagMaps(BagMaps&&) noexcept;
  /// Likewise.
  BagMaps& operator=(BagMaps&&) noexcept;

  /// The topic's whole name.
  const std::string& topic() const;

  /// How many messages there are, of whole maps and of updates.
  std::size_t messages() const;

  /// How many of them are of updates.
  std::size_t updates() const;

  /// The next map, or nothing when there are no more. Throws FileError for a message that is damaged or
  /// exceeds the limit; the one after it comes with the next call. O(cells).
  std::optional<BagMap> next();

  /// The last map of the topic, its updates applied; what next() gives is not changed. Throws EmptyTopic
  /// where there is none, and FileError where a message that it needs is damaged. O(cells and updates since).
  BagMap last();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The name of a map wherever it is, as the command line takes it: a file or folder, and a topic of it:
/// "robot.mcap#/tb1/map".
struct MapName {
  std::filesystem::path file;  ///< a map file, a bag or a rosbag2 folder
  std::string topic;           ///< "" = none is named
};

/// Takes a name apart at its last '#'. A name that is a file's as it stands is that file's.
GRIDMERGE_EXPORT MapName parse_map_name(const std::filesystem::path& name);

/// The name of a topic's map: parse_map_name() takes it apart again.
GRIDMERGE_EXPORT std::filesystem::path format_map_name(const MapName& name);

/// Which map a name is of, by whichever path it names its file: to find equal ones among many.
struct MapIdentity {
  std::uint64_t device = 0;  ///< that holds the file
  std::uint64_t file = 0;    ///< its number there
  std::string topic;         ///< without a slash before it; "" = none is named

  /// Whether they are of one map, and an order.
  friend auto operator<=>(const MapIdentity&, const MapIdentity&) = default;
};

/// Which map that is; none if its file is not there. Throws nothing.
GRIDMERGE_EXPORT std::optional<MapIdentity> map_identity(const std::filesystem::path& name);

/// Whether two names are of one map: the same topic, or none, of one file, by whichever path. A file that is
/// not there is the same as none. Throws nothing.
GRIDMERGE_EXPORT bool is_same_map(const std::filesystem::path& a, const std::filesystem::path& b);

/// Whether it is a bag by its content, or a folder that has a metadata.yaml. False for what cannot be read.
GRIDMERGE_EXPORT bool is_bag(const std::filesystem::path& path);

/// Reads the map of that name: a map file as load_map() does, or the last map of a bag's topic as
/// BagMaps::last() does; without a topic that of the only topic of maps. Throws FileError: the same as these
/// two, and for a topic of what is no bag. It says of a ROS 1 bag what reads it.
GRIDMERGE_EXPORT LoadedMap load_any_map(const std::filesystem::path& name, const LoadOptions& options = {});

/// The files that load_any_map() reads: those that map_files() tells, or a bag's. Throws FileError.
GRIDMERGE_EXPORT std::vector<std::filesystem::path> any_map_files(const std::filesystem::path& name,
                                                                  const LoadOptions& options = {});

}  // namespace gridmerge
