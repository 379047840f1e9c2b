// SPDX-License-Identifier: Apache-2.0
#include "preselect/proposals.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "preselect/dot_products.hpp"

namespace gridmerge::internal {

namespace {

bool is_before(const Proposal& a, const Proposal& b) {
  return std::tuple(-a.product, a.fixed, a.moving, a.quarters) <
         std::tuple(-b.product, b.fixed, b.moving, b.quarters);
}

/// Of many proposals, the best few. It sorts out the others each time that as many again have come.
class BestProposals {
 public:
  explicit BestProposals(std::size_t most) : most_(most) { kept_.reserve(2 * most); }

  void add(const Proposal& proposal) {
    if (proposal.product < least_) return;
    kept_.push_back(proposal);
    if (kept_.size() < 2 * most_) return;
    drop_others();
    least_ = kept_.back().product;
  }

  std::vector<Proposal> sorted() && {
    drop_others();
    std::sort(kept_.begin(), kept_.end(), is_before);
    return std::move(kept_);
  }

 private:
  /// The last of those that stay is the worst one of them.
  void drop_others() {
    if (kept_.size() <= most_) return;
    const auto worst = kept_.begin() + static_cast<std::ptrdiff_t>(most_) - 1;
    std::nth_element(kept_.begin(), worst, kept_.end(), is_before);
    kept_.resize(most_);
  }

  std::size_t most_;
  std::vector<Proposal> kept_;
  std::int32_t least_ = 1;  // a lower product is not among the best
};

}  // namespace

std::vector<Proposal> most_alike(const std::vector<Descriptor>& fixed, const std::vector<Descriptor>& moving,
                                 std::size_t most) {
  if (most == 0 || moving.empty()) return {};
  BestProposals best(most);
  std::vector<std::int32_t> products(moving.size());
  for (int quarters = 0; quarters < 4; ++quarters) {
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      const Descriptor turned = quarter_turned(fixed[i], quarters);
      dot_products(turned.data(), moving.front().data(), moving.size(), products.data());
      for (std::size_t j = 0; j < moving.size(); ++j)
        best.add({products[j], static_cast<int>(i), static_cast<int>(j), quarters});
    }
  }
  return std::move(best).sorted();
}

}  // namespace gridmerge::internal
