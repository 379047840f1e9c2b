// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/evaluate/truth.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "gridmerge/io/file_error.hpp"
#include "parse_truth.hpp"

namespace gridmerge {

namespace {

// Bounds what a wrong argument (a device, a disk image) makes us read.
constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

std::string read_text(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw FileError(path, std::generic_category().message(errno));
  std::string text;
  std::array<char, 65536> block{};
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    text.append(block.data(), count);
    if (text.size() > kMaxBytes)
      throw FileError(path, "the file is larger than 16 MiB, which no truth file is");
  }
  if (std::ferror(file.get())) throw FileError(path, std::generic_category().message(errno));
  return text;
}

}  // namespace

std::vector<TruePair> read_pairs(const std::filesystem::path& path) {
  return parse_pairs(path, read_text(path));
}

std::vector<NegativePair> read_negatives(const std::filesystem::path& path) {
  return parse_negatives(path, read_text(path));
}

std::vector<TrueSet> read_sets(const std::filesystem::path& path) {
  return parse_sets(path, read_text(path));
}

}  // namespace gridmerge
