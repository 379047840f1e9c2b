// SPDX-License-Identifier: Apache-2.0
// What somebody sends to the server of `gridmerge view`, over a connection of the loopback network. In an
// input $PORT is the server's; byte 1 repeats the byte behind the next one, 64 times what that says, so that
// bounds can be reached; at byte 2 what follows is sent on its own.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "../apps/gridmerge/page_server.hpp"
#include "fuzz_target.hpp"

using namespace gridmerge;

namespace {

constexpr int kPatience = 60;  // seconds: more than the server has for a request and for its end

cli::PageAnswers answers() {
  cli::PageAnswers answers;
  answers.page = [] { return std::make_shared<const std::string>("<!DOCTYPE html>"); };
  answers.news = [] { return std::string("{\"answer\": 1}\n"); };
  answers.refine = [](const std::string& body) {
    if (body.empty() || body.front() != '{') throw std::invalid_argument("it is no object");
    return body;
  };
  return answers;
}

int port() {
  // Never destroyed: its threads serve as long as there are inputs.
  static cli::PageServer& server = *new cli::PageServer("127.0.0.1", 0, answers());
  static const int port = [] {
    server.start();
    const std::string url = server.url();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }();
  return port;
}

/// What is sent, part by part.
std::vector<std::string> parts_of(std::string_view input) {
  constexpr char kRepeat = 1, kPart = 2;
  constexpr std::string_view kPort = "$PORT";
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < input.size(); ++i) {
    if (input[i] == kRepeat && i + 2 < input.size()) {
      parts.back().append(64 * static_cast<std::size_t>(static_cast<unsigned char>(input[i + 1])),
                          input[i + 2]);
      i += 2;
    } else if (input[i] == kPart) {
      parts.emplace_back();
    } else if (input.substr(i).starts_with(kPort)) {
      parts.back() += std::to_string(port());
      i += kPort.size() - 1;
    } else {
      parts.back() += input[i];
    }
  }
  return parts;
}

class Client {
 public:
  Client() : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    // From another address each time: ports of connections that have ended are not free at once.
    static std::uint32_t number = 0;
    sockaddr_in own = address(INADDR_LOOPBACK + (number++ % 0xFFFF00) + 1, 0);
    const sockaddr_in server = address(INADDR_LOOPBACK, port());
    const int one = 1;
    const timeval patience{kPatience, 0};
    fuzz::require(::setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one) == 0);
    fuzz::require(::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) == 0);
    fuzz::require(::bind(descriptor_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0);
    fuzz::require(::connect(descriptor_, reinterpret_cast<const sockaddr*>(&server), sizeof server) == 0);
  }
  ~Client() { ::close(descriptor_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return;  // it has heard enough
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  /// What is answered once nothing more is sent.
  std::string receive() const {
    ::shutdown(descriptor_, SHUT_WR);
    std::string answer;
    std::array<char, 4096> block{};
    while (true) {
      const ssize_t count = ::recv(descriptor_, block.data(), block.size(), 0);
      if (count < 0 && errno == EINTR) continue;     // libFuzzer looks at the clock
      fuzz::require(count >= 0 || errno != EAGAIN);  // the client is not kept waiting
      if (count <= 0) return answer;
      answer.append(block.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  static sockaddr_in address(std::uint32_t host, int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(host);
    return address;
  }

  int descriptor_;
};

/// One answer, whole, that no browser takes for more than it is.
void require_sound(std::string_view answer, bool is_head) {
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n",
                             kLength = "\r\nContent-Length: ", kVersion = "HTTP/1.1 ";
  if (answer.starts_with(kContinue)) answer.remove_prefix(kContinue.size());
  if (answer.empty()) return;  // the request had no end
  const std::size_t end = answer.find("\r\n\r\n");
  fuzz::require(answer.starts_with(kVersion) && end != std::string_view::npos);
  const std::string_view head = answer.substr(0, end + 2), body = answer.substr(end + 4);
  fuzz::require(head.substr(kVersion.size(), 3) != "500");
  fuzz::require(head.find("\r\nConnection: close\r\n") != std::string_view::npos);
  fuzz::require(head.find("\r\nX-Content-Type-Options: nosniff\r\n") != std::string_view::npos);
  const std::size_t at = head.find(kLength);
  fuzz::require(at != std::string_view::npos);
  std::size_t length = 0;
  std::from_chars(head.data() + at + kLength.size(), head.data() + head.size(), length);
  // Whoever's request cannot be read as HEAD gets the whole error.
  fuzz::require(body.size() == length || (is_head && body.empty()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::string> parts = parts_of(fuzz::as_bytes(data, size));
  std::string all;
  const Client client;
  for (const std::string& part : parts) {
    client.send(part);
    all += part;
  }
  require_sound(client.receive(), all.starts_with("HEAD "));
  return 0;
}
