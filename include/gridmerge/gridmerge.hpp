// SPDX-License-Identifier: Apache-2.0
/// All that is installed of what most programs use: match two maps, merge many, read and write them.
#pragma once

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/match/measure.hpp"
#include "gridmerge/version.hpp"

#if __has_include("gridmerge/merge/merge.hpp")
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merger.hpp"
#include "gridmerge/merge/plan.hpp"
#endif
#if __has_include("gridmerge/online/team.hpp")
#include "gridmerge/online/team.hpp"
#endif
#if __has_include("gridmerge/io/map_file.hpp")
#include "gridmerge/io/initial_poses.hpp"
#include "gridmerge/io/map_file.hpp"
#endif
#if __has_include("gridmerge/cache/match_cache.hpp")
#include "gridmerge/cache/match_cache.hpp"
#endif
#if __has_include("gridmerge/bag/bag.hpp")
#include "gridmerge/bag/bag.hpp"
#endif
#if __has_include("gridmerge/report/merge_output.hpp")
#include "gridmerge/report/merge_output.hpp"
#include "gridmerge/report/merge_record.hpp"
#endif
