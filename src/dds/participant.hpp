// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dds/entity.hpp"
#include "dds/environment.hpp"
#include "dds/network.hpp"

namespace gridmerge::internal {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPtr = std::unique_ptr<dds_qos_t, QosDeleter>;

/// What makes a participant a node of ROS, in the environment's enclave. With the enclave's files it takes
/// part in DDS Security.
QosPtr participant_qos(const RosEnvironment& environment);

/// A participant of a DDS domain, with Cyclone DDS set up for it. One at a time in a process: what Cyclone
/// DDS logs goes to whoever set its sink last.
class Participant {
 public:
  /// `network` are the addresses of this machine. Throws std::runtime_error, with what Cyclone DDS says of
  /// it, when the configuration or the network does not let it in.
  Participant(const RosEnvironment& environment, std::uint64_t largest_message,
              const NetworkAddresses& network = network_addresses());
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  dds_entity_t get() const { return participant_.get(); }
  const dds_guid_t& guid() const { return guid_; }

  /// What Cyclone DDS warned of, and how often: `text` is the first of its kind.
  struct LogLine {
    std::string kind;  // kind_of_line()
    std::string text;
    std::uint64_t count = 1;
  };

  /// What it warned of since it was last asked, at most kMaxLogLines lines: beyond it, further kinds are one
  /// that has no name.
  std::vector<LogLine> take_log();
  /// Messages of peers that were no such messages at all.
  std::uint64_t undecodable() const;

  static constexpr std::size_t kMaxLogLines = 32;

 private:
  class Log;

  std::unique_ptr<Log> log_;  // outlives what logs
  DdsEntity domain_;
  DdsEntity participant_;
  dds_guid_t guid_{};
};

}  // namespace gridmerge::internal
