// SPDX-License-Identifier: Apache-2.0
#include "io/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <sstream>
#include <string>

#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

// Knows how deep it is in a document, and no more. yaml-cpp calls itself for each level, and its own limit is
// hundreds of them: more than a thread with a small stack can bear.
class DepthGuard : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    descend();
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    descend();
  }
  void OnMapEnd() override { --depth_; }

 private:
  void descend() {
    constexpr int kMax = 16;  // a map file has two
    if (++depth_ > kMax) throw ParseError("not valid YAML: nested too deeply");
  }

  int depth_ = 0;
};

void check_depth(std::string_view text) {
  std::istringstream stream{std::string(text)};
  YAML::Parser parser(stream);
  DepthGuard guard;
  parser.HandleNextDocument(guard);
}

}  // namespace

YAML::Node load_yaml(std::string_view text) {
  try {
    check_depth(text);
    return YAML::Load(std::string(text));
  } catch (const YAML::Exception& error) {
    throw ParseError(fmt::format("not valid YAML: line {}: {}", error.mark.line + 1, error.msg));
  }
}

}  // namespace gridmerge::internal
