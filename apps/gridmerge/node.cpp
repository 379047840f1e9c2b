// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "commands.hpp"
#include "console.hpp"
#include "gridmerge/dds/ros_node.hpp"
#include "gridmerge/io/file_error.hpp"
#include "interrupt.hpp"
#include "live_page.hpp"
#include "node_options.hpp"
#include "page_server.hpp"

namespace gridmerge::cli {

namespace {

// Longer than a node takes that is let go of: with --once it gives its subscribers 5 s.
constexpr std::chrono::seconds kLongestEnd{10};

/// Another thread still works on the node: no destructor may run any more.
[[noreturn]] void end_without_network(int exit_code) {
  print_error("warning: the network does not let go of the node: it ends without telling others");
  std::fflush(nullptr);
  std::_Exit(exit_code);
}

/// Stops the node at the first signal, for as long as this lives. DDS may wait for good for a network that is
/// gone, also while the node joins another one: then the program ends without it.
class StopAtSignal {
 public:
  StopAtSignal(const Interrupt& signal, RosNode& node)
      : signal_(signal), waiter_([this, &node] {
          signal_.wait();
          node.stop();
          if (ended_.get_future().wait_for(kLongestEnd) == std::future_status::ready) return;
          end_without_network(kDone);
        }) {}
  ~StopAtSignal() {
    ended_.set_value();
    signal_.raise();
    waiter_.join();
  }
  StopAtSignal(const StopAtSignal&) = delete;
  StopAtSignal& operator=(const StopAtSignal&) = delete;

 private:
  const Interrupt& signal_;
  std::promise<void> ended_;
  std::thread waiter_;  // last: it uses what is above
};

/// Deletes a node. Where that takes longer than kLongestEnd, the program ends there.
struct TakeDown {
  int exit_code = kError;
  std::string error = {};  // that is on its way, and would not be told then

  void operator()(RosNode* node) const {
    std::packaged_task<void()> take_down([node] { delete node; });
    const std::future<void> done = take_down.get_future();
    std::thread thread(std::move(take_down));
    if (done.wait_for(kLongestEnd) == std::future_status::ready) return thread.join();
    if (!error.empty()) print_error(error);
    end_without_network(exit_code);
  }
};

int run_node(const NodeCommandOptions& options) {
  Console console(options.common);
  RosNodeOptions node_options = to_node_options(options);
  node_options.known_poses = known_robot_poses(options, console);
  try {
    validate(node_options);
  } catch (const std::invalid_argument& error) {  // the rest was looked at before
    throw FileError(options.known.init, error.what());
  }
  node_options.played = played_topics(options, node_options, console);
  const auto tell = [&](const std::string& line) {
    if (!options.common.quiet) print(escape_controls(line) + "\n");
  };
  node_options.tell = tell;
  node_options.detail = [&](const std::string& line) { console.remark(escape_controls(line)); };
  node_options.warn = [&](const std::string& line) { console.warn(escape_controls(line)); };
  LivePage page(options.common.threads);
  std::optional<PageServer> server;
  if (options.page) {
    node_options.answered = [&](const std::shared_ptr<const TeamAnswer>& answer) { page.show(answer); };
    server.emplace(options.page_address, *options.page, page.answers());
    warn_of_visitors(*server, console);
  }
  const Interrupt signal;  // one that comes while the node starts is not lost
  std::unique_ptr<RosNode, TakeDown> node(new RosNode(std::move(node_options)));
  if (server) {
    server->start();
    tell("page: " + server->url());
  }
  RosNode::End end = RosNode::End::stopped;
  try {
    const StopAtSignal stop(signal, *node);
    end = node->run();
  } catch (const std::exception& error) {
    node.get_deleter().error = error.what();
    throw;
  }
  if (end != RosNode::End::stopped) print(node->describe());
  const int exit_code = end == RosNode::End::refused ? kRefused : kDone;
  node.get_deleter().exit_code = exit_code;
  node.reset();  // peers are told that it leaves, whatever the server waits for
  if (server) server->end(exit_code);
  return exit_code;
}

}  // namespace

void add_node(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("node", "Merge maps live: a node of ROS 2, without ROS installed");
  const auto options = std::make_shared<NodeCommandOptions>();
  add_node_options(*command, *options);
  command->footer(
      "Hears nav_msgs/msg/OccupancyGrid of every robot, and map_msgs/msg/OccupancyGridUpdate on the same\n"
      "topic with _updates. Publishes the merged map, transforms and /diagnostics until Ctrl-C\n"
      "(docs/node.md). ROS_DOMAIN_ID, ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS, ROS_LOCALHOST_ONLY,\n"
      "CYCLONEDDS_URI, and for DDS Security ROS_SECURITY_ENABLE, ROS_SECURITY_KEYSTORE and\n"
      "ROS_SECURITY_ENCLAVE_OVERRIDE count as for any node.\n\n"
      "Example:\n  gridmerge node\n"
      "  gridmerge node --pattern '/fleet/*/map' --fix tb1 --world site\n"
      "  gridmerge node --robot left=/tb1/map --robot right=/tb2/map --once --wait 30\n"
      "  gridmerge node --bag tb1.mcap --bag tb2.mcap --rate 10");
  command->callback([options, &action] {
    to_node_options(*options);  // what cannot be is wrong usage
    action = [options] { return run_node(*options); };
  });
}

}  // namespace gridmerge::cli
