// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::python {

/// A merge's result in a form that another process reads, every bit of it.
std::string to_bytes(const MergeResult& result);

/// Throws std::invalid_argument for bytes that are no such result.
MergeResult merge_from_bytes(std::string_view bytes);

}  // namespace gridmerge::python
