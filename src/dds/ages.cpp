// SPDX-License-Identifier: Apache-2.0
#include "dds/ages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>

#include "dds/loan.hpp"
#include "dds/names.hpp"
#include "ros_messages.h"

namespace gridmerge::internal {

namespace {

constexpr std::int32_t kMessagesKept = 64;    // of all programs that diagnose themselves, between two looks
constexpr std::size_t kDigitsOfFraction = 9;  // nanoseconds
constexpr std::size_t kMaxDigits = 10;        // of the seconds
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // the year 2255: the clock's own end is in 2262

/// A number of digits alone.
std::optional<std::int64_t> read_digits(std::string_view text) {
  std::int64_t number = 0;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_digit)) return std::nullopt;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::optional<RobotAge> read_age(const diagnostic_msgs_msg_dds__DiagnosticStatus_& status) {
  RobotAge age;
  std::optional<TeamTime> heard_first;
  for (std::uint32_t i = 0; i < status.values._length; ++i) {
    const std::string_view key = text_of(status.values._buffer[i].key);
    const std::string_view value = text_of(status.values._buffer[i].value);
    if (key == kTopicKey) age.topic = value;
    if (key == kFrameKey) age.frame = value;
    if (key == kPublisherKey) age.publisher = value;
    if (key == kHeardFirstKey) heard_first = read_time(value);
  }
  if (!heard_first) return std::nullopt;
  age.heard_first = *heard_first;
  return age;
}

}  // namespace

std::string format_time(TeamTime time) {
  const auto since = time.time_since_epoch();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  return fmt::format("{}.{:09}", seconds.count(), std::chrono::nanoseconds(since - seconds).count());
}

std::optional<TeamTime> read_time(std::string_view text) {
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos || point > kMaxDigits) return std::nullopt;
  const std::string_view fraction = text.substr(point + 1);
  if (fraction.size() != kDigitsOfFraction) return std::nullopt;
  const std::optional<std::int64_t> seconds = read_digits(text.substr(0, point));
  const std::optional<std::int64_t> nanoseconds = read_digits(fraction);
  if (!seconds || !nanoseconds || *seconds > kMaxSeconds) return std::nullopt;
  return TeamTime(std::chrono::duration_cast<TeamTime::duration>(std::chrono::seconds(*seconds) +
                                                                 std::chrono::nanoseconds(*nanoseconds)));
}

AgeListener::AgeListener(const Participant& participant)
    // Best effort takes what anybody offers; who tells it tells it again within a second.
    : reader_(make_reader(participant.get(), kDiagnosticType, dds_topic("/diagnostics"),
                          {false, false, kMessagesKept})) {}

std::vector<RobotAge> AgeListener::take() {
  std::vector<RobotAge> ages;
  for (;;) {
    const Loan loan(reader_.get());
    if (!loan.is_there()) return ages;
    if (!loan.info().valid_data) continue;
    const auto& sample = loan.as<diagnostic_msgs_msg_dds__DiagnosticArray_>();
    for (std::uint32_t i = 0; i < sample.status._length; ++i) {
      if (std::optional<RobotAge> age = read_age(sample.status._buffer[i])) ages.push_back(std::move(*age));
    }
  }
}

}  // namespace gridmerge::internal
