// SPDX-License-Identifier: Apache-2.0
#include "merge/comparisons.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>

#include "grid/parallel.hpp"
#include "grid/sha256.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "preselect/chance.hpp"
#include "preselect/compare.hpp"

namespace gridmerge::internal {

namespace {

/// So many that processes that begin at different ones seldom make the same, and few enough to be files.
constexpr std::size_t kParts = 32;

struct Pair {
  std::size_t a, b;
};

float log_odds_of(const std::vector<const Signature*>& signatures, const Pair& pair) {
  const Signature &moving = *signatures[pair.a], &fixed = *signatures[pair.b];
  return static_cast<float>(log_odds_of_joining(compare(fixed, moving), fixed, moving));
}

class Parts {
 public:
  Parts(const std::vector<const Signature*>& signatures, const ComparisonStore& store,
        const std::string& name)
      : signatures_(signatures), store_(store), name_(name) {
    std::size_t pairs = 0;
    for (std::size_t a = 0; a < signatures.size(); ++a) {
      row_starts_.push_back(pairs);
      pairs += signatures.size() - 1 - a;
    }
    log_odds_.resize(pairs);
  }

  std::vector<float> all() {
    const auto begin = static_cast<std::size_t>(store_.begin * static_cast<double>(kParts));
    for (std::size_t i = 0; i < kParts; ++i) {
      throw_if_cancelled();
      take((begin + i) % kParts);
    }
    return std::move(log_odds_);
  }

 private:
  void take(std::size_t part) {
    const std::size_t first = part * log_odds_.size() / kParts, end = (part + 1) * log_odds_.size() / kParts;
    if (first == end) return;
    const std::string name = to_hex(Sha256().add(name_).add(std::to_string(part)).digest());
    if (const std::optional<std::vector<float>> kept = store_.find(name);
        kept && kept->size() == end - first) {
      std::copy(kept->begin(), kept->end(), log_odds_.begin() + static_cast<std::ptrdiff_t>(first));
      return;
    }
    parallel_for(end - first,
                 [&](std::size_t i) { log_odds_[first + i] = log_odds_of(signatures_, pair_at(first + i)); });
    store_.keep(name, {log_odds_.begin() + static_cast<std::ptrdiff_t>(first),
                       log_odds_.begin() + static_cast<std::ptrdiff_t>(end)});
  }

  Pair pair_at(std::size_t place) const {
    const auto row = std::prev(std::upper_bound(row_starts_.begin(), row_starts_.end(), place));
    const auto a = static_cast<std::size_t>(row - row_starts_.begin());
    return {a, a + 1 + place - *row};
  }

  const std::vector<const Signature*>& signatures_;
  const ComparisonStore& store_;
  std::string name_;
  std::vector<std::size_t> row_starts_;  // where the pairs of each first map begin
  std::vector<float> log_odds_;
};

}  // namespace

std::vector<float> compare_all(const std::vector<const Signature*>& signatures, const ComparisonStore& store,
                               const std::function<std::vector<std::string>()>& contents) {
  if (store.find) {
    Sha256 name;
    name.add(engine_id());
    for (const std::string& content : contents()) name.add(content);
    return Parts(signatures, store, to_hex(name.digest())).all();
  }
  const std::size_t count = signatures.size();
  std::vector<float> log_odds(count * (count - 1) / 2);
  parallel_for(count, [&](std::size_t a) {
    std::size_t place = a * count - a * (a + 1) / 2;
    for (std::size_t b = a + 1; b < count; ++b) log_odds[place++] = log_odds_of(signatures, {a, b});
  });
  return log_odds;
}

}  // namespace gridmerge::internal
