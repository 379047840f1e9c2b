// SPDX-License-Identifier: Apache-2.0
// Clients that send without end, slowly, or not at all.
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/effort.hpp"
#include "view.hpp"

namespace gridmerge::test {
namespace {

class ViewUnderAttack : public View {
 protected:
  /// Of the server, resident [kB].
  long memory() const {
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
      const std::string command = read_file(process.path() / "cmdline");
      if (command.find("view") == std::string::npos || command.find(output) == std::string::npos) continue;
      std::istringstream status(read_file(process.path() / "status"));
      for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    }
    ADD_FAILURE() << "the server is not to be found";
    return 0;
  }

  /// AddressSanitizer keeps what is freed, up to 256 MB of it: its memory is not the server's.
  void expect_memory_below(long most) const {
    if (!kSanitized) {
      EXPECT_LT(memory(), most);
    }
  }

  void expect_served_within(std::chrono::milliseconds most) const {
    const auto begin = std::chrono::steady_clock::now();
    expect_alive();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, most);
  }

  /// Sends a part again and again, 100 MB of it at most; what is answered, once nothing more is taken.
  std::string send_without_end(const std::string& beginning, const std::string& part) const {
    const Connection connection = connect();
    bool goes_on = connection.send(beginning);
    for (std::size_t sent = 0; goes_on && sent < 100'000'000; sent += part.size())
      goes_on = connection.send(part);
    EXPECT_FALSE(goes_on) << "it takes all";
    return connection.receive(5);
  }

  void expect_refused(const std::string& bytes, const std::string& status) const {
    EXPECT_EQ(exchange(bytes).substr(0, 12), "HTTP/1.1 " + status);
  }

  std::string request_line() const { return "GET / HTTP/1.1\r\nHost: " + host + "\r\n"; }
};

constexpr auto kSecond = std::chrono::milliseconds(1000);

TEST_F(ViewUnderAttack, RequestsWithoutEndAreRefusedAndTakeNoMemory) {
  const long before = memory();
  const std::string block(16384, 'x');
  std::string headers;
  for (int i = 0; i < 2000; ++i) headers += "X: y\r\n";
  send_without_end(request_line(), headers);
  send_without_end("GET /" + block, block);
  send_without_end(request_line() + "X: " + block, block);
  expect_memory_below(before + 5000);
  expect_alive();
}

TEST_F(ViewUnderAttack, TooLongAHeadIsToldSo) {
  expect_refused("GET /" + std::string(17000, 'x') + " HTTP/1.1\r\n\r\n", "414");
  expect_refused(request_line() + "X: " + std::string(17000, 'x') + "\r\n\r\n", "431");
  std::string headers;
  for (int i = 0; i < 3000; ++i) headers += "X: y\r\n";
  expect_refused(request_line() + headers + "\r\n", "431");
  expect_refused(request_line() + "Cookie: " + std::string(12000, 'x') + "\r\n\r\n", "200");
}

/// Closed at once, the connection would be reset, and an answer that is still on its way would be lost.
TEST_F(ViewUnderAttack, WhoSendsOnAfterTheAnswerIsHeardForAWhile) {
  const Connection connection = connect();
  ASSERT_TRUE(connection.send(head() + "Content-Length: 9000000\r\n\r\n"));
  EXPECT_TRUE(connection.receive(10).starts_with("HTTP/1.1 413 "));
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(connection.send(std::string(1000, 'x'))) << i;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

TEST_F(ViewUnderAttack, SlowClientsKeepNobodyWaiting) {
  const long before = memory();
  std::vector<Connection> slow;
  for (int i = 0; i < 300; ++i) {
    slow.push_back(connect());
    (void)slow.back().send(i % 3 == 0   ? "G"
                           : i % 3 == 1 ? head() + "Content-Length: 1000000\r\n\r\n{"
                                        : std::string());
    if (i % 50 == 7) expect_served_within(kSecond);
  }
  for (int i = 0; i < 5; ++i) {
    for (const Connection& connection : slow) (void)connection.send("x");
    expect_served_within(kSecond);
  }
  const std::string body = question().dump();
  EXPECT_EQ(client().post("/refine", body, kJson)->status, 200) << "slow bodies give way to a whole one";
  expect_memory_below(before + 30000);
}

TEST_F(ViewUnderAttack, BodiesThatGiveWayTakeNoMemory) {
  const long before = memory();
  const std::string start = head() + "Content-Length: 1048576\r\n\r\n" + std::string(1'040'000, 'x');
  std::vector<Connection> clients;
  for (int i = 0; i < 250; ++i) {
    clients.push_back(connect());
    (void)clients.back().send(start);
    if (i % 50 == 7) expect_served_within(kSecond);
  }
  for (int look = 0; look < 10; ++look) {  // what they have sent comes as the server finds the time
    expect_memory_below(before + 40000);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  expect_served_within(kSecond);
}

TEST_F(ViewUnderAttack, ABodyOfNothingIsAnsweredAtOnce) {
  EXPECT_EQ(exchange(head() + "Content-Length: 0\r\n\r\n").substr(0, 12), "HTTP/1.1 400");
}

TEST_F(ViewUnderAttack, ARequestHasTenSecondsHoweverItIsSpread) {
  const Connection connection = connect();
  const std::string request = request_line();
  const auto begin = std::chrono::steady_clock::now();
  bool goes_on = true;
  for (std::size_t i = 0; i < 40 && goes_on; ++i) {
    goes_on = connection.send(request.substr(i, 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  EXPECT_FALSE(goes_on) << "it still listens";
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(14));
  EXPECT_EQ(connection.receive(1), "");
}

TEST_F(ViewUnderAttack, WhoTakesNoAnswerKeepsNobodyWaiting) {
  std::vector<Connection> silent;
  for (int i = 0; i < 200; ++i) {
    silent.push_back(connect());
    (void)silent.back().send(request_line() + "\r\n");
  }
  expect_served_within(kSecond);
}

TEST_F(ViewUnderAttack, WhoAsksForTheHundredthAnswerIsToldToWait) {
  const std::string body = question().dump();
  std::vector<Connection> askers;
  for (int i = 0; i < 40; ++i) {
    askers.push_back(connect());
    ASSERT_TRUE(
        askers.back().send(head() + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body));
  }
  expect_served_within(kSecond);
  int answered = 0, refused = 0;
  for (const Connection& asker : askers) {
    const std::string answer = asker.receive(100);
    answered += answer.starts_with("HTTP/1.1 200");
    refused += answer.starts_with("HTTP/1.1 503");
  }
  EXPECT_EQ(answered + refused, 40);
  EXPECT_GE(answered, 16);
}

TEST_F(ViewUnderAttack, ABodyThatIsAskedForComes) {
  const std::string body = question().dump();
  const Connection connection = connect();
  ASSERT_TRUE(connection.send(
      head() + "Expect: 100-continue\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n"));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ASSERT_TRUE(connection.send(body));
  const std::string answer = connection.receive(100);
  EXPECT_EQ(answer.find("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200"), 0u) << answer;
}

}  // namespace
}  // namespace gridmerge::test
