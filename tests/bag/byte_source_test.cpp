// SPDX-License-Identifier: Apache-2.0
#include "bag/byte_source.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

#include "bag/bag_builder.hpp"
#include "bag/unpacked_file.hpp"
#include "gridmerge/grid/execution.hpp"
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

// Bytes that do not pack: of so many that their packed ones are read in several pieces.
std::string noise(std::size_t count) {
  std::mt19937 random(5);
  std::string text(count, '\0');
  for (char& c : text) c = static_cast<char>(random() >> 11);
  return text;
}

TEST(ByteSource, APartOfAFileEndsWhereItIsToldTo) {
  const test::TemporaryDirectory directory;
  const RandomAccessFile file(directory.write("a", "0123456789"));
  const auto part = [&](std::uint64_t begin, std::uint64_t end) {
    return read_all(*file_part(file, begin, end), 100);
  };
  EXPECT_EQ(part(0, 10), "0123456789");
  EXPECT_EQ(part(3, 7), "3456");
  EXPECT_EQ(part(3, 4), "3");
  EXPECT_EQ(part(3, 3), "");
  EXPECT_EQ(part(5, 3), "");
  EXPECT_EQ(part(8, 20), "89");
  EXPECT_EQ(part(10, 20), "");
  const auto source = file_part(file, 2, 9);
  std::string room = "..........";
  EXPECT_EQ(source->read(room.data(), 3), 3u);
  EXPECT_EQ(source->read(room.data() + 3, 7), 4u);
  EXPECT_EQ(room, "2345678...");
  EXPECT_EQ(source->read(room.data(), 1), 0u);
}

TEST(ByteSource, ATextIsReadInSteps) {
  const auto source = text_source("01234");
  std::string room = ".......";
  EXPECT_EQ(source->read(room.data(), 2), 2u);
  EXPECT_EQ(source->read(room.data() + 2, 0), 0u);
  EXPECT_EQ(source->read(room.data() + 2, 5), 3u);
  EXPECT_EQ(room, "01234..");
  EXPECT_EQ(source->read(room.data(), 5), 0u);
}

TEST(ByteSource, ExactlySoManyBytesAreRead) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, (std::size_t{1} << 16) - 1,
                                 std::size_t{1} << 16, (std::size_t{1} << 16) + 1, std::size_t{3} << 16}) {
    const std::string text = noise(size);
    EXPECT_TRUE(read_all(*text_source(text), size) == text) << size;
    if (size == 0) continue;
    const auto source = text_source(text);
    EXPECT_EQ(test::message_of<ParseError>([&] { read_all(*source, size - 1); }),
              "it unpacks to more than " + std::to_string(size - 1) + " bytes");
  }
}

TEST(ByteSource, WhatDoesNotPackUnpacksInWhole) {
  const std::string text = noise(300'000);
  for (const bool by_zstd : {false, true}) {
    const std::string bytes = packed(text, by_zstd);
    EXPECT_GT(bytes.size(), 290'000u);
    EXPECT_TRUE(unpacked(bytes, by_zstd) == text);
    EXPECT_TRUE(unpacked(bytes + bytes, by_zstd) == text + text);
    for (const std::size_t length :
         {bytes.size() - 1, std::size_t{131'072}, std::size_t{65'536}, std::size_t{3}})
      EXPECT_EQ(test::message_of<ParseError>([&] { unpacked(bytes.substr(0, length), by_zstd); }),
                "its packed bytes end early");
    EXPECT_EQ(unpacked("", by_zstd), "");
    EXPECT_EQ(unpacked(packed("", by_zstd), by_zstd), "");
  }
}

TEST(ByteSource, SmallStepsGiveTheSame) {
  const std::string text = noise(1000) + std::string(3000, 'x') + noise(500);
  for (const bool by_zstd : {false, true}) {
    const std::string bytes = packed(text, by_zstd) + packed(text, by_zstd);
    for (const std::size_t step : {1U, 7U, 4500U, 9001U}) {
      const auto source = by_zstd ? unpack_zstd(text_source(bytes)) : unpack_lz4(text_source(bytes));
      std::string all(9000, '?');
      std::size_t made = 0;
      while (made < all.size()) {
        const std::size_t wanted = std::min(step, all.size() - made);
        ASSERT_EQ(source->read(all.data() + made, wanted), wanted);
        made += wanted;
      }
      EXPECT_TRUE(all == text + text) << step;
      char beyond = '?';
      EXPECT_EQ(source->read(&beyond, 1), 0u);
      EXPECT_EQ(beyond, '?');
    }
  }
}

TEST(ByteSource, WhatIsNotPackedSaysSo) {
  EXPECT_EQ(test::message_of<ParseError>([] { unpacked("no frame of these", true); }),
            "its Zstandard bytes do not unpack: Unknown frame descriptor");
  EXPECT_EQ(test::message_of<ParseError>([] { unpacked("no frame of these", false); }),
            "its LZ4 bytes do not unpack: ERROR_frameType_unknown");
  EXPECT_TRUE(looks_like_zstd(pack_zstd("a")));
  EXPECT_TRUE(looks_like_zstd("\x28\xb5\x2f\xfd"));
  EXPECT_FALSE(looks_like_zstd("\x28\xb5\x2f"));
  EXPECT_FALSE(looks_like_zstd("\x28\xb5\x2f\xfc"));
  EXPECT_FALSE(looks_like_zstd(pack_lz4("a")));
}

TEST(ByteSource, UnpackingEndsWhenTheWorkIsCancelled) {
  const std::string bytes = pack_zstd("a text");
  const std::atomic<bool> cancelled = true;
  EXPECT_THROW(with_cancellation(cancelled, [&] { unpacked(bytes, true); }), Cancelled);
}

TEST(UnpackedFile, HoldsExactlySoManyBytes) {
  const test::TemporaryDirectory directory;
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{1} << 20,
                                 (std::size_t{1} << 20) + 1, std::size_t{2} << 20}) {
    std::string text = noise(size / 7);
    text.resize(size, 'x');
    const std::string path = directory.write("a.zstd", pack_zstd(text));
    EXPECT_TRUE(test::read_file(UnpackedFile(path, size).path()) == text) << size;
    if (size == 0) continue;
    EXPECT_EQ(
        test::message_of<FileError>([&] { UnpackedFile(path, size - 1); }),
        path + ": unpacks to more than " + std::to_string(size - 1) + " bytes: unpack it yourself (zstd -d)");
  }
}

TEST(UnpackedFile, NeedsAFolderOfTemporaryFiles) {
  const test::TemporaryDirectory directory, temporary;
  const std::string path = directory.write("a.zstd", pack_zstd("a text"));
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  {
    const UnpackedFile file(path);
    const std::string opened = std::filesystem::read_symlink(file.path()).string();
    EXPECT_TRUE(opened.starts_with(temporary.file("gridmerge-bag-"))) << opened;
  }
  ::setenv("TMPDIR", directory.file("none").c_str(), 1);
  { const UnpackedFile file(path); }  // elsewhere then
  ::unsetenv("TMPDIR");
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
