// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// What a building is like.
enum class BuildingKind {
  office,     ///< corridors between rows of rooms, many of one width
  hall,       ///< a large room with pillars, recesses and a few side rooms
  warehouse,  ///< long rows of racks that look alike
  apartment,  ///< few small rooms, much furniture
  symmetric,  ///< two wings that are one another turned by half a turn; only what stands in them differs
  loop,       ///< a corridor around a core, rooms outside
  curved,     ///< a corridor along an arc, radial and slanted walls
  outdoor,    ///< a fenced yard: houses at odd angles, trees, bushes, parked cars
  corridor,  ///< one long corridor along the longer side, perhaps bent or branched, with few doors and niches
  arena,  ///< blocks and pillars that lie on themselves after half or a quarter turn; up to 5 pillars do not
  maze,   ///< ways between walls that have no thickness, with some loops
  bare,   ///< a hall without furniture: walls, recesses, a few side rooms, perhaps pillars
};

/// All kinds, in the order above.
GRIDMERGE_EXPORT std::span<const BuildingKind> building_kinds();

/// As the command line and Python spell it.
GRIDMERGE_EXPORT const char* name_of(BuildingKind kind);

/// The kind of that name; none if there is none.
GRIDMERGE_EXPORT std::optional<BuildingKind> building_kind(std::string_view name);

/// A straight edge that stops a laser beam. Metres, in the building's frame.
struct Edge {
  Point2 a;           ///< one end
  Point2 b;           ///< the other end
  double echo = 1.0;  ///< probability that a beam which meets the edge ends there; glass lets most pass
};

inline constexpr double kGlass = 0.7;  ///< the echo of a window

/// What stands still: walls, windows, pillars, furniture.
struct Building {
  BuildingKind kind = BuildingKind::office;  ///< what it was drawn as
  double width = 0.0;                        ///< [m], along x; the lower left corner is near the origin
  double height = 0.0;                       ///< [m], along y
  std::vector<Edge> edges;                   ///< what stops a beam
};

inline constexpr double kMinBuildingSide = 8.0;    ///< [m]
inline constexpr double kMaxBuildingSide = 500.0;  ///< [m]

/// Throws std::invalid_argument, saying what is wrong, for a building that cannot be: sides that are not
/// positive or above kMaxBuildingSide, edges that end farther than this beyond a side, echoes outside [0, 1].
/// O(edges).
GRIDMERGE_EXPORT void validate(const Building& building);

/// An invented building of about `width` x `height` metres. The same arguments give the same building.
/// Throws std::invalid_argument for sides outside [kMinBuildingSide, kMaxBuildingSide]. O(area); O(area^2)
/// for an arena, a quarter of a second at the largest.
GRIDMERGE_EXPORT Building make_building(BuildingKind kind, double width, double height, std::uint64_t seed);

/// The building as a map in its own frame, `resolution` metres per cell: edges occupied, floor that can be
/// reached free, the rest unknown. Throws std::invalid_argument for a building that cannot be, a resolution
/// outside [0.01, 1], and a map of more than kMaxGridCells. O(cells).
GRIDMERGE_EXPORT OccupancyGrid draw_building(const Building& building, double resolution);

/// A scanning laser range finder.
struct RangeFinder {
  double field_of_view = 4.71238898038469;    ///< [rad], about the heading: 270 degrees
  double angular_step = 0.00872664625997165;  ///< between two beams [rad]: half a degree
  double range = 8.0;                         ///< [m]: what is farther gives no echo
  double cleared_share = 0.5;                 ///< of the range: what a beam without an echo counts as free
  double noise = 0.02;                        ///< standard deviation of a range [m]
  double stray_share = 0.002;  ///< beams that end before what they should meet: dust, edges, people
  double missed_share = 0.02;  ///< beams that come back with nothing
};

/// Throws std::invalid_argument, saying what is wrong, for a range finder that cannot be.
GRIDMERGE_EXPORT void validate(const RangeFinder& sensor);

/// What maps are wanted. Metres and radians.
struct SimulateOptions {
  BuildingKind kind = BuildingKind::office;  ///< of the building
  double width = 40.0;                       ///< of the building [m]
  double height = 25.0;                      ///< [m]
  int robots = 2;                            ///< how many maps are wanted
  /// Wanted overlap in [0, 1]: the mean over the robots of the largest share of its known area that it has in
  /// common with another one (of the smaller of the two). It is reached by how far robots go from where they
  /// start. Without it each goes wherever it can.
  std::optional<double> overlap;
  /// Where robots start, in the building's frame, one per robot; empty spreads them over the floor.
  std::vector<Point2> starts;
  /// Which way robots set off, in the building's frame, one per robot [rad]; empty lets them go anywhere. A
  /// robot with a heading looks that way at first, and goes only to places that lie ahead of its start: two
  /// that set off back to back part for good.
  std::vector<double> headings;
  double longest_way = 0.0;   ///< a robot stops after so much way [m]; 0 = when it has seen all it wants
  RangeFinder sensor;         ///< of each robot
  double robot_radius = 0.2;  ///< [m]: where it fits through
  double scan_every = 0.3;    ///< of way [m]
  /// How much the maps bend: 0 not at all, 1 as hand-held mapping does, by several decimetres over a floor.
  double drift = 0.3;
  /// How much stands and walks about that another robot, at another time, does not meet: 0 nothing, 1 a box
  /// or chair on every 25 square metres and a walker on every 150.
  double clutter = 1.0;
  double resolution = 0.05;  ///< of the maps [m/cell]
  /// Keep each robot's map at so many moments, after equal parts of its way (SimulatedMap::steps).
  int steps = 1;
  /// Draw as mappers do that clean up after themselves: without specks, and with walls so much thicker on
  /// each side [m]; as the range finder left them, if not given.
  std::optional<double> tidy;
  std::uint64_t seed = 1;  ///< of everything that chance decides
  int threads = 0;         ///< worker threads; 0 = one per core. The result does not depend on it.
  /// Called now and then with the share of the work that is done, in [0, 1]; never from two threads at once.
  std::function<void(double)> progress;
};

