// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/html.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base64.hpp"
#include "gridmerge/report/json.hpp"
#include "gridmerge/report/preview.hpp"
#include "gridmerge/report/wording.hpp"

namespace gridmerge {

namespace {

// Everything the page needs is in it: the policy lets a browser fetch nothing and run nothing.
constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<title>gridmerge report</title>
<style>
:root { color-scheme: light dark; --page: #fafaf8; --ink: #2d2d32; --soft: #66666c; --line: #d8d8d4;
        --good: #00724f; --bad: #a83e00; }
@media (prefers-color-scheme: dark) {
  :root { --page: #18181b; --ink: #e6e6e3; --soft: #a2a2a8; --line: #3b3b40; --good: #4fcfa4; --bad: #ff9a57; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 72rem; padding: 1.5rem 1rem 3rem; background: var(--page); color: var(--ink);
       font: 1rem/1.5 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; margin: 0 0 .25rem; }
h2 { font-size: 1.2rem; margin: 2rem 0 .25rem; }
p { margin: .25rem 0; max-width: 46rem; }
.soft { color: var(--soft); }
figure { margin: 1.25rem 0 0; }
img { display: block; max-width: 100%; height: auto; border: 1px solid var(--line); border-radius: 4px; }
.table { overflow-x: auto; margin-top: .75rem; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .75rem .35rem 0; border-bottom: 1px solid var(--line); text-align: left; white-space: nowrap; }
td.name { white-space: normal; min-width: 10rem; }
th { font-weight: 600; font-size: .85rem; color: var(--soft); }
.number { text-align: right; }
.accepted { color: var(--good); }
.refused { color: var(--bad); }
.swatch { display: inline-block; width: .8em; height: .8em; margin-right: .5em; border-radius: 2px; }
</style>
</head>
<body>
)";

// Text as HTML shows it, whatever bytes it holds; the isolation keeps right-to-left marks in a name to the
// name.
std::string text(const std::string& bytes) {
  using nlohmann::json;
  const std::string utf8 = json::parse(json(bytes).dump(-1, ' ', false, json::error_handler_t::replace));
  std::string html = "<bdi>";
  for (const char c : utf8) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html + "</bdi>";
}

std::string swatch(std::size_t map) {
  const Colour colour = map_colour(map);
  return fmt::format(R"(<span class="swatch" style="background:#{:02x}{:02x}{:02x}"></span>)", colour.red,
                     colour.green, colour.blue);
}

std::string name_cell(const std::vector<std::string>& names, std::size_t map) {
  return fmt::format(R"(<td class="name">{}{}</td>)", swatch(map), text(names.at(map)));
}

std::string number_cell(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  const double rounded = std::round(value * unit) / unit + 0.0;  // no "-0.000"
  return fmt::format(R"(<td class="number">{:.{}f}</td>)", rounded, decimals);
}

std::string transform_cells(const SE2& T) {
  return number_cell(T.x, 3) + number_cell(T.y, 3) + number_cell(T.theta, 5) +
         number_cell(T.theta * 180.0 / std::numbers::pi, 2);
}

constexpr const char* kTransformHeads =
    R"(<th class="number">x [m]</th><th class="number">y [m]</th><th class="number">θ [rad]</th><th class="number">θ [°]</th>)";

constexpr const char* kCertaintyHeads =
    R"(<th class="number">probability</th><th class="number">± [m]</th><th class="number">± [°]</th>)";

std::string certainty_cells(const Member& member) {
  const std::string unknown = R"(<td class="number">–</td>)";
  return (member.probability ? number_cell(*member.probability, 4) : unknown) +
         (member.sd ? number_cell(member.sd->position, 3) +
                          number_cell(member.sd->theta * 180.0 / std::numbers::pi, 2)
                    : unknown + unknown);
}

// "1 map", "2 maps".
std::string count(std::size_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

std::string summary(const MergeResult& result) {
  std::size_t joined = 0;
  for (const Component& component : result.components) joined += component.members.size();
  const std::size_t total = joined + result.left_out.size();
  return fmt::format("<p>{}: {} joined in {}, {} left out.</p>\n", count(total, "map"), joined,
                     count(result.components.size(), "component"), result.left_out.size());
}

std::string component_section(const std::vector<std::string>& names, const MergeResult& result,
                              std::size_t index) {
  const Component& component = result.components[index];
  const OccupancyGrid& grid = component.fused.grid;
  std::string html = fmt::format("<h2>{}</h2>\n", component_file(index));
  html += fmt::format("<p>{} × {} cells of {} m. {} that several maps know agree, {} do not.</p>\n",
                      grid.width, grid.height, grid.resolution, count(component.fused.agreeing, "cell"),
                      component.fused.conflicting);
  html +=
      fmt::format(R"(<p class="soft">A transform takes a point of the map's frame to {}.</p>)",
                  component.in_world_frame ? "the frame in which poses were fixed"
                                           : "the frame of " + text(names.at(component.members.front().map)));
  html += fmt::format("\n<div class=\"table\"><table>\n<tr><th>map</th>{}{}</tr>\n", kTransformHeads,
                      kCertaintyHeads);
  for (const Member& member : component.members) {
    html += fmt::format("<tr>{}{}{}</tr>\n", name_cell(names, member.map),
                        transform_cells(member.T_component_map), certainty_cells(member));
  }
  return html + "</table></div>\n";
}

constexpr const char* kJoinsText =
    "<h2>Comparisons</h2>\n<p class=\"soft\">Of two maps, or of two groups that were already joined, named "
    "by their "
    "first map. <strong>accepted</strong>: believed by itself. <strong>rescued</strong>: too weak by itself, "
    "but it agrees with "
    "what "
    "the other maps say. <strong>rejected</strong>: would be believed by itself, but contradicts the other "
    "maps. "
    "<strong>known</strong>: they lie so because their poses were given. <strong>refused</strong>: not "
    "believed. The probability is that the transform, which takes the moving "
    "frame to "
    "the "
    "fixed one, is the true one, by these two maps alone (of a random walk, which knows no probability, it "
    "is "
    "the acceptance index); that of a refused or rejected one is the best guess and was not used.</p>\n";

std::string joins_section(const std::vector<std::string>& names, const MergeResult& result) {
  if (result.joins.empty()) return {};
  std::string html = kJoinsText;
  html +=
      "<div class=\"table\"><table>\n<tr><th>fixed</th><th>moving</th><th>outcome</th>"
      "<th class=\"number\">probability</th><th class=\"number\">acceptance index</th>"
      "<th class=\"number\">overlap</th>";
  html += fmt::format("{}</tr>\n", kTransformHeads);
  for (const Join& join : result.joins) {
    html += fmt::format("<tr>{}{}<td class=\"{}\">{}</td>{}{}{}{}</tr>\n", name_cell(names, join.fixed),
                        name_cell(names, join.moving), join.used() ? "accepted" : "refused",
                        name_of(join.outcome), number_cell(join.probability, 4),
                        number_cell(join.match.acceptance_index, 4), number_cell(join.match.overlap, 3),
                        transform_cells(join.T_fixed_moving));
  }
  return html + "</table></div>\n";
}

std::string left_out_section(const std::vector<std::string>& names, const MergeResult& result) {
  if (result.left_out.empty()) return {};
  std::string html =
      "<h2>Left out</h2>\n<p>These maps could not be joined to another one with confidence.</p>\n<ul>\n";
  for (std::size_t i = 0; i < result.left_out.size(); ++i) {
    const std::size_t map = result.left_out[i];
    html += fmt::format("<li>{}{}: {}</li>\n", swatch(map), text(names.at(map)),
                        explain_left_out(result.left_out_reasons.at(i)));
  }
  return html + "</ul>\n";
}

}  // namespace

std::string report_html(const std::vector<std::string>& names, const MergeResult& result,
                        std::string_view preview_png) {
  std::string html = kHead;
  html += "<h1>Merged maps</h1>\n" + summary(result);
  html +=
      R"(<figure><img alt="The maps drawn over each other, each in its own colour" src="data:image/png;base64,)";
  html += to_base64(preview_png) + "\"></figure>\n";
  for (std::size_t i = 0; i < result.components.size(); ++i) html += component_section(names, result, i);
  html += left_out_section(names, result);
  html += joins_section(names, result);
  return html + "</body>\n</html>\n";
}

}  // namespace gridmerge
