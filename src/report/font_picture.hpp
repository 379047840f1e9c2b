// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace gridmerge::internal {

/// The bytes of font.png; made from it when the project is built.
extern const std::string_view kFontPicture;

}  // namespace gridmerge::internal
