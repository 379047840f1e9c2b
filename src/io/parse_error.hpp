// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace gridmerge::internal {

/// Bytes that are not what they should be: the cause alone. Parsers see no file names; load_map adds them.
class ParseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace gridmerge::internal
