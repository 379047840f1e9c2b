// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>

namespace gridmerge::cli {

namespace http = boost::beast::http;

/// A request whose body is not read yet, or is never read.
using HttpHead = http::request_header<>;

struct HttpResponse {
  http::status status = http::status::ok;
  const char* type = "";                         ///< Content-Type
  std::shared_ptr<const std::string> body = {};  ///< none: no body, and no type
};

/// What a server says. Where memory runs out (std::bad_alloc) the connection is closed without an answer.
struct HttpAnswers {
  /// Once the head is read. None: the body is to be read. Called by the thread of run().
  std::function<std::optional<HttpResponse>(const HttpHead&)> to_head;
  /// Of the requests whose bodies were read, one after the other, by a thread of its own.
  std::function<HttpResponse(const std::string& body)> to_body;
  /// A request that cannot be read any further.
  std::function<HttpResponse(http::status)> to_fault;
};

/// Serves HTTP 1.1, one request a connection, within bounds: a head of at most 16 KiB (414 and 431), a body
/// of at most 1 MiB (413), ten seconds for the whole request, 128 connections, 16 bodies. Where there is no
/// room for one more, the oldest connection that still sends its request or takes its answer is closed, and
/// the oldest body that is not whole yet is refused (503); so whoever is slow keeps nobody else waiting.
/// Where 16 requests wait for their answers the next is refused. All connections share one thread.
class HttpServer {
 public:
  /// Listens at once. Throws boost::system::system_error.
  HttpServer(const boost::asio::ip::tcp::endpoint& endpoint, HttpAnswers answers);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

  /// Serves until stop(). Memory that runs out costs a connection, not the server.
  void run();

  /// From any thread: takes no more connections, and closes all that have no answer to get; run() returns
  /// when the others have theirs.
  void stop();

 private:
  class Connection;

  void accept();
  void admit(boost::asio::ip::tcp::socket socket);
  /// False if all that there may be wait for their answers.
  bool make_room_for_body();
  /// None: nullptr.
  Connection* oldest(bool (Connection::*is_of_kind)() const) const;

  HttpAnswers answers_;
  std::list<Connection*> connections_;  // the oldest first
  boost::asio::io_context io_{1};       // after what its connections leave when it goes
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  bool is_accepting_ = false;
  boost::asio::thread_pool answering_{1};
};

}  // namespace gridmerge::cli
