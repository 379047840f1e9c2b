// SPDX-License-Identifier: Apache-2.0
#include "live_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "report/page.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

constexpr const char* kWaitingPage = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta http-equiv="refresh" content="2"><title>gridmerge</title>
<style>body { font: 16px/1.5 system-ui, sans-serif; margin: 4rem auto; max-width: 32rem; padding: 0 1rem }</style>
</head><body><h1>Merged maps</h1><p>No map was heard yet. This page shows the maps as soon as there are any.</p></body></html>
)";

/// Pages on which readers may still be at work. A page that nobody works on shows the newest answer.
constexpr std::size_t kMostShown = 3;

LiveReportPage page_of(const TeamAnswer& answer) {
  const TeamMerge& merge = *answer.merge;
  if (merge.maps.empty()) return {kWaitingPage, {}};
  std::vector<OccupancyGrid> maps;
  for (const auto& map : merge.maps) maps.push_back(*map);
  return live_report_page({merge.names, maps, merge_result(answer)}, answer.number);
}

}  // namespace

void LivePage::show(std::shared_ptr<const TeamAnswer> answer) {
  const std::lock_guard lock(mutex_);
  answer_ = std::move(answer);
}

std::shared_ptr<const TeamAnswer> LivePage::newest() const {
  const std::lock_guard lock(mutex_);
  return answer_;
}

PageAnswers LivePage::answers() {
  PageAnswers answers;
  answers.page = [this] { return page(); };
  answers.news = [this] { return fmt::format("{{\"answer\": {}}}\n", newest()->number); };
  answers.refine = [this](const std::string& body) {
    return answer_refine(
        body, [this](const std::string& merge) { return maps_of(merge); }, threads_);
  };
  return answers;
}

std::shared_ptr<const std::string> LivePage::page() {
  const std::shared_ptr<const TeamAnswer> answer = newest();
  if (page_answer_ == answer) return page_;
  LiveReportPage made;
  with_threads(threads_, [&] { made = page_of(*answer); });
  page_ = std::make_shared<const std::string>(std::move(made.html));
  page_answer_ = answer;
  if (answer->merge->maps.empty()) return page_;  // nobody is at work on the page that waits
  const std::lock_guard lock(mutex_);
  std::erase_if(shown_, [&](const Shown& shown) { return shown.merge == made.merge; });
  shown_.push_front({std::move(made.merge), answer->merge->maps});
  if (shown_.size() > kMostShown) shown_.pop_back();
  return page_;
}

ShownMaps LivePage::maps_of(const std::string& merge) const {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(shown_.begin(), shown_.end(), [&](const Shown& shown) { return shown.merge == merge; });
  if (found == shown_.end()) throw OtherMerge();
  return found->maps;
}

}  // namespace gridmerge::cli
