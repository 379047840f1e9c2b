// SPDX-License-Identifier: Apache-2.0
#include "bag/byte_source.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <string>

#include "bag/bag_builder.hpp"
#include "bag/unpacked_file.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/parse_error.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using namespace internal;
using test::contains;
using test::pack_lz4;
using test::pack_zstd;

constexpr std::size_t kMax = std::size_t{1} << 24;

std::string unpacked(const std::string& packed, bool by_zstd) {
  auto source = text_source(packed);
  source = by_zstd ? unpack_zstd(std::move(source)) : unpack_lz4(std::move(source));
  return read_all(*source, kMax);
}

std::string packed(const std::string& text, bool by_zstd) {
  return by_zstd ? pack_zstd(text) : pack_lz4(text);
}

rc::Gen<std::string> any_text() {
  return rc::gen::map(rc::gen::pair(rc::gen::arbitrary<std::string>(), rc::gen::inRange(0, 2000)),
                      [](const std::pair<std::string, int>& parts) {
                        std::string text;
                        for (int i = 0; i < parts.second; ++i) text += parts.first;
                        return text;
                      });
}

RC_GTEST_PROP(ByteSource, WhatIsPackedUnpacks, (bool by_zstd)) {
  const std::string text = *any_text(), more = *any_text();
  RC_ASSERT(unpacked(packed(text, by_zstd), by_zstd) == text);
  RC_ASSERT(unpacked(packed(text, by_zstd) + packed(more, by_zstd), by_zstd) == text + more);
}

RC_GTEST_PROP(ByteSource, APackedTextCutShortIsRefused, (bool by_zstd)) {
  const std::string whole = packed(*any_text() + "more", by_zstd);
  const auto length = *rc::gen::inRange<std::size_t>(1, whole.size());
  RC_ASSERT_THROWS_AS(unpacked(whole.substr(0, length), by_zstd), ParseError);
}

RC_GTEST_PROP(ByteSource, DamageIsRefusedOrHarmless, (bool by_zstd)) {
  std::string whole = packed(*any_text(), by_zstd);
  whole[*rc::gen::inRange<std::size_t>(0, whole.size())] = *rc::gen::arbitrary<char>();
  try {
    unpacked(whole, by_zstd);
  } catch (const ParseError&) {
  }
}

TEST(ByteSource, WhatUnpacksToTooMuchIsRefused) {
  const std::string bomb = pack_zstd(std::string(std::size_t{1} << 22, '\0'));
  EXPECT_LT(bomb.size(), 1000u);
  const auto source = unpack_zstd(text_source(bomb));
  EXPECT_TRUE(contains(test::message_of<ParseError>([&] { read_all(*source, 1'000'000); }),
                       "more than 1000000 bytes"));
}

TEST(UnpackedFile, HasNoName) {
  const test::TemporaryDirectory directory, temporary;
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  const std::string text(3'000'000, 'x');
  const std::string path = directory.write("a.zstd", pack_zstd(text));
  {
    const UnpackedFile file(path);
    EXPECT_EQ(test::read_file(file.path()), text);
    EXPECT_TRUE(temporary.names().empty());  // so a kill leaves nothing
  }
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { UnpackedFile(path, 2'000'000); }),
                       path + ": unpacks to more than 2000000 bytes"));
  const std::string cut = directory.write("cut.zstd", pack_zstd(text).substr(0, 60));
  EXPECT_TRUE(contains(test::message_of<FileError>([&] { UnpackedFile{cut}; }), "end early"));
  EXPECT_TRUE(temporary.names().empty());
  ::unsetenv("TMPDIR");
}

}  // namespace
}  // namespace gridmerge
