// SPDX-License-Identifier: Apache-2.0
#include "http_server.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <cstdint>
#include <limits>
#include <new>
#include <string>
#include <string_view>
#include <utility>

namespace gridmerge::cli {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using Tcp = asio::ip::tcp;

namespace {

constexpr std::uint32_t kMaxHead = 16U << 10;
constexpr std::uint64_t kMaxBody = std::uint64_t{1} << 20;
constexpr std::size_t kMaxConnections = 128;
constexpr std::ptrdiff_t kMaxBodies = 16;
constexpr auto kTimeOfRequest = std::chrono::seconds(10);
constexpr auto kTimeOfStep = std::chrono::seconds(10);  // that a client may take for some of its answer
// A client that is refused in the middle of its request sends on until it looks for the answer; a connection
// that is closed before would lose it.
constexpr auto kTimeToEnd = std::chrono::seconds(2);
constexpr std::size_t kMaxDropped = std::size_t{8} << 20;
constexpr auto kPause = std::chrono::milliseconds(50);  // where the system has no more descriptors

constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

using Headers = std::array<std::pair<const char*, const char*>, 6>;
constexpr Headers kHeaders{{{"X-Content-Type-Options", "nosniff"},
                            {"X-Frame-Options", "DENY"},
                            {"Content-Security-Policy", "frame-ancestors 'none'"},
                            {"Cross-Origin-Resource-Policy", "same-origin"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Cache-Control", "no-store"}}};

http::status status_of(const error_code& error, bool has_start_line) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return has_start_line ? http::status::request_header_fields_too_large : http::status::uri_too_long;
  if (error == http::error::bad_content_length || error == http::error::bad_transfer_encoding)
    return http::status::length_required;
  if (error == http::error::body_limit) return http::status::payload_too_large;
  return http::status::bad_request;
}

}  // namespace

class HttpServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(HttpServer& server, Tcp::socket socket)
      : server_(server),
        stream_(std::move(socket)),
        place_(server.connections_.insert(server.connections_.end(), this)) {
    parser_.header_limit(kMaxHead);
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // to_head() has the first word
  }
  ~Connection() { server_.connections_.erase(place_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read_head() {
    stream_.expires_after(kTimeOfRequest);  // of all that follows, until another time is set
    http::async_read_header(stream_, buffer_, parser_,
                            [self = shared_from_this()](error_code error, std::size_t) {
                              error ? self->refuse(error) : self->answer_head();
                            });
  }

  void close() {
    state_ = State::closed;
    stream_.close();
  }

  /// The request is dropped, and told to come again.
  void give_way() {
    state_ = State::giving_way;
    stream_.cancel();
  }

  bool is_closeable() const { return state_ != State::waiting && state_ != State::closed; }
  bool reads_body() const { return state_ == State::reading_body; }
  bool has_nothing_to_get() const { return is_closeable() && state_ != State::answering; }
  bool has_body() const { return state_ == State::reading_body || state_ == State::waiting; }

 private:
  enum class State { reading_head, reading_body, giving_way, waiting, answering, ending, closed };

  void refuse(const error_code& error) {
    if (error.category() != http::make_error_code(http::error::end_of_stream).category() ||
        error == http::error::end_of_stream || error == http::error::partial_message)
      return;  // the connection has ended, in whatever way
    respond(server_.answers_.to_fault(status_of(error, !parser_.get().target().empty())));
  }

  void answer_head() {
    if (auto response = server_.answers_.to_head(parser_.get())) return respond(std::move(*response));
    if (parser_.content_length() && *parser_.content_length() > kMaxBody)
      return respond(server_.answers_.to_fault(http::status::payload_too_large));
    if (!server_.make_room_for_body()) return say_busy();
    state_ = State::reading_body;
    parser_.body_limit(kMaxBody);
    if (!beast::iequals(parser_.get()[http::field::expect], "100-continue")) return read_body();
    asio::async_write(stream_, asio::buffer(kContinue),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (self->state_ == State::giving_way) return self->say_busy();
                        if (!error) self->read_body();
                      });
  }

  // Piece by piece: give_way() between two reads is not heard by an operation that consists of both.
  void read_body() {
    if (parser_.is_done()) return wait_for_answer();
    parser_.eager(true);
    http::async_read_some(stream_, buffer_, parser_,
                          [self = shared_from_this()](error_code error, std::size_t) {
                            if (self->state_ == State::giving_way) return self->say_busy();
                            error ? self->refuse(error) : self->read_body();
                          });
  }

  void say_busy() { respond(server_.answers_.to_fault(http::status::service_unavailable)); }

  void wait_for_answer() {
    state_ = State::waiting;
    stream_.expires_never();
    asio::post(server_.answering_, [self = shared_from_this(), guard = asio::make_work_guard(server_.io_)] {
      std::optional<HttpResponse> response;
      try {
        response = self->server_.answers_.to_body(self->parser_.get().body());
      } catch (const std::bad_alloc&) {
      }
      // The thread of run() has the last hold of the connection, always.
      asio::post(self->server_.io_, [self, response = std::move(response)]() mutable {
        response ? self->respond(std::move(*response)) : self->close();
      });
    });
  }

  // A client may take its time for the answer, and many may.
  void drop_request() {
    std::string().swap(parser_.get().body());
    buffer_.clear();
    buffer_.shrink_to_fit();
  }

  void respond(HttpResponse response) {
    state_ = State::answering;
    drop_request();
    body_ = std::move(response.body);
    message_.result(response.status);
    message_.version(11);
    for (const auto& [name, value] : kHeaders) message_.set(name, value);
    message_.set(http::field::connection, "close");
    message_.content_length(body_ ? body_->size() : 0);
    if (body_) message_.set(http::field::content_type, response.type);
    if (body_ && parser_.get().method() != http::verb::head) message_.body() = {body_->data(), body_->size()};
    write();
  }

  void write() {
    stream_.expires_after(kTimeOfStep);
    http::async_write_some(stream_, serializer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return;
      self->serializer_.is_done() ? self->end() : self->write();
    });
  }

  void end() {
    state_ = State::ending;
    error_code error;
    stream_.socket().shutdown(Tcp::socket::shutdown_send, error);
    stream_.expires_after(kTimeToEnd);
    if (!error && server_.acceptor_.is_open()) drop();
  }

  void drop() {
    stream_.async_read_some(asio::buffer(dropped_),
                            [self = shared_from_this()](error_code error, std::size_t count) {
                              self->count_dropped_ += count;
                              if (!error && self->count_dropped_ < kMaxDropped) self->drop();
                            });
  }

  HttpServer& server_;
  beast::tcp_stream stream_;
  std::list<Connection*>::iterator place_;
  State state_ = State::reading_head;
  beast::flat_buffer buffer_{std::size_t{2} * kMaxHead};
  http::request_parser<http::string_body> parser_;
  std::shared_ptr<const std::string> body_;
  http::response<http::span_body<const char>> message_;
  http::response_serializer<http::span_body<const char>> serializer_{message_};
  std::array<char, 4096> dropped_{};
  std::size_t count_dropped_ = 0;
};

HttpServer::HttpServer(const Tcp::endpoint& endpoint, HttpAnswers answers)
    : answers_(std::move(answers)), acceptor_(io_), pause_(io_) {
  acceptor_.open(endpoint.protocol());
  // Not SO_REUSEPORT, with which a port that another server has would not be taken.
  acceptor_.set_option(Tcp::acceptor::reuse_address(true));
  acceptor_.bind(endpoint);
  acceptor_.listen();
}

HttpServer::~HttpServer() {
  answering_.join();
}

int HttpServer::port() const {
  return acceptor_.local_endpoint().port();
}

void HttpServer::run() {
  while (true) {
    try {
      if (!is_accepting_ && acceptor_.is_open()) accept();
      io_.run();
      return;
    } catch (const std::bad_alloc&) {  // the connection whose turn it was is gone
    }
  }
}

void HttpServer::stop() {
  asio::post(io_, [this] {
    acceptor_.close();
    pause_.cancel();
    for (Connection* connection : connections_) {
      if (connection->has_nothing_to_get()) connection->close();
    }
  });
}

void HttpServer::accept() {
  acceptor_.async_accept([this](const error_code& error, Tcp::socket socket) {
    is_accepting_ = false;
    if (!acceptor_.is_open()) return;
    if (error) {
      is_accepting_ = true;
      pause_.expires_after(kPause);
      return pause_.async_wait([this](const error_code&) {
        is_accepting_ = false;
        if (acceptor_.is_open()) accept();
      });
    }
    accept();
    admit(std::move(socket));
  });
  is_accepting_ = true;
}

void HttpServer::admit(Tcp::socket socket) {
  Connection* const unfinished =
      connections_.size() < kMaxConnections ? nullptr : oldest(&Connection::is_closeable);
  if (unfinished != nullptr) unfinished->close();
  error_code ignored;
  socket.set_option(Tcp::no_delay(true), ignored);
  std::make_shared<Connection>(*this, std::move(socket))->read_head();
}

bool HttpServer::make_room_for_body() {
  const auto bodies = std::count_if(connections_.begin(), connections_.end(),
                                    [](const Connection* one) { return one->has_body(); });
  if (bodies < kMaxBodies) return true;
  Connection* const slow = oldest(&Connection::reads_body);
  if (slow != nullptr) slow->give_way();
  return slow != nullptr;
}

HttpServer::Connection* HttpServer::oldest(bool (Connection::*is_of_kind)() const) const {
  const auto found = std::find_if(connections_.begin(), connections_.end(),
                                  [&](const Connection* one) { return (one->*is_of_kind)(); });
  return found == connections_.end() ? nullptr : *found;
}

}  // namespace gridmerge::cli
