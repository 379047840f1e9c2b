// SPDX-License-Identifier: Apache-2.0
#include "dds/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace gridmerge::internal {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_';
}

/// The levels between slashes of a name that begins with one.
std::vector<std::string_view> levels_of(std::string_view name) {
  std::vector<std::string_view> levels;
  while (!name.empty()) {
    name.remove_prefix(1);
    const std::string_view level = name.substr(0, name.find('/'));
    levels.push_back(level);
    name.remove_prefix(level.size());
  }
  return levels;
}

/// Why ROS has no name like this, apart from `*` if `stars`; empty if it may have one.
std::string find_fault(std::string_view name, bool stars) {
  if (!name.starts_with('/')) return "does not begin with '/'";
  if (name.size() > kLongestTopic) return fmt::format("has more than {} characters", kLongestTopic);
  for (const std::string_view level : levels_of(name)) {
    if (level.empty()) return "has an empty level";
    if (is_digit(level.front())) return fmt::format("has the level '{}', which begins with a digit", level);
    for (const char c : level) {
      if (!is_name_character(c) && !(stars && c == '*'))
        return "has characters other than letters, digits, '_' and '/'" +
               std::string(stars ? " and '*'" : "");
    }
    if (stars && level != "**" && level.find("**") != std::string_view::npos)
      return fmt::format("has '**' within the level '{}': it stands for whole levels", level);
  }
  return {};
}

bool level_matches(std::string_view pattern, std::string_view level) {
  // Where the last star stands, and how much it has taken so far, to be given more.
  std::size_t p = 0;
  std::size_t l = 0;
  std::optional<std::pair<std::size_t, std::size_t>> star;
  while (l < level.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = {p++, l};
    } else if (p < pattern.size() && pattern[p] == level[l]) {
      ++p;
      ++l;
    } else if (star) {
      p = star->first + 1;
      l = ++star->second;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

bool levels_match(const std::vector<std::string_view>& pattern, const std::vector<std::string_view>& levels) {
  // reaches[j]: the pattern so far matches the first j levels.
  std::vector<char> reaches(levels.size() + 1, 0);
  reaches[0] = 1;
  for (const std::string_view part : pattern) {
    std::vector<char> next(levels.size() + 1, 0);
    for (std::size_t j = 1; j <= levels.size(); ++j) {
      next[j] =
          part == "**" ? reaches[j - 1] || next[j - 1] : reaches[j - 1] && level_matches(part, levels[j - 1]);
    }
    reaches = std::move(next);
  }
  return reaches.back() != 0;
}

}  // namespace

bool is_topic_name(std::string_view name) {
  return find_fault(name, false).empty();
}

TopicPattern::TopicPattern(std::string pattern) : pattern_(std::move(pattern)) {
  const std::string fault = find_fault(pattern_, true);
  if (!fault.empty()) throw std::invalid_argument("no topic is like '" + pattern_ + "': it " + fault);
}

bool TopicPattern::matches(std::string_view topic) const {
  return is_topic_name(topic) && levels_match(levels_of(pattern_), levels_of(topic));
}

std::optional<std::string> TopicPattern::last_level() const {
  const std::string_view last = levels_of(pattern_).back();
  if (last.find('*') != std::string_view::npos) return std::nullopt;
  return std::string(last);
}

RobotNames::RobotNames(const std::vector<TopicPattern>& patterns) {
  by_namespace_ =
      !patterns.empty() && std::all_of(patterns.begin(), patterns.end(), [&](const TopicPattern& one) {
        return one.last_level() && one.last_level() == patterns.front().last_level();
      });
}

std::string RobotNames::operator()(std::string_view topic) const {
  const std::string_view name = topic.substr(1);
  const std::size_t end = name.rfind('/');
  return std::string(by_namespace_ ? name.substr(0, end) : name);
}

std::optional<std::string> ros_topic(std::string_view dds_topic) {
  if (!dds_topic.starts_with("rt/")) return std::nullopt;
  std::string name(dds_topic.substr(2));
  if (!is_topic_name(name)) return std::nullopt;
  return name;
}

std::string dds_topic(std::string_view ros_topic) {
  return "rt" + std::string(ros_topic);
}

std::string ros_type(std::string_view dds_type) {
  constexpr std::string_view kMiddle = "::msg::dds_::";
  const std::size_t middle = dds_type.find(kMiddle);
  if (middle == std::string_view::npos || !dds_type.ends_with('_')) return std::string(dds_type);
  const std::size_t name = middle + kMiddle.size();
  return fmt::format("{}/msg/{}", dds_type.substr(0, middle),
                     dds_type.substr(name, dds_type.size() - 1 - name));
}

}  // namespace gridmerge::internal
