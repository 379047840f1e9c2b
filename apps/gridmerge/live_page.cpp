// SPDX-License-Identifier: Apache-2.0
#include "live_page.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "refine_answer.hpp"
#include "report/page.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

constexpr const char* kWaitingPage = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta http-equiv="refresh" content="2"><title>gridmerge</title>
<style>body { font: 16px/1.5 system-ui, sans-serif; margin: 4rem auto; max-width: 32rem; padding: 0 1rem }</style>
</head><body><h1>Merged maps</h1><p>No map was heard yet. This page shows the maps as soon as there are any.</p></body></html>
)";

std::string page_of(const TeamAnswer& answer) {
  const TeamMerge& merge = *answer.merge;
  if (merge.maps.empty()) return kWaitingPage;
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
  answers.refine = [this](const std::string& body) { return refine(body); };
  return answers;
}

std::shared_ptr<const TeamAnswer> LivePage::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

std::shared_ptr<const std::string> LivePage::page() {
  const std::shared_ptr<const TeamAnswer> answer = newest();
  if (!page_ || shown() != answer) {
    std::string made;
    with_threads(threads_, [&] { made = page_of(*answer); });
    page_ = std::make_shared<const std::string>(std::move(made));
    const std::lock_guard lock(mutex_);
    shown_ = answer;
  }
  return page_;
}

std::string LivePage::refine(const std::string& body) const {
  // The question numbers the maps as the page does that asks, which may not be of the newest answer.
  const std::shared_ptr<const TeamAnswer> answer = shown();
  const auto& maps = answer->merge->maps;
  return answer_refine(
      body, maps.size(), [&](std::size_t i) -> const OccupancyGrid& { return *maps[i]; }, threads_);
}

}  // namespace gridmerge::cli
