// SPDX-License-Identifier: Apache-2.0
#include "page_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/system/system_error.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <future>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "address.hpp"
#include "gridmerge/grid/execution.hpp"
#include "http_server.hpp"
#include "interrupt.hpp"

namespace gridmerge::cli {

namespace {

constexpr auto kGrace = std::chrono::seconds(1);  // for connections that are open when the server ends
constexpr int kPlainHttpPort = 80;                // the one that a URL leaves out

/// As it stands in a URL.
std::string host_of(const std::string& address) {
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

/// Hosts have no case, and browsers send them in small letters.
std::string in_small_letters(std::string host) {
  std::transform(host.begin(), host.end(), host.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return host;
}

/// `number` is what browsers make of an address such as "127.1".
std::set<std::string> own_hosts(const std::string& address, const std::string& number, int port) {
  std::set<std::string> hosts;
  for (const std::string& host : {std::string("127.0.0.1"), std::string("localhost"), std::string("[::1]"),
                                  host_of(address), host_of(number)}) {
    hosts.insert(in_small_letters(fmt::format("{}:{}", host, port)));
    if (port == kPlainHttpPort) hosts.insert(in_small_letters(host));
  }
  return hosts;
}

using Status = http::status;

HttpResponse error_response(Status status, const std::string& error) {
  const nlohmann::json json{{"error", error}};
  return {status, "application/json",
          std::make_shared<std::string>(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                                        "\n")};
}

const char* explain(Status status) {
  switch (status) {
    case Status::not_found:
      return "there is nothing here";
    case Status::length_required:
      return "the body's length has to be given, in one Content-Length";
    case Status::payload_too_large:
      return "the body is longer than 1 MiB";
    case Status::uri_too_long:
    case Status::request_header_fields_too_large:
      return "the request's head is longer than 16 KiB";
    case Status::service_unavailable:
      return "too many ask at once: ask again";
    default:
      return "the request cannot be understood";
  }
}

HttpResponse plain_error(Status status) {
  return error_response(status, explain(status));
}

/// What is wrong with a request before anyone looks at its body.
std::optional<HttpResponse> find_fault(const HttpHead& request, const std::set<std::string>& hosts) {
  // A long list of ranges would ask for the page as many times. No text either, as that is a range's answer.
  if (request.count(http::field::range) > 0) return HttpResponse{Status::range_not_satisfiable};
  const auto text = [&](http::field field) { return std::string(request[field]); };
  if (request.version() != 10 && request.version() != 11) return plain_error(Status::bad_request);
  if (request.count(http::field::host) != 1 || !hosts.contains(in_small_letters(text(http::field::host))))
    return error_response(Status::forbidden, "the request is for another host");
  if (request.count(http::field::origin) > 0) {
    constexpr std::string_view kScheme = "http://";
    const std::string origin = text(http::field::origin);
    if (!origin.starts_with(kScheme) || !hosts.contains(in_small_letters(origin.substr(kScheme.size()))))
      return error_response(Status::forbidden, "the request is from another site's page");
  }
  if (request.method() == http::verb::get || request.method() == http::verb::head) return std::nullopt;
  if (request.method() != http::verb::post) return plain_error(Status::not_found);
  const std::string type = text(http::field::content_type);
  if (type.substr(0, type.find(';')) != "application/json")
    return error_response(Status::unsupported_media_type, "the body has to be application/json");
  if (request.count(http::field::content_encoding) > 0)
    return error_response(Status::unsupported_media_type, "the body has to be as it is, not compressed");
  if (request.count(http::field::transfer_encoding) > 0 || request.count(http::field::content_length) != 1)
    return plain_error(Status::length_required);
  return std::nullopt;
}

}  // namespace

class PageServer::State {
 public:
  State(std::string address, int port, PageAnswers answers)
      : address_(std::move(address)), answers_(std::move(answers)) {
    listen(port);
  }
  ~State() { end(EXIT_FAILURE); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::string url() const { return fmt::format("http://{}:{}/", host_of(address_), server_->port()); }

  bool is_local() const { return bound_.is_loopback; }

  void run(const std::function<void()>& ready) {
    const Interrupt interrupt;
    ready();  // the socket listens already; before there is another thread, as this may throw
    start([&interrupt] { interrupt.raise(); });
    interrupt.wait();
    stop(EXIT_SUCCESS);
    listener_.join();
    served_.get();
  }

  void start(const std::function<void()>& at_end) {
    std::packaged_task<void()> serve([this] { server_->run(); });
    std::future<void> served = serve.get_future();
    listener_ = std::thread([serve = std::move(serve), at_end]() mutable {
      serve();
      at_end();
    });
    served_ = std::move(served);
  }

  void end(int exit_code) {
    if (!served_.valid()) return;
    stop(exit_code);
    listener_.join();
    served_ = {};
  }

 private:
  /// Throws std::runtime_error when it cannot be done.
  void listen(int port) {
    std::string cause = "there is no such address";
    for (const Address& address : resolve(address_)) {
      try {
        // By its number, so that it is this one and no other that the name may stand for.
        const boost::asio::ip::tcp::endpoint endpoint(boost::asio::ip::make_address(address.number),
                                                      static_cast<unsigned short>(port));
        server_ = std::make_unique<HttpServer>(
            endpoint,
            HttpAnswers{[this](const HttpHead& head) { return answer_head(head); },
                        [this](const std::string& body) { return answer_body(body); }, plain_error});
        bound_ = address;
        hosts_ = own_hosts(address_, address.number, server_->port());
        return;
      } catch (const boost::system::system_error& error) {
        cause = error.code().message();
        if (error.code() == boost::system::errc::address_in_use) cause += "; choose another port";
      }
    }
    throw std::runtime_error(fmt::format("cannot serve at {}:{}: {}", host_of(address_), port, cause));
  }

  void stop(int exit_code) {
    stopping_ = true;
    server_->stop();
    // An error that is on its way is still to be told.
    if (std::uncaught_exceptions() > 0 || served_.wait_for(kGrace) == std::future_status::ready) return;
    std::fflush(nullptr);
    std::_Exit(exit_code);
  }

  std::optional<HttpResponse> answer_head(const HttpHead& request) const {
    if (auto fault = find_fault(request, hosts_)) return fault;
    const bool is_post = request.method() == http::verb::post;
    const std::string_view target(request.target().data(), request.target().size());
    const std::string_view path = target.substr(0, target.find('?'));
    if (path == "/refine" && is_post) return std::nullopt;
    if (is_post) return plain_error(Status::not_found);
    try {
      if (path == "/") return HttpResponse{Status::ok, "text/html; charset=utf-8", answers_.page()};
      if (path == "/news" && answers_.news)
        return HttpResponse{Status::ok, "application/json",
                            std::make_shared<const std::string>(answers_.news())};
    } catch (const std::bad_alloc&) {
      throw;  // the connection is closed
    } catch (const std::exception& error) {
      return error_response(Status::internal_server_error, error.what());
    }
    return plain_error(Status::not_found);
  }

  HttpResponse answer_body(const std::string& body) const {
    try {
      std::string json;
      with_cancellation(stopping_, [&] {
        throw_if_cancelled();
        json = answers_.refine(body);
      });
      return {Status::ok, "application/json", std::make_shared<const std::string>(std::move(json))};
    } catch (const Cancelled&) {
      return error_response(Status::service_unavailable, "the server has been ended");
    } catch (const std::invalid_argument& error) {
      return error_response(Status::bad_request, error.what());
    } catch (const OtherMerge& error) {
      return error_response(Status::conflict, error.what());
    } catch (const std::bad_alloc&) {
      return error_response(Status::internal_server_error, "out of memory");
    } catch (const std::exception& error) {
      return error_response(Status::internal_server_error, error.what());
    }
  }

  std::string address_;
  PageAnswers answers_;
  std::atomic<bool> stopping_ = false;
  Address bound_;
  std::set<std::string> hosts_;  // by which requests may call it
  std::unique_ptr<HttpServer> server_;
  std::future<void> served_;  // valid from start() on, until run() has its result
  std::thread listener_;
};

PageServer::PageServer(const std::string& address, int port, PageAnswers answers)
    : state_(std::make_unique<State>(address, port, std::move(answers))) {}
PageServer::~PageServer() = default;

std::string PageServer::url() const {
  return state_->url();
}

void PageServer::run(const std::function<void()>& ready) {
  state_->run(ready);
}

void PageServer::start() {
  state_->start([] {});
}

void PageServer::end(int exit_code) {
  state_->end(exit_code);
}

bool PageServer::is_local() const {
  return state_->is_local();
}

void warn_of_visitors(const PageServer& server, Console& console) {
  if (!server.is_local())
    console.warn("whoever reaches " + server.url() +
                 " sees the maps and can have this machine work for them");
}

}  // namespace gridmerge::cli
