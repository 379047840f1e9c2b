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
  EXPECT_STREQ(FileError("\x1f\xc2\x80\xc2\x9f").what(), "\\x1f\\x80\\x9f") << "the last ones";
}

TEST(FileError, CutsTheMiddleOutOfMoreThanTenThousandBytes) {
  const std::string whole = "the file" + std::string(9'984, 'x') + "the cause";
  EXPECT_EQ(FileError(whole.substr(1)).what(), whole.substr(1));
  EXPECT_EQ(FileError(whole).what(), "the file" + std::string(292, 'x') + " [... 9401 bytes ...] " +
                                         std::string(291, 'x') + "the cause");
}

TEST(FileError, LeavesOtherTextAlone) {
  EXPECT_STREQ(FileError("Küche – 台所.yaml\xc2").what(), "Küche – 台所.yaml\xc2");
  // The first ones behind each range of controls, the second of which is a space that no line is broken at.
  EXPECT_STREQ(FileError(" ~\xc2\xa0!").what(), " ~\xc2\xa0!");
  EXPECT_STREQ(FileError("\xc3\x80").what(), "\xc3\x80") << "a letter with the second byte of a control";
}

}  // namespace
}  // namespace gridmerge
