// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/io/file_error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace gridmerge {
namespace {

TEST(FileError, NamesFileAndCause) {
  EXPECT_STREQ(FileError("maps/a.yaml", "missing key 'image'").what(), "maps/a.yaml: missing key 'image'");
}

TEST(FileError, StaysOnOneLineWhateverTheNames) {
  EXPECT_STREQ(FileError("a\nb", "c\r\td").what(), "a\\nb: c\\r\\td");
  EXPECT_STREQ(FileError("\x1b[31mred\x7f").what(), "\\x1b[31mred\\x7f");
  EXPECT_STREQ(FileError(std::string("nul\0!", 5)).what(), "nul\\x00!");
  EXPECT_STREQ(FileError("\xc2\x9b"  // a terminal's CSI, as one character
                         "31m")
                   .what(),
               "\\x9b31m");
}

TEST(FileError, LeavesOtherTextAlone) {
  EXPECT_STREQ(FileError("Küche – 台所.yaml\xc2").what(), "Küche – 台所.yaml\xc2");
}

}  // namespace
}  // namespace gridmerge
