// SPDX-License-Identifier: Apache-2.0
#include "cache/comparison_file.hpp"

#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "cache/checksum.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/atomic_file.hpp"
#include "io/file_reader.hpp"
#include "io/made_directories.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::string_view kFormat = "gridmerge comparisons 1\n";
constexpr std::size_t kMaxBytes = std::size_t{1}
                                  << 32;  // of a part of the pairs of some hundred thousand maps

std::optional<std::vector<float>> find(const std::filesystem::path& file, const std::string& name) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  try {
    FileReader reader(file, NamedBy::file);
    return parse_comparisons(reader.read_all(kMaxBytes), name);
  } catch (const std::invalid_argument&) {  // made again, and written over
  } catch (const FileError&) {
  }
  return std::nullopt;
}

void keep(const std::filesystem::path& file, const std::string& name, const std::vector<float>& log_odds) {
  const MadeDirectories made(file.parent_path());
  write_file_atomically(file, format_comparisons(log_odds, name));
}

}  // namespace

std::string format_comparisons(const std::vector<float>& log_odds, std::string_view name) {
  std::string bytes(kFormat);
  bytes.append(name).append("\n");
  for (const float value : log_odds) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 0xff);
  }
  return bytes + checksum_of(bytes);
}

std::vector<float> parse_comparisons(std::string_view bytes, std::string_view name) {
  const std::string head = std::string(kFormat).append(name).append("\n");
  if (!bytes.starts_with(head) || bytes.size() < head.size() + kChecksum)
    throw std::invalid_argument("is no part of these comparisons");
  const std::string_view content = bytes.substr(0, bytes.size() - kChecksum);
  if (bytes.substr(content.size()) != checksum_of(content)) throw std::invalid_argument("is damaged");
  const std::string_view numbers = content.substr(head.size());
  if (numbers.size() % 4 != 0) throw std::invalid_argument("is damaged");
  std::vector<float> log_odds(numbers.size() / 4);
  for (std::size_t i = 0; i < numbers.size(); i += 4) {
    std::uint32_t bits = 0;
    for (std::size_t k = 4; k-- > 0;) bits = bits << 8 | static_cast<std::uint8_t>(numbers[i + k]);
    log_odds[i / 4] = std::bit_cast<float>(bits);
  }
  return log_odds;
}

ComparisonStore comparisons_in(MatchCache& cache, const Shard& shard, bool goes_on_when_full) {
  const std::filesystem::path folder = cache.directory() / "compared";
  ComparisonStore store;
  store.begin = static_cast<double>(shard.index) / static_cast<double>(shard.count);
  store.find = [folder](const std::string& name) { return find(folder / name, name); };
  store.keep = [folder, goes_on_when_full, &cache](const std::string& name,
                                                   const std::vector<float>& log_odds) {
    try {
      keep(folder / name, name, log_odds);
    } catch (const FileError& error) {
      if (!goes_on_when_full) throw;
      cache.warn_not_kept(error);
    }
  };
  return store;
}

}  // namespace gridmerge::internal
