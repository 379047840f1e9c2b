// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "gridmerge/online/team.hpp"
#include "page_server.hpp"
#include "refine_answer.hpp"

namespace gridmerge::cli {

/// The report page of a team's newest answer, made when somebody asks for it. Until there is a map, a page
/// that says so and loads itself anew.
class LivePage {
 public:
  explicit LivePage(int threads) : threads_(threads) {}

  /// From any thread. O(1).
  void show(std::shared_ptr<const TeamAnswer> answer);

  /// For a server that this outlives.
  PageAnswers answers();

 private:
  struct Shown {
    std::string merge;  ///< as its page calls it
    ShownMaps maps;
  };

  std::shared_ptr<const TeamAnswer> newest() const;
  std::shared_ptr<const std::string> page();
  /// Throws OtherMerge.
  ShownMaps maps_of(const std::string& merge) const;

  const int threads_;
  mutable std::mutex mutex_;
  std::shared_ptr<const TeamAnswer> answer_ = std::make_shared<const TeamAnswer>();  // with mutex_ held
  std::deque<Shown> shown_;  // by the pages that were made last, the newest first; likewise
  // The serving thread's own.
  std::shared_ptr<const TeamAnswer> page_answer_;
  std::shared_ptr<const std::string> page_;
};

}  // namespace gridmerge::cli
