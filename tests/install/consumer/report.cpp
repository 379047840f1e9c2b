// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/report/merge_record.hpp>

int main() {
  return gridmerge::transforms_json({}, {}).empty() ? 1 : 0;
}
