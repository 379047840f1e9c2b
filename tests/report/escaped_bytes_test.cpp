// SPDX-License-Identifier: Apache-2.0
#include "report/escaped_bytes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace gridmerge::internal {
namespace {

bool is_json_text(const std::string& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

TEST(EscapedBytes, StandForWhatIsOfNoCharacter) {
  EXPECT_EQ(escape_bytes("caf\xe9/a.yaml"), "caf\\xe9/a.yaml");
  EXPECT_EQ(escape_bytes("caf\xc3\xa9"), "caf\xc3\xa9");
  EXPECT_EQ(escape_bytes("a\\xe9"), "a\\\\xe9");  // which is no byte
  EXPECT_EQ(escape_bytes("\xc3"), "\\xc3");
  EXPECT_EQ(escape_bytes("\xe2\x82"), "\\xe2\\x82");
  EXPECT_EQ(escape_bytes(""), "");
}

TEST(EscapedBytes, OfWhatIsNeverWrittenAreNothing) {
  for (const char* const text :
       {"\\", "\\x", "\\xe", "\\xgg", "\\x41", "\\xE9", "\\xc3\\xa9", "\\n", "\xe9", "\\x-1", "\\e9ab"})
    EXPECT_FALSE(unescape_bytes(text)) << text;
}

RC_GTEST_PROP(EscapedBytes, TakenBackAreTheSame, (std::string any)) {
  // Much of what leads characters, and of what continues them.
  const auto telling =
      rc::gen::element<char>('\\', 'x', 'e', '9', '\x7f', '\x80', '\x9f', '\xa0', '\xbf', '\xc1', '\xc2',
                             '\xdf', '\xe0', '\xed', '\xef', '\xf0', '\xf4', '\xf5');
  any += *rc::gen::container<std::string>(telling);
  RC_ASSERT(is_utf8(any) == is_json_text(any));
  const std::string escaped = escape_bytes(any);
  RC_ASSERT(is_json_text(escaped));
  RC_ASSERT(unescape_bytes(escaped) == any);
}

}  // namespace
}  // namespace gridmerge::internal
