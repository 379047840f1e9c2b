// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "support/temporary_directory.hpp"

namespace gridmerge::test {

/// A keystore as `ros2 security` makes it, with an authority of its own: whoever has an enclave may publish
/// and hear everything, encrypted, and nobody else is heard. Made by the program openssl, in a quarter of a
/// second.
class Keystore {
 public:
  /// Whether the program is there.
  static bool can_be_made();

  Keystore();

  /// Makes the files of an enclave: "/robots/merger".
  void add(const std::string& enclave) const;

  std::string path() const { return directory_.path().string(); }
  std::string folder(const std::string& enclave) const { return path() + "/enclaves" + enclave; }

 private:
  void run(const std::string& arguments) const;

  TemporaryDirectory directory_;
};

}  // namespace gridmerge::test
