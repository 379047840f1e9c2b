// SPDX-License-Identifier: Apache-2.0
#include "grid/sha256.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

namespace gridmerge::internal {
namespace {

std::string hash(std::string_view text) {
  return to_hex(Sha256().add(text).digest());
}

// Examples of FIPS 180-4 and of NIST's test vectors.
TEST(Sha256, OfWhatTheStandardGives) {
  EXPECT_EQ(hash(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hash(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

RC_GTEST_PROP(Sha256, IsTheSameHoweverTheBytesCome, (std::string text, std::string more)) {
  for (int i = 0; i < 3; ++i) text += text + more;  // some are longer than a block
  const std::size_t middle = text.size() / 3;
  const std::string_view all = text;
  RC_ASSERT(to_hex(Sha256().add(all.substr(0, middle)).add("").add(all.substr(middle)).digest()) ==
            hash(all));
}

}  // namespace
}  // namespace gridmerge::internal
