// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// Bytes that are not what they should be: the cause alone. Parsers see no file names; load_map adds them.
class GRIDMERGE_INTERNAL_EXPORT ParseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace gridmerge::internal
