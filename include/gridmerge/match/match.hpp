// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/match/random_walk_match.hpp"

namespace gridmerge {

namespace internal {
class DrawnWalls;
}

/// A map with all that matches of it have in common, so that it is worked out once and not for every other
/// map that it is matched with. May be used by several threads at once.
class GRIDMERGE_EXPORT PreparedMap {
 public:
  /// Copies what robots have seen of `grid`. Painted cells become unknown: occupied ones with no free cell
  /// within 0.15 m (at least three cells) of them, measured along rows and along columns. So nothing is left
  /// of a drawing in which no cell is free. Throws std::invalid_argument for an invalid grid (see
  /// validate()). O(cells).
  explicit PreparedMap(const OccupancyGrid& grid);
  ~PreparedMap();

  const OccupancyGrid& known() const { return known_; }  ///< cropped, and turned by quarters
  const CellCounts& counts() const { return counts_; }   ///< of known()

 private:
  friend class internal::DrawnWalls;
  /// `known` as a prepared map has it.
  PreparedMap(OccupancyGrid known, const CellCounts& counts);

  OccupancyGrid known_;
  CellCounts counts_;
  std::unique_ptr<internal::DrawnWalls> drawn_;
};

/// How match() searches the poses of a pair.
enum class SearchMethod {
  exhaustive,   ///< the quick look; the thorough one as well where that leaves the pair undecided
  quick,        ///< every pose, coarsely: finds what overlaps much
  thorough,     ///< by the way walls face, too: finds what overlaps little, in a few times the time
  random_walk,  ///< match_by_random_walk(): as Birk & Carpin (2006), with their acceptance index
};

/// A method: the one place where its name and meaning stand.
struct SearchMethodName {
  SearchMethod method;  ///< which one
  const char* name;     ///< as the command line, Python and outputs spell it
  const char* meaning;  ///< in a few words
};

/// All of them.
GRIDMERGE_EXPORT std::span<const SearchMethodName> search_methods();

/// "exhaustive", ...
GRIDMERGE_EXPORT const char* name_of(SearchMethod method);

/// The method of that name; none if there is none.
GRIDMERGE_EXPORT std::optional<SearchMethod> search_method(std::string_view name);

/// The scales at which a moving map is tried: by how much it may be too small, and how much too large.
struct ScaleRange {
  double least = 1.0;  ///< the smallest factor that the moving map is enlarged by
  double most = 1.0;   ///< the largest one, no less
};

inline constexpr double kMinScale = 1e-3;       ///< the least end of a ScaleRange
inline constexpr double kMaxScale = 1e3;        ///< the largest one
inline constexpr double kMaxScaleRatio = 20.0;  ///< of a range's larger end by its smaller one

/// Throws std::invalid_argument, with a message that begins with "scales", for a range that makes no sense.
GRIDMERGE_EXPORT void validate(const ScaleRange& scales);

/// How two maps are matched.
struct MatchOptions {
  SearchMethod search = SearchMethod::exhaustive;  ///< how poses are found
  /// If given, the moving map may have any scale of this range, as an architect's plan has: match() looks at
  /// scales 3 % apart, fits the scale of the best poses, and gives it in MatchResult::scale. The fixed map's
  /// metres count. The look at each scale is the quick one unless SearchMethod::thorough is asked for, which
  /// takes four times as long. Not for SearchMethod::random_walk, prepared maps or merging.
  std::optional<ScaleRange> scales = std::nullopt;
  /// Of SearchMethod::random_walk, which has its own rule of acceptance. Its threads, number of hypotheses
  /// and progress are those below.
  RandomWalkMatchOptions random_walk = {};
  int threads = 0;                   ///< worker threads; 0 = one per core. The result does not depend on it.
  std::size_t max_hypotheses = 10;   ///< how many distinct hypotheses the result lists; up to 18 are judged
  double accept_probability = 0.95;  ///< the verdict is `accepted` from this probability on
  /// Called now and then with the share of the work that is done, in [0, 1]; never from two threads at once.
  std::function<void(double)> progress;
};

/// Throws std::invalid_argument for options that make no sense; `random_walk` is looked at only if it is the
/// search.
GRIDMERGE_EXPORT void validate(const MatchOptions& options);

/// What the verdict says, in words: "the maps disagree where both know the same places". `accept_probability`
/// as it was asked for. Of the random walk, which knows no reasons, the acceptance index tells more.
GRIDMERGE_EXPORT std::string explain(const MatchResult& result,
                                     double accept_probability = MatchOptions{}.accept_probability);

/// Finds how `moving` lies on `fixed`, searching every pose, and says whether to believe it.
/// Throws std::invalid_argument for an invalid grid or option (see validate()), and with `scales` for a map
/// without walls.
GRIDMERGE_EXPORT MatchResult match(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                   const MatchOptions& options = {});

/// The same of maps that are matched with several others: of their known parts. Runs in the calling TBB
/// arena (with_threads()), for which `options.threads` changes nothing; may be called by several threads at
/// once. Throws std::invalid_argument for invalid options, and for `scales` and the random walk, which need
/// more of a map than is prepared.
GRIDMERGE_EXPORT MatchResult match(const PreparedMap& fixed, const PreparedMap& moving,
                                   const MatchOptions& options = {});

/// A pose that somebody proposed, put right.
struct RefinedPose : PairPose {
  double score = 0.0;        ///< log-likelihood ratio "same place" against "unrelated" [nats]
  double start_score = 0.0;  ///< the same of the pose that was proposed
  double moved = 0.0;        ///< root mean square displacement of the moving map's walls from there [m]
};

/// Climbs from `T_start` to the local maximum of the evidence near it: the best one that is reached from
/// poses within about a metre and seven degrees of it, by the evidence by which match() ranks its hypotheses.
/// Where none is better than the start, that is the answer. With cells of less than 2 cm it looks less far
/// than a metre: 50 to 100 cells, the more the larger the maps.
///
/// The probability is what match() would give to the pose were it one of its hypotheses: the same model of
/// the same figures, against all distinct hypotheses of a full search. Where another pose explains the maps
/// better the probability is below a half; where the pose explains nothing it is 0. That somebody proposed
/// the pose counts for nothing in it.
///
/// Throws std::invalid_argument for a start that is not finite. Neither pose nor figures depend on which map
/// is called fixed, but for rounding, nor on the number of threads. Runs in the calling TBB arena; about
/// twice the time of match().
GRIDMERGE_EXPORT RefinedPose refine_pose(const PreparedMap& fixed, const PreparedMap& moving,
                                         const SE2& T_start);

}  // namespace gridmerge
