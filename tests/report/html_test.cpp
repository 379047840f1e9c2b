// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/html.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "io/support.hpp"
#include "report/results.hpp"

namespace gridmerge {
namespace {

using test::contains;

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// The first tag that is closed out of order or not at all; "" for a well-formed page.
std::string unbalanced(const std::string& html) {
  std::vector<std::string> open;
  for (auto at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const bool closes = html[at + 1] == '/';
    const std::size_t begin = at + (closes ? 2 : 1);
    const std::string name = html.substr(begin, html.find_first_of(" >\n", begin) - begin);
    if (name == "!doctype" || name == "meta" || name == "img") continue;
    if (!closes) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> at " + std::to_string(at);
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

const std::vector<OccupancyGrid> kMaps(4, make_grid(3, 2, 0.5, {}, Cell::free));

MergeResult two_of_four() {
  MergeResult result = test::merged(kMaps, {{{0, {}}, {2, {1.25, -0.0001, std::numbers::pi / 2}}}});
  Join refused;
  refused.moving = 1;
  refused.probability = 0.0625;
  refused.match.acceptance_index = 0.8125;
  refused.match.overlap = 0.375;
  result.joins.push_back(refused);
  return result;
}

TEST(ReportHtml, TellsWhatWasJoined) {
  const std::string html = report_html({"a.yaml", "b.yaml", "c.yaml", "d.yaml"}, two_of_four(), "png");
  EXPECT_TRUE(contains(html, "4 maps: 2 joined in 1 component, 2 left out."));
  EXPECT_TRUE(contains(html, "<h2>merged.yaml</h2>"));
  EXPECT_TRUE(contains(html, ">1.250</td>"));
  EXPECT_TRUE(contains(html, ">1.57080</td>"));
  EXPECT_TRUE(contains(html, ">90.00</td>"));
  EXPECT_TRUE(contains(html, ">accepted</td>"));
  EXPECT_TRUE(contains(html, ">refused</td>"));
  EXPECT_TRUE(contains(html, ">0.7500</td>"));
  EXPECT_TRUE(contains(html, ">0.0625</td>"));
  EXPECT_TRUE(contains(html, ">0.8125</td>"));
  EXPECT_TRUE(contains(html, ">0.375</td>"));
  EXPECT_TRUE(contains(html, "d.yaml"));
  EXPECT_FALSE(contains(html, "-0.000"));
  EXPECT_EQ(unbalanced(html), "");
}

TEST(ReportHtml, NeedsNothingButItself) {
  const std::string html = report_html({"a", "b", "c", "d"}, two_of_four(), "foobar");
  EXPECT_FALSE(contains(html, "://"));
  EXPECT_FALSE(contains(html, "<script"));
  EXPECT_FALSE(contains(html, "<link"));
  EXPECT_EQ(occurrences(html, "src=\""), 1u);
  EXPECT_TRUE(contains(html, "default-src 'none'"));
  EXPECT_TRUE(contains(html, "prefers-color-scheme: dark"));
  EXPECT_TRUE(contains(html, "name=\"viewport\""));
}

TEST(ReportHtml, HoldsThePreviewAsBase64) {
  const auto source = [](const std::string& png) {
    const std::string html = report_html({}, {}, png);
    const std::string start = "src=\"data:image/png;base64,";
    const std::size_t begin = html.find(start) + start.size();
    return html.substr(begin, html.find('"', begin) - begin);
  };
  EXPECT_EQ(source(""), "");
  EXPECT_EQ(source("f"), "Zg==");
  EXPECT_EQ(source("fo"), "Zm8=");
  EXPECT_EQ(source("foo"), "Zm9v");
  EXPECT_EQ(source("foob"), "Zm9vYg==");
  EXPECT_EQ(source("\xff\xff\xfe\x80"), "///+gA==");
}

TEST(ReportHtml, NamesAreTextWhateverTheyHold) {
  for (const std::string& name : test::kHostileNames) {
    const std::string html = report_html({name, name, name, name}, two_of_four(), "");
    EXPECT_FALSE(contains(html, "<script"));
    EXPECT_FALSE(contains(html, "<b>"));
    EXPECT_EQ(occurrences(html, "<img"), 1u);
    EXPECT_EQ(unbalanced(html), "");
    EXPECT_NO_THROW(nlohmann::json(html).dump()) << "is UTF-8";
  }
  EXPECT_TRUE(contains(report_html({"<&>\"'", "b", "c", "d"}, two_of_four(), ""),
                       "<bdi>&lt;&amp;&gt;&quot;&#39;</bdi>"));
}

TEST(ReportHtml, WhatIsNoUtf8IsMarked) {
  EXPECT_TRUE(contains(report_html({"\xff", "b", "c", "d"}, two_of_four(), ""), "<bdi>\xef\xbf\xbd</bdi>"));
}

TEST(ReportHtml, OfNothing) {
  const std::string html = report_html({}, {}, "");
  EXPECT_TRUE(contains(html, "0 maps: 0 joined in 0 components, 0 left out."));
  EXPECT_FALSE(contains(html, "<table"));
  EXPECT_EQ(unbalanced(html), "");
}

TEST(ReportHtml, EveryMapNeedsAName) {
  EXPECT_THROW(report_html({"a"}, two_of_four(), ""), std::out_of_range);
}

}  // namespace
}  // namespace gridmerge
