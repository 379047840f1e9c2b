// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/evaluate/evaluate.hpp>

int main() {
  return gridmerge::evaluate({}).matches.empty() ? 0 : 1;
}