/// Throws std::invalid_argument, saying what is wrong, for options out of range, and for those that
/// contradict each other. What a building has no room for is seen by simulate() alone.
GRIDMERGE_EXPORT void validate(const SimulateOptions& options);

/// The map that one robot brought home.
struct SimulatedMap {
  /// In a frame of its own: origin where the robot started, turned at will. With probabilities. Cropped to
  /// what is known.
  OccupancyGrid grid;
  /// The rigid transform that lays the map best on the building (least squares over what was drawn). Exact
  /// without drift.
  SE2 T_building_map;
  double bend = 0.0;      ///< root mean square error that is left then [m]
  std::vector<SE2> path;  ///< where it scanned: true poses T_building_robot
  /// The map as it was at the moments that SimulateOptions::steps asks for, but for the last one, which is
  /// `grid`. In the same frame.
  std::vector<OccupancyGrid> earlier;
};

/// An estimate is never asked to be nearer to the truth than this [m].
inline constexpr double kMinTolerance = 0.5;

/// Two maps that share a place.
struct SimulatedPair {
  std::size_t fixed = 0;   ///< index of the map that stays
  std::size_t moving = 0;  ///< index of the map that is laid on it
  /// The rigid transform that lays the moving map best on the fixed one, over the places that both drew.
  SE2 T_fixed_moving;
  /// Largest rms_displacement() of a correct estimate [m]: half a metre, or more where the maps' bending
  /// leaves the true transform that uncertain.
  double tolerance = kMinTolerance;
  double overlap = 0.0;  ///< share of the smaller map's area that both have drawn
  /// Walls of the moving map where the fixed one knows something [m]: occupied cells times their side, so a
  /// wall that is drawn two cells wide counts twice.
  double shared_wall = 0.0;
  /// 'A': 20 m of shared wall, 80 % of it matching; 'B': 7.5 m and 60 %; 'C': less.
  char tier = 'C';
};

/// A building, the maps that robots made of it, and the truth about them.
struct Simulation {
  Building building;                                           ///< the same for all robots
  std::vector<SimulatedMap> maps;                              ///< one per robot
  std::vector<SimulatedPair> pairs;                            ///< by fixed, then moving; fixed < moving
  std::vector<std::pair<std::size_t, std::size_t>> strangers;  ///< maps that have no place in common
  double overlap = 0.0;  ///< what SimulateOptions::overlap asks for, as it came out
};

/// Invents a building, sends robots through it, and draws what each would bring home: it plans ways to what
/// it has not seen (the nearest first), scans as it goes, believes its drifting odometry as far as its own
/// map does not put it right, and draws by log-odds. Pairs that share some place, but hardly any, are in
/// neither list.
///
/// The same options give the same result on the same machine, for any number of threads. Throws
/// std::invalid_argument, saying what is wrong, for options out of range, a building in which no robot can
/// stand, starts where none can, an overlap that cannot be had, and a map of more than kMaxGridCells.
/// O(robots * way * beams), and some ten times the planning where an overlap is asked for.
GRIDMERGE_EXPORT Simulation simulate(const SimulateOptions& options);

/// The map of one robot that goes along a given way: straight from corner to corner, turning on the spot. Of
/// the options those count that say how a robot maps: `sensor`, `robot_radius`, `scan_every`, `drift`,
/// `clutter`, `resolution`, `tidy` and `seed`. `way` is in the building's frame [m]. Throws
/// std::invalid_argument, saying what is wrong, for such options out of range, a building that cannot be, a
/// way without a point, one that leaves the building's surroundings or goes through a wall, a start where no
/// robot can stand, and a map of more than kMaxGridCells. O(way * beams).
GRIDMERGE_EXPORT SimulatedMap simulate_way(const Building& building, std::span<const Point2> way,
                                           const SimulateOptions& options);

/// The options for one robot in another building of the same kind, a different one for each `number` from 0
/// on: its map is a negative.
GRIDMERGE_EXPORT SimulateOptions elsewhere(SimulateOptions options, int number);

}  // namespace gridmerge
