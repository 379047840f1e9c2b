// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "commands.hpp"
#include "console.hpp"
#include "exports.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "saved_merge.hpp"

namespace gridmerge::cli {

namespace {

struct ReportCommandOptions {
  CommonOptions common;
  SavedMergeOptions merge;
  ExportOptions exports;
};

int run_report(const ReportCommandOptions& options) {
  Console console(options.common);
  const SavedMerge merge = load_saved_merge(options.merge, console);
  const std::vector<Export> exports = exports_of(options.exports, options.merge.directory);
  try_exports(exports, options.merge.directory, merge.files);
  with_threads(options.common.threads,
               [&] { write_report(options.merge.directory, merge.files, merge.named(), merge.fingerprint); });
  print(escape_controls((std::filesystem::path(options.merge.directory) / "report.html").string()) + "\n");
  print(write_exports(exports, merge.files, merge.named(), options.common.threads));
  return kDone;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("report", "Make the report page of an earlier merge again");
  const auto options = std::make_shared<ReportCommandOptions>();
  add_saved_merge_options(*command, options->merge);
  add_export_option(*command, options->exports);
  add_common_options(*command, options->common);
  command->footer(
      "Writes DIR/report.html from DIR/transforms.json, the merged maps in DIR, the maps that were merged,\n"
      "and the plan if there is one; nothing is matched again.\n\n"
      "Example:\n  gridmerge report merged\n"
      "  gridmerge report merged --export geojson\n"
      "  gridmerge report /data/site/merged --root /data/site");
  command->callback([options, &action] { action = [options] { return run_report(*options); }; });
}

}  // namespace gridmerge::cli
