// SPDX-License-Identifier: Apache-2.0
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
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
  const int connection = connect();
  EXPECT_EQ(server->end_with(SIGTERM).exit_code, 0);
  ::close(connection);
}

/// Connections, as many as are served at once, that send a byte now and then for some ten seconds, or until
/// the server is gone.
class Dribble {
 public:
  explicit Dribble(const std::function<int()>& connect) {
    for (int i = 0; i < 8; ++i) connections_.push_back(connect());
    sender_ = std::thread([this] {
      for (int byte = 0; byte < 12 && !ended_; ++byte) {
        for (const int connection : connections_) {
          if (::send(connection, "A", 1, MSG_NOSIGNAL) != 1) ended_ = true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(800));
      }
    });
  }
  ~Dribble() {
    if (sender_.joinable()) sender_.join();
    for (const int connection : connections_) ::close(connection);
  }
  Dribble(const Dribble&) = delete;
  Dribble& operator=(const Dribble&) = delete;

  /// Waits, and says whether the server was gone before all had been sent.
  bool was_cut_off() {
    sender_.join();
    return ended_;
  }

 private:
  std::vector<int> connections_;
  std::atomic<bool> ended_ = false;
  std::thread sender_;
};

void wait_a_little() {
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
}

TEST_F(ViewEnds, WithCtrlCWhileItsTimeIsWasted) {
  Dribble dribble([&] { return connect(); });
  wait_a_little();
  const Outcome outcome = server->end_with(SIGINT);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(dribble.was_cut_off());
}

TEST_F(ViewEnds, AtOnceWithASecondSignalOfAnotherKind) {
  const Dribble dribble([&] { return connect(); });
  wait_a_little();
  server->send(SIGINT);
  wait_a_little();
  EXPECT_EQ(server->end_with(SIGTERM).exit_code, -1);
}

TEST_F(ViewEnds, WithCtrlCWhileAnAnswerIsMade) {
  // The fixed maps are so far apart that it takes seconds.
  Json body = question();
  body["fixed"].push_back({{"map", 2}, {"transform", {{"x", 400}, {"y", 400}, {"theta", 0}}}});
  int status = -1;
  std::thread asker([&] {
    httplib::Client patient = client();
    patient.set_read_timeout(100);
    const auto answer = patient.Post("/refine", body.dump(), kJson);
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
