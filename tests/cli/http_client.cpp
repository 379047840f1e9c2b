// SPDX-License-Identifier: Apache-2.0
#include "http_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace gridmerge::test {

namespace {

namespace http = boost::beast::http;

constexpr int kPatience = 100;  // seconds: as long as a busy machine may take under sanitizers

auto find(const HttpHeaders& headers, const std::string& name) {
  return std::find_if(headers.begin(), headers.end(),
                      [&](const auto& header) { return boost::beast::iequals(header.first, name); });
}

std::optional<HttpAnswer> parse(const std::string& bytes, bool has_body) {
  http::response_parser<http::string_body> parser;
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());
  parser.eager(true);
  parser.skip(!has_body);
  boost::system::error_code error;
  for (std::size_t used = 0; !error && !parser.is_done() && used < bytes.size();)
    used += parser.put(boost::asio::buffer(bytes.data() + used, bytes.size() - used), error);
  if (error || !parser.is_done()) return std::nullopt;
  HttpAnswer answer{static_cast<int>(parser.get().result_int()), {}, parser.get().body()};
  for (const auto& field : parser.get()) answer.headers.emplace_back(field.name_string(), field.value());
  return answer;
}

}  // namespace

Connection::Connection(int port) : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("no connection to the server");
}

Connection::~Connection() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool Connection::send(const std::string& bytes) const {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = ::send(descriptor_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

std::string Connection::receive(int seconds) const {
  const timeval patience{seconds, 0};
  ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::string answer;
  std::array<char, 4096> block{};
  for (ssize_t count = 0; (count = ::recv(descriptor_, block.data(), block.size(), 0)) > 0;)
    answer.append(block.data(), static_cast<std::size_t>(count));
  return answer;
}

bool HttpAnswer::has_header(const std::string& name) const {
  return find(headers, name) != headers.end();
}

std::string HttpAnswer::header(const std::string& name) const {
  const auto found = find(headers, name);
  return found == headers.end() ? "" : found->second;
}

std::optional<HttpAnswer> HttpClient::ask(const std::string& method, const std::string& path,
                                          const HttpHeaders& headers, const std::string& body) const {
  std::string request = method + " " + path + " HTTP/1.1\r\n";
  if (find(headers, "Host") == headers.end()) request += "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n";
  for (const auto& [name, value] : headers) request.append(name).append(": ").append(value).append("\r\n");
  if (!body.empty() || method == "POST" || method == "PUT")
    request.append("Content-Length: ").append(std::to_string(body.size())).append("\r\n");
  const Connection connection(port_);
  (void)connection.send(request + "\r\n" + body);  // it may be refused before its end
  return parse(connection.receive(kPatience), method != "HEAD");
}

std::optional<HttpAnswer> HttpClient::get(const std::string& path, const HttpHeaders& headers) const {
  return ask("GET", path, headers);
}

std::optional<HttpAnswer> HttpClient::post(const std::string& path, const std::string& body,
                                           const std::string& type, HttpHeaders headers) const {
  headers.emplace_back("Content-Type", type);
  return ask("POST", path, headers, body);
}

}  // namespace gridmerge::test
