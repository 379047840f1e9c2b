// SPDX-License-Identifier: Apache-2.0
#include "page_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <future>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "address.hpp"
#include "gridmerge/grid/cancellation.hpp"
#include "interrupt.hpp"

namespace gridmerge::cli {

namespace {

constexpr std::size_t kMaxBody = std::size_t{1} << 20;
constexpr auto kGrace = std::chrono::seconds(1);  // for connections that are open when the server ends
constexpr int kPlainHttpPort = 80;                // the one that a URL leaves out

/// As it stands in a URL.
std::string host_of(const std::string& address) {
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

/// `number` is what browsers make of an address such as "127.1".
std::set<std::string> own_hosts(const std::string& address, const std::string& number, int port) {
  std::set<std::string> hosts;
  for (const std::string& host : {std::string("127.0.0.1"), std::string("localhost"), std::string("[::1]"),
                                  host_of(address), host_of(number)}) {
    hosts.insert(fmt::format("{}:{}", host, port));
    if (port == kPlainHttpPort) hosts.insert(host);
  }
  return hosts;
}

void set_error(httplib::Response& response, int status, const std::string& error) {
  response.status = status;
  const nlohmann::json json{{"error", error}};
  response.set_content(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n",
                       "application/json");
}

/// What the library itself refuses.
const char* explain(int status) {
  switch (status) {
    case 404:
      return "there is nothing here";
    case 413:
      return "the body is longer than 1 MiB";
    default:
      return "the request cannot be understood";
  }
}

struct Refusal {
  int status = 0;
  const char* error = nullptr;
};

/// What is wrong with a request before anyone looks at its body; {} when nothing is. The library would read
/// whatever body comes with any method, and one without a Content-Length to its end.
Refusal find_fault(const httplib::Request& request, const std::set<std::string>& hosts) {
  if (request.get_header_value_count("Host") != 1 || !hosts.contains(request.get_header_value("Host")))
    return {403, "the request is for another host"};
  if (request.has_header("Origin")) {
    constexpr std::string_view kScheme = "http://";
    const std::string origin = request.get_header_value("Origin");
    if (!origin.starts_with(kScheme) || !hosts.contains(origin.substr(kScheme.size())))
      return {403, "the request is from another site's page"};
  }
  if (request.method == "GET" || request.method == "HEAD") return {};
  if (request.method != "POST") return {404, explain(404)};
  const std::string type = request.get_header_value("Content-Type");
  if (type.substr(0, type.find(';')) != "application/json")
    return {415, "the body has to be application/json"};
  // What a few bytes unfold to has no bound.
  if (request.has_header("Content-Encoding")) return {415, "the body has to be as it is, not compressed"};
  if (request.has_header("Transfer-Encoding") || request.get_header_value_count("Content-Length") != 1)
    return {411, "the body's length has to be told, in one Content-Length"};
  return {};
}

/// Not shared: with SO_REUSEPORT, as the library would have it, a port that another server has is not taken.
void set_socket_options(socket_t socket) {
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

}  // namespace

class PageServer::State {
 public:
  State(std::string address, int port, std::string page, Answer refine)
      : address_(std::move(address)), page_(std::move(page)), refine_(std::move(refine)) {
    server_.set_socket_options(set_socket_options);
    bind(port);
    set_limits();
    set_routes();
  }

  std::string url() const { return fmt::format("http://{}:{}/", host_of(address_), port_); }

  bool is_local() const { return bound_.is_loopback; }

  void run(const std::function<void()>& ready) {
    const Interrupt interrupt;
    ready();  // the socket listens already; before there is a thread, as this may throw
    std::packaged_task<bool()> serve([this] { return server_.listen_after_bind(); });
    std::future<bool> served = serve.get_future();
    std::thread listener([&] {
      serve();
      interrupt.raise();
    });
    interrupt.wait();
    stop(served);
    listener.join();
    if (!served.get()) throw std::runtime_error("the server at " + url() + " cannot go on");
  }

 private:
  /// Throws std::runtime_error when it cannot be done.
  void bind(int port) {
    errno = 0;
    for (const Address& address : resolve(address_)) {
      errno = 0;
      // By its number, so that it is this one and no other that the name may stand for.
      port_ = port == 0                                    ? server_.bind_to_any_port(address.number)
              : server_.bind_to_port(address.number, port) ? port
                                                           : -1;
      if (port_ <= 0) continue;
      bound_ = address;
      hosts_ = own_hosts(address_, address.number, port_);
      return;
    }
    const std::string cause =
        errno == 0 ? "there is no such address" : std::generic_category().message(errno);
    throw std::runtime_error(fmt::format("cannot serve at {}:{}: {}{}", host_of(address_), port, cause,
                                         errno == EADDRINUSE ? "; choose another --port" : ""));
  }

  void stop(const std::future<bool>& served) {
    stopping_ = true;
    // Before it runs it cannot be stopped, and it may have ended without ever being seen to run.
    while (!server_.is_running() &&
           served.wait_for(std::chrono::milliseconds(1)) == std::future_status::timeout) {
    }
    server_.stop();
    if (served.wait_for(kGrace) == std::future_status::ready) return;
    std::fflush(nullptr);
    std::_Exit(EXIT_SUCCESS);
  }

  void set_limits() {
    server_.set_payload_max_length(kMaxBody);
    // A connection that asks nothing holds up the end of the program.
    server_.set_keep_alive_max_count(1);
    server_.set_keep_alive_timeout(1);
    server_.set_read_timeout(2);
    server_.set_tcp_nodelay(true);
    server_.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                 {"X-Frame-Options", "DENY"},
                                 {"Content-Security-Policy", "frame-ancestors 'none'"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Cache-Control", "no-store"}});
  }

  void set_routes() {
    using Outcome = httplib::Server::HandlerResponse;
    // The library would send each range of a long list, of an error's text too: no text, then.
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      if (request.has_header("Range")) {
        response.status = 416;
        return Outcome::Handled;
      }
      const Refusal refusal = find_fault(request, hosts_);
      if (refusal.error == nullptr) return Outcome::Unhandled;
      set_error(response, refusal.status, refusal.error);
      return Outcome::Handled;
    });
    server_.Get("/", [this](const httplib::Request& /*request*/, httplib::Response& response) {
      response.set_content(page_, "text/html; charset=utf-8");
    });
    server_.Post("/refine", [this](const httplib::Request& request, httplib::Response& response) {
      answer(request.body, response);
    });
    server_.set_error_handler([](const httplib::Request& request, httplib::Response& response) {
      if (response.body.empty() && !request.has_header("Range"))
        set_error(response, response.status, explain(response.status));
    });
    server_.set_exception_handler(
        [](const httplib::Request& /*request*/, httplib::Response& response,
           const std::exception_ptr& /*error*/) { set_error(response, 500, "failed"); });
  }

  std::string refine(const std::string& body) {
    const std::lock_guard lock(answering_);
    std::string json;
    with_cancellation(stopping_, [&] {
      throw_if_cancelled();
      json = refine_(body);
    });
    return json;
  }

  void answer(const std::string& body, httplib::Response& response) {
    try {
      response.set_content(refine(body), "application/json");
    } catch (const Cancelled&) {
      set_error(response, 503, "the server has been ended");
    } catch (const std::invalid_argument& error) {
      set_error(response, 400, error.what());
    } catch (const std::bad_alloc&) {
      set_error(response, 500, "out of memory");
    } catch (const std::exception& error) {
      set_error(response, 500, error.what());
    }
  }

  std::string address_;
  std::string page_;
  Answer refine_;
  std::mutex answering_;
  std::atomic<bool> stopping_ = false;
  int port_ = 0;
  Address bound_;
  std::set<std::string> hosts_;  // by which requests may call it
  httplib::Server server_;
};

PageServer::PageServer(const std::string& address, int port, std::string page, Answer refine)
    : state_(std::make_unique<State>(address, port, std::move(page), std::move(refine))) {}
PageServer::~PageServer() = default;

std::string PageServer::url() const {
  return state_->url();
}

void PageServer::run(const std::function<void()>& ready) {
  state_->run(ready);
}

bool PageServer::is_local() const {
  return state_->is_local();
}

}  // namespace gridmerge::cli
