// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "console.hpp"

namespace gridmerge::cli {

/// A page asks about a merge that is not served: it was made by another server, or long ago.
class OtherMerge : public std::runtime_error {
 public:
  OtherMerge() : std::runtime_error("this page is of another merge: reload it") {}
};

/// What a PageServer says. Each may throw; what is asked for is then answered with an error.
struct PageAnswers {
  /// The page at "/". Called by the thread that serves, so that it keeps others waiting.
  std::function<std::shared_ptr<const std::string>()> page;
  /// JSON for whoever asks with GET at "/news", as the page does again and again. None: nothing is there.
  /// Called by the thread that serves.
  std::function<std::string()> news = {};
  /// Answers the body of a POST at "/refine" with JSON. Throws std::invalid_argument for a body that makes no
  /// sense, and OtherMerge. Runs under with_cancellation().
  std::function<std::string(const std::string& body)> refine;
};

/// Serves one page, and answers what it asks; nothing else is there, no file above all. For this machine's
/// user alone, as far as a server can tell: a request has to name this server as its host, so that no foreign
/// name can be made to lead here, and where a page sent it, it has to be this one. Several requests may be
/// served at once; answers to POST are made one after the other.
class PageServer {
 public:
  /// Listens at `address`, a name or number of this machine's, and `port`, 0 for a free one. Throws
  /// std::runtime_error when that cannot be had.
  PageServer(const std::string& address, int port, PageAnswers answers);
  /// As end(), with an exit code of failure, where that was not called.
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// "http://127.0.0.1:8750/".
  std::string url() const;

  /// Whether it can be reached from this machine alone.
  bool is_local() const;

  /// Calls `ready` and serves until a signal or an error ends it; from `ready` on connections are taken. An
  /// answer that is being made is cancelled then. Where a connection does not end within a second, its thread
  /// still needs what the caller would destroy, and the program is ended, with exit code 0. Throws
  /// std::runtime_error for an error, and what `ready` throws.
  void run(const std::function<void()>& ready);

  /// Serves in a thread of its own until end(). An error of the network ends that silently.
  void start();

  /// Ends what start() began, as run() ends: with this exit code, where a connection is too slow.
  void end(int exit_code);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Warns of what others can do, where they can reach the server.
void warn_of_visitors(const PageServer& server, Console& console);

}  // namespace gridmerge::cli
