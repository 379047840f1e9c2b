// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "console.hpp"
#include "gridmerge/grid/execution.hpp"
#include "page_server.hpp"
#include "refine_answer.hpp"
#include "report/bent_maps.hpp"
#include "report/page.hpp"
#include "saved_merge.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

struct ViewCommandOptions {
  CommonOptions common;
  SavedMergeOptions merge;
  std::string address = "127.0.0.1";
  int port = 0;
};

/// For as long as the merge is there.
ShownMaps shown_maps(const SavedMerge& merge) {
  std::vector<std::optional<OccupancyGrid>> bent = bent_maps(merge.maps, merge.result);
  ShownMaps maps;
  for (std::size_t i = 0; i < bent.size(); ++i) {
    if (bent[i])
      maps.push_back(std::make_shared<const OccupancyGrid>(*std::move(bent[i])));
    else
      maps.emplace_back(std::shared_ptr<void>(), &merge.maps[i]);
  }
  return maps;
}

int run_view(const ViewCommandOptions& options) {
  Console console(options.common);
  const SavedMerge merge = load_saved_merge(options.merge, console);
  LiveReportPage page;
  with_threads(options.common.threads, [&] { page = live_report_page(merge.named()); });
  const auto html = std::make_shared<const std::string>(std::move(page.html));
  PageAnswers answers;
  answers.page = [html] { return html; };
  // As the page draws and scores them: drawn when they are first asked for.
  ShownMaps maps;
  std::once_flag are_drawn;
  const auto maps_of = [&](const std::string& asked) {
    if (asked != page.merge) throw OtherMerge();
    std::call_once(are_drawn,
                   [&] { with_threads(options.common.threads, [&] { maps = shown_maps(merge); }); });
    return maps;
  };
  answers.refine = [&](const std::string& body) {
    return answer_refine(body, maps_of, options.common.threads);
  };
  PageServer server(options.address, options.port, std::move(answers));
  warn_of_visitors(server, console);
  server.run([&] { print(fmt::format("{}  (Ctrl-C ends it)\n", server.url())); });
  return kDone;
}

}  // namespace

void add_view(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("view", "Serve the report page, to try poses by hand");
  const auto options = std::make_shared<ViewCommandOptions>();
  add_saved_merge_options(*command, options->merge);
  command->add_option("--port", options->port, "Port to serve at; 0 = a free one")
      ->type_name("N")
      ->transform(kPort)
      ->capture_default_str();
  command
      ->add_option(
          "--address", options->address,
          "Address or name of this machine to serve at; others can reach it unless it is a loopback one")
      ->type_name("ADDRESS")
      ->check(kOneAddress)
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer(
      "Prints the page's address and serves it until Ctrl-C. The page is that of 'gridmerge report', but "
      "asks\n"
      "here how well a map fits where you lay it (docs/view.md). No file is served, and none is written.\n\n"
      "Example:\n  gridmerge view merged\n"
      "  gridmerge view /data/site/merged --root /data/site --port 8750");
  command->callback([options, &action] { action = [options] { return run_view(*options); }; });
}

}  // namespace gridmerge::cli
