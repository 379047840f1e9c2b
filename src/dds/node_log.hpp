// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dds/line_limiter.hpp"
#include "dds/listener.hpp"
#include "dds/participant.hpp"
#include "gridmerge/online/team.hpp"

namespace gridmerge::internal {

/// Tells people what happens to a node: a few lines of each kind, since peers decide how many there are.
class NodeLog {
 public:
  using Write = std::function<void(const std::string& line)>;

  NodeLog(Write tell, Write warn);

  /// What happened.
  void tell(const std::string& kind, const std::string& line);
  /// What should not have.
  void warn(const std::string& kind, const std::string& line, std::uint64_t count = 1);

  void tell_events(const std::vector<TeamEvent>& events);
  /// Whose publishers have gone since the last call.
  void tell_gone(const std::vector<HeardRobot>& robots);
  /// Whose transforms are withheld that were not at the last call, each with why.
  void warn_of_withheld(const std::map<std::string, std::string>& withheld);
  void warn_of_dds(const std::vector<Participant::LogLine>& lines);
  /// How many lines followed those that were written. To be called now and then.
  void tell_more();

  /// How often DDS warned.
  std::uint64_t dds_warnings() const { return dds_warnings_; }

 private:
  static constexpr std::size_t kEventsOfAKind = 3;  // of one robot, that are told at once

  LineLimiter told_;
  LineLimiter warned_;
  std::map<std::string, std::size_t> publishers_;  // of each robot that was heard
  std::map<std::string, std::string> withheld_;
  std::uint64_t dds_warnings_ = 0;
};

}  // namespace gridmerge::internal
