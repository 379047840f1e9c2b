// SPDX-License-Identifier: Apache-2.0
#include "transform_options.hpp"

#include <fmt/format.h>

#include <vector>

#include "gridmerge/grid/deformation.hpp"

namespace gridmerge::cli {

TransformOptions add_transform_options(CLI::App& command, std::string& name) {
  std::vector<std::string> names;
  std::string meanings;
  for (const MapTransformName& one : map_transforms()) {
    names.emplace_back(one.name);
    meanings += fmt::format("{}{}: {}", meanings.empty() ? "" : "; ", one.name, one.meaning);
  }
  TransformOptions options;
  options.transform =
      command
          .add_option(
              "--transform", name,
              fmt::format("What may be done to maps so that walls that several have seen come to lie on "
                          "each other. {}. A map that --fix holds stays as it is. It changes neither "
                          "which maps join nor how sure that is",
                          meanings))
          ->type_name("KIND")
          ->check(CLI::IsMember(names))
          ->capture_default_str();
  const std::string meaning = "Bend the maps, as drift has bent them: --transform elastic";
  options.elastic = command.add_flag("--elastic", meaning);
  return options;
}

void settle_transform(const TransformOptions& options, bool up_the_tree, std::string& name) {
  const std::string elastic = name_of(MapTransform::elastic);
  if (options.elastic->count() > 0) {
    if (options.transform->count() > 0 && name != elastic)
      throw CLI::ValidationError("--elastic", "contradicts --transform " + name);
    name = elastic;
  }
  if (up_the_tree && name != name_of(MapTransform::rigid)) {
    const bool by_flag = options.transform->count() == 0;
    throw CLI::ValidationError(by_flag ? "--elastic" : "--transform", "needs --strategy joint");
  }
}

}  // namespace gridmerge::cli
