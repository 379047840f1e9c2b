// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <future>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gridmerge/dds/ros_node.hpp"

namespace gridmerge::test {

/// A domain that no other test on this machine has while this process runs: each is held by a locked file.
inline std::uint32_t free_domain() {
  constexpr int kDomains = 100;  // beyond it their ports are those that the system hands out
  for (int i = 0; i < kDomains; ++i) {
    const int domain = 1 + (::getpid() + i) % kDomains;
    const std::string path = "/tmp/gridmerge-test-domain-" + std::to_string(domain);
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) return static_cast<std::uint32_t>(domain);
    if (file >= 0) ::close(file);
  }
  throw std::runtime_error("all domains are taken");
}

/// This process's domain, and the variables of ROS that say so: all of it stays on this machine.
inline std::uint32_t own_domain() {
  static const std::uint32_t kDomain = free_domain();
  ::setenv("ROS_DOMAIN_ID", std::to_string(kDomain).c_str(), 1);
  ::setenv("ROS_LOCALHOST_ONLY", "1", 1);
  for (const char* name :
       {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "CYCLONEDDS_URI", "ROS_SECURITY_ENABLE"})
    ::unsetenv(name);
  return kDomain;
}

/// Waits until something holds. A minute is far more than it takes anywhere; it ends a test that would never
/// end.
inline bool comes_true(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < end) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

/// A node that runs in a thread of its own.
class RunningNode {
 public:
  explicit RunningNode(RosNodeOptions options) : node_(told(std::move(options))) {
    end_ = std::async(std::launch::async, [this] { return node_.run(); });
  }
  ~RunningNode() { node_.stop(); }
  RunningNode(const RunningNode&) = delete;
  RunningNode& operator=(const RunningNode&) = delete;

  /// Waits for the end by itself.
  RosNode::End end() { return end_.get(); }
  RosNode::End stop() {
    node_.stop();
    return end_.get();
  }
  std::string describe() const { return node_.describe(); }

  /// Whether a line that it told or warned of holds this.
  bool said(const std::string& part) const { return times_said(part) > 0; }
  /// How many of them do.
  std::ptrdiff_t times_said(const std::string& part) const {
    const std::lock_guard lock(mutex_);
    return std::count_if(lines_.begin(), lines_.end(),
                         [&](const std::string& line) { return line.find(part) != std::string::npos; });
  }
  /// All of it, for messages of tests.
  std::string lines() const {
    const std::lock_guard lock(mutex_);
    std::string text;
    for (const std::string& line : lines_) text += line + "\n";
    return text;
  }

 private:
  RosNodeOptions told(RosNodeOptions options) {
    options.tell = options.warn = [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      lines_.push_back(line);
    };
    return options;
  }

  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
  RosNode node_;
  std::future<RosNode::End> end_;  // goes first, and waits for the thread
};

}  // namespace gridmerge::test
