// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "address.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "grid/parallel.hpp"
#include "merge/refine_member.hpp"
#include "page_server.hpp"
#include "report/page.hpp"
#include "report/refine_request.hpp"
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

std::string answer_refine(const SavedMerge& merge, int threads, const std::string& body) {
  const RefineRequest request = parse_refine_request(body, merge.maps.size());
  const auto placed = [&](const LaidMap& laid) { return PlacedMap{&merge.maps[laid.map], laid.T_page_map}; };
  std::vector<PlacedMap> fixed;
  for (const LaidMap& laid : request.fixed) fixed.push_back(placed(laid));
  RefinedPose refined;
  with_threads(threads, [&] { refined = refine_member(fixed, placed(request.moving)); });
  return refined_pose_json(refined);
}

int run_view(const ViewCommandOptions& options) {
  Console console(options.common);
  const SavedMerge merge = load_saved_merge(options.merge, console);
  std::string page;
  with_threads(options.common.threads, [&] { page = live_report_page(merge.named()); });
  PageServer server(options.address, options.port, std::move(page), [&](const std::string& body) {
    return answer_refine(merge, options.common.threads, body);
  });
  if (!server.is_local())
    console.warn("whoever reaches " + server.url() +
                 " sees the maps and can have this machine work for them");
  server.run([&] { print(fmt::format("{}  (Ctrl-C ends it)\n", server.url())); });
  return kDone;
}

/// A request has to name its host, and these are no host's name.
const CLI::Validator kOneAddress(
    [](std::string& text) {
      const std::vector<Address> addresses = resolve(text);
      const bool any =
          std::any_of(addresses.begin(), addresses.end(), [](const Address& one) { return one.is_any; });
      return text.empty() || any
                 ? "'" + text + "' is no single address: give the one by which others reach this machine"
                 : std::string();
    },
    "");

}  // namespace

void add_view(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("view", "Serve the report page, to try poses by hand");
  const auto options = std::make_shared<ViewCommandOptions>();
  add_saved_merge_options(*command, options->merge);
  command->add_option("--port", options->port, "Port to serve at; 0 = a free one")
      ->type_name("N")
      ->check(CLI::Range(0, 65535).description(""))
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
