// SPDX-License-Identifier: Apache-2.0
#include "evaluate/parse_truth.hpp"
#include "gridmerge/evaluate/evaluate.hpp"
#include "io/file_reader.hpp"

namespace gridmerge {

using namespace internal;

namespace {

// Bounds what a wrong argument (a device, a disk image) makes us read.
constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

std::string read_text(const std::filesystem::path& path) {
  FileReader reader(path);
  return reader.read_all(kMaxBytes);
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
