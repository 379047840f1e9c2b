// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmerge::test {

/// A connection to a port of this machine, closed with the object.
class Connection {
 public:
  explicit Connection(int port);
  ~Connection();
  Connection(Connection&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  Connection& operator=(Connection&&) = delete;

  /// False once the other side has gone.
  bool send(const std::string& bytes) const;
  /// What comes until the other side ends, or until nothing has come for so long.
  std::string receive(int seconds) const;

 private:
  int descriptor_;
};

using HttpHeaders = std::vector<std::pair<std::string, std::string>>;

struct HttpAnswer {
  int status = 0;
  HttpHeaders headers;
  std::string body;

  bool has_header(const std::string& name) const;
  /// "" where there is none.
  std::string header(const std::string& name) const;
};

/// Asks a server at a port of this machine, one request a connection.
class HttpClient {
 public:
  explicit HttpClient(int port) : port_(port) {}

  /// Nothing when what comes is no answer. `headers` may name another Host.
  std::optional<HttpAnswer> ask(const std::string& method, const std::string& path,
                                const HttpHeaders& headers = {}, const std::string& body = "") const;
  std::optional<HttpAnswer> get(const std::string& path, const HttpHeaders& headers = {}) const;
  std::optional<HttpAnswer> post(const std::string& path, const std::string& body, const std::string& type,
                                 HttpHeaders headers = {}) const;

 private:
  int port_;
};

}  // namespace gridmerge::test
