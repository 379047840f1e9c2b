// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace gridmerge::cli {

/// Answers the body of a request with JSON. Throws std::invalid_argument for a body that makes no sense.
using Answer = std::function<std::string(const std::string& body)>;

/// Serves one page at "/", and answers what it asks with POST at "/refine"; nothing else is there, no file
/// above all. For this machine's user alone, as far as a server can tell: a request has to name this server
/// as its host, so that no foreign name can be made to lead here, and where a page sent it, it has to be this
/// one. Several requests may be served at once; answers are made one after the other.
class PageServer {
 public:
  /// Listens at `address`, a name or number of this machine's, and `port`, 0 for a free one. Throws
  /// std::runtime_error when that cannot be had.
  PageServer(const std::string& address, int port, std::string page, Answer refine);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// "http://127.0.0.1:8750/".
  std::string url() const;

  /// Serves until a signal or an error ends it, calling `ready` when it answers. Throws std::runtime_error
  /// for an error.
  void run(const std::function<void()>& ready);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Whether an address can be reached from this machine alone.
bool is_loopback(const std::string& address);

}  // namespace gridmerge::cli
