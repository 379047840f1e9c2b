// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "gridmerge/online/team.hpp"
#include "page_server.hpp"

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
  std::shared_ptr<const TeamAnswer> newest() const;
  std::shared_ptr<const TeamAnswer> shown() const;
  std::shared_ptr<const std::string> page();
  std::string refine(const std::string& body) const;

  const int threads_;
  mutable std::mutex mutex_;
  std::shared_ptr<const TeamAnswer> answer_ = std::make_shared<const TeamAnswer>();  // with mutex_ held
  std::shared_ptr<const TeamAnswer> shown_ = answer_;  // by the page that was made last; likewise
  std::shared_ptr<const std::string> page_;            // the serving thread's own
};

}  // namespace gridmerge::cli
