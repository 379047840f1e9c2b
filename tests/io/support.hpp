// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>

#include <exception>
#include <string>

namespace gridmerge::test {

/// The message of the `Error` that `call` throws; a failure, and "", when it throws nothing.
template <typename Error, typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

inline testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << "\"";
}

/// How many of the first thousand descriptors the program has open.
inline int count_open_files() {
  int open = 0;
  for (int descriptor = 0; descriptor < 1000; ++descriptor)
    open += ::fcntl(descriptor, F_GETFD) != -1 ? 1 : 0;
  return open;
}

}  // namespace gridmerge::test
