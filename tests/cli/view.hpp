// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "fixture.hpp"

namespace gridmerge::test {

inline constexpr const char* kJson = "application/json";

/// `gridmerge view` of two maps that were merged, and one that was left out.
class View : public CliTest {
 protected:
  View() {
    EXPECT_EQ(run({"merge", left, right, other, "-o", output}).exit_code, 3);
    server = std::make_unique<RunningProgram>(std::vector<std::string>{"view", output});
    const std::string line = server->read_line();
    const std::string start = "http://127.0.0.1:";
    EXPECT_EQ(line.find(start), 0u) << line;
    port = std::stoi(line.substr(start.size()));
    host = "127.0.0.1:" + std::to_string(port);
  }

  /// It waits for as long as a busy machine may take under sanitizers.
  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(100);
    return client;
  }

  /// A question about the second map, displaced from where it lies on the first.
  Json question() const {
    const Json members =
        Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("members");
    Json transform = members.at(1).at("transform");
    transform["x"] = transform.at("x").get<double>() + 0.4;
    transform["y"] = transform.at("y").get<double>() - 0.3;
    return {{"moving", 1},
            {"transform", transform},
            {"fixed", {{{"map", 0}, {"transform", members.at(0).at("transform")}}}}};
  }

  int connect() const {
    const int connection = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return connection;
  }

  /// What the server answers to raw bytes.
  std::string exchange(const std::string& bytes) const {
    const int connection = connect();
    EXPECT_EQ(::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    const timeval patience{10, 0};
    ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    std::string answer;
    std::array<char, 4096> block{};
    for (ssize_t count = 0; (count = ::recv(connection, block.data(), block.size(), 0)) > 0;)
      answer.append(block.data(), static_cast<std::size_t>(count));
    ::close(connection);
    return answer;
  }

  /// The head of a question, but for what it says of its body's length.
  std::string head(const std::string& method = "POST") const {
    return method + " /refine HTTP/1.1\r\nHost: " + host + "\r\nContent-Type: application/json\r\n";
  }

  void expect_alive() const {
    const auto page = client().Get("/");
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200);
  }

  const std::string output = directory.file("out");
  std::unique_ptr<RunningProgram> server;
  int port = 0;
  std::string host;
};

}  // namespace gridmerge::test
