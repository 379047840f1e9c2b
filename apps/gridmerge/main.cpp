// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include "command_words.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "gridmerge/version.hpp"
#include "help.hpp"
#include "interrupt.hpp"

namespace {

using namespace gridmerge::cli;

// A standard stream that the caller closed would lend its number to the first file that we open, and our text
// would end up in it. A read-only one in its place keeps the number taken and writing an error.
void occupy_standard_streams() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) != -1) continue;
    const int flags = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", flags) != descriptor) std::_Exit(kError);
  }
}

// These signals would end the program in the middle of a write; without them the write fails and is dealt
// with.
void let_writes_fail() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

// Some of what libraries do may not throw, but needs memory: a JSON value when it goes, for one. Without any
// the program ends there. What it was writing then stays as after a kill: whole, and put in order by the next
// one.
std::atomic<bool> memory_ran_out{false};

void on_no_memory() {
  memory_ran_out = true;
  throw std::bad_alloc();
}

[[noreturn]] void on_terminate() {
  if (!memory_ran_out) std::abort();
  constexpr std::string_view kMessage = "gridmerge: out of memory\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  std::_Exit(kError);
}

// Of an error the asked-for subcommand's help is the one to point to.
std::string help_command(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? "gridmerge --help" : "gridmerge " + commands.front()->get_name() + " --help";
}

int run(int argc, char** argv) {
  CLI::App app("Merges occupancy grid maps made by robots that do not know where the others are.",
               "gridmerge");
  app.formatter(std::make_shared<HelpFormatter>());  // of the commands too, which are added later
  app.footer(
      "Example:\n  gridmerge merge robot1.yaml robot2.yaml robot3.yaml -o merged\n\n"
      "Exit codes: 0 done, 1 error, 2 wrong usage, 3 done but refused.\n"
      "'gridmerge COMMAND --help' tells more, with an example.");
  app.set_version_flag("--version", std::string("gridmerge ") + gridmerge::kVersion);
  app.require_subcommand(1);
  Action action;
  add_info(app, action);
  add_match(app, action);
  add_measure(app, action);
  add_merge(app, action);
#ifdef GRIDMERGE_HAS_NODE
  add_node(app, action);
#endif
  add_report(app, action);
  add_view(app, action);
  add_evaluate(app, action);
  add_simulate(app, action);
  for (CLI::App* const command : app.get_subcommands({})) settle_values(*command);

  if (argc < 2) {
    print(app.help());
    return kDone;
  }
  try {
    app.parse(words_to_parse(app, argc, argv));
  } catch (const CLI::CallForHelp&) {
    print(app.help());
    return kDone;
  } catch (const CLI::CallForVersion&) {
    print(app.version() + "\n");
    return kDone;
  } catch (const CLI::ParseError& error) {
    print_error(explain(app, error, argc, argv) + " (see " + help_command(app) + ")");
    return kUsage;
  }
  return run_interruptibly(action);
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  let_writes_fail();
  std::set_new_handler(on_no_memory);
  std::set_terminate(on_terminate);
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return kError;
}
