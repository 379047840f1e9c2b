// SPDX-License-Identifier: Apache-2.0
// A match as bytes, and as a file of a cache that holds these bytes with a true checksum, or is them.
#include <optional>
#include <stdexcept>
#include <string>

#include "cache/match_file.hpp"
#include "fuzz_target.hpp"
#include "grid/sha256.hpp"
#include "gridmerge/match/stored_match.hpp"

using namespace gridmerge;
using namespace gridmerge::internal;

namespace {

template <typename Read>
std::optional<MatchResult> read(const Read& read_it) {
  try {
    return read_it();
  } catch (const std::invalid_argument&) {
    return {};
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = fuzz::as_bytes(data, size);
  const std::string key(64, 'a');
  read([&] { return parse_match_file(bytes, key); });
  const std::optional<MatchResult> match = read([&] { return match_from_bytes(bytes); });
  std::string file = "gridmerge match 1\n" + key + "\n";
  file += bytes;
  const Sha256::Digest digest = Sha256().add(file).digest();
  file.append(digest.begin(), digest.end());
  const std::optional<MatchResult> of_file = read([&] { return parse_match_file(file, key); });
  fuzz::require(of_file.has_value() == match.has_value());
  if (!match) return 0;
  fuzz::require(to_bytes(*match) == bytes);
  fuzz::require(to_bytes(*of_file) == bytes);
  fuzz::require(format_match_file(*match, key) == file);
  return 0;
}
