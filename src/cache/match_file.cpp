// SPDX-License-Identifier: Apache-2.0
#include "cache/match_file.hpp"

#include <algorithm>
#include <stdexcept>

#include "cache/checksum.hpp"
#include "gridmerge/match/stored_match.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::string_view kFormat = "gridmerge match 1\n";

}  // namespace

std::string format_match_file(const MatchResult& match, std::string_view key) {
  std::string bytes(kFormat);
  bytes.append(key).append("\n").append(to_bytes(match));
  return bytes + checksum_of(bytes);
}

MatchResult parse_match_file(std::string_view bytes, std::string_view key) {
  if (!bytes.starts_with(kFormat)) throw std::invalid_argument("is no match of this format");
  if (bytes.size() < kFormat.size() + key.size() + 1 + kChecksum) throw std::invalid_argument("is cut short");
  const std::string_view content = bytes.substr(0, bytes.size() - kChecksum);
  if (bytes.substr(content.size()) != checksum_of(content))
    throw std::invalid_argument("is damaged: its checksum is not that of its content");
  const std::string_view rest = content.substr(kFormat.size());
  if (!rest.starts_with(key) || rest[key.size()] != '\n')
    throw std::invalid_argument("is a match of something else");
  return match_from_bytes(rest.substr(key.size() + 1));
}

}  // namespace gridmerge::internal
