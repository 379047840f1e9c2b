// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "view.hpp"

namespace gridmerge::test {
namespace {

class ViewEnds : public View {};

TEST_F(ViewEnds, WithCtrlC) {
  const Outcome outcome = server->end_with(SIGINT);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(ViewEnds, WithCtrlCWhileSomebodyIsConnectedAndSilent) {
  const Connection connection = connect();
  EXPECT_EQ(server->end_with(SIGTERM).exit_code, 0);
}

/// Connections, as many as are served at once, that send a byte now and then for some ten seconds, or until
/// the server is gone.
class Dribble {
 public:
  explicit Dribble(int port) {
    for (int i = 0; i < 8; ++i) connections_.emplace_back(port);
    sender_ = std::thread([this] {
      for (int byte = 0; byte < 12 && !ended_; ++byte) {
        for (const Connection& connection : connections_) {
          if (!connection.send("A")) ended_ = true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(800));
      }
    });
  }
  ~Dribble() {
    if (sender_.joinable()) sender_.join();
  }
  Dribble(const Dribble&) = delete;
  Dribble& operator=(const Dribble&) = delete;

  /// Waits, and says whether the server was gone before all had been sent.
  bool was_cut_off() {
    sender_.join();
    return ended_;
  }

 private:
  std::vector<Connection> connections_;
  std::atomic<bool> ended_ = false;
  std::thread sender_;
};

void wait_a_little() {
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
}

TEST_F(ViewEnds, WithCtrlCWhileItsTimeIsWasted) {
  Dribble dribble(port);
  wait_a_little();
  const Outcome outcome = server->end_with(SIGINT);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(dribble.was_cut_off());
}

TEST_F(ViewEnds, AtOnceWithASecondSignalOfAnotherKind) {
  RunOptions options;  // where it would not end by itself: it has to wait for the system
  options.faulty = true;
  options.environment = {"GRIDMERGE_FAULT=hang 0"};
  RunningProgram stalled({"view", output}, options);
  const std::string line = stalled.read_line();
  const Connection connection(std::stoi(line.substr(line.rfind(':') + 1)));
  ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\n\r\n"));
  wait_a_little();
  stalled.send(SIGINT);
  wait_a_little();
  EXPECT_EQ(stalled.end_with(SIGTERM).signal, SIGTERM);
}

TEST_F(ViewEnds, WhenItsTerminalIsClosed) {
  const Outcome outcome = server->end_with(SIGHUP);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(ViewEnds, WithCtrlCWhileAnAnswerIsMade) {
  // The fixed maps are so far apart that it takes seconds.
  Json body = question();
  body["fixed"].push_back({{"map", 2}, {"transform", {{"x", 400}, {"y", 400}, {"theta", 0}}}});
  int status = -1;
  std::thread asker([&] {
    const auto answer = client().post("/refine", body.dump(), kJson);
    if (answer) status = answer->status;
  });
  wait_a_little();
  const Outcome outcome = server->end_with(SIGINT);
  asker.join();
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(status, 200) << "it waited for the answer";
}

}  // namespace
}  // namespace gridmerge::test
