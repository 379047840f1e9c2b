// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_system.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>
#include <optional>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "merge/elastic_span.hpp"

namespace gridmerge::internal {

namespace {

constexpr int kMostSteps = 120;
constexpr double kEnough = 1e-4;  // of the first residual

using Vectors = std::vector<Eigen::VectorXd>;  // of each map: x and y of its first shift, of the next, ...

Eigen::Index unknowns_of(const ElasticMember& member) {
  return 2 * static_cast<Eigen::Index>(member.sheet.size());
}

Vectors zeros(const std::vector<ElasticMember>& members) {
  Vectors vectors;
  for (const ElasticMember& member : members)
    vectors.emplace_back(Eigen::VectorXd::Zero(unknowns_of(member)));
  return vectors;
}

double dot(const Vectors& a, const Vectors& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

void add(double factor, const Vectors& of, Vectors& to) {
  for (std::size_t i = 0; i < of.size(); ++i) to[i] += factor * of[i];
}

/// A map's directions in the group's.
struct Turn {
  explicit Turn(const ElasticMember& member)
      : c(std::cos(member.sheet.direction())), s(std::sin(member.sheet.direction())) {}
  Point2 to_group(const Point2& p) const { return {c * p.x - s * p.y, s * p.x + c * p.y}; }
  Point2 from_group(const Point2& p) const { return {c * p.x + s * p.y, -s * p.x + c * p.y}; }

  double c, s;
};

Point2 gathered(const SplineWeights& weights, int columns, const Eigen::VectorXd& shifts) {
  Point2 sum;
  for (int b = 0; b < 4; ++b) {
    const Eigen::Index begin = 2 * (static_cast<Eigen::Index>(weights.row + b) * columns + weights.column);
    for (Eigen::Index a = 0; a < 4; ++a) {
      const double weight = weights.y[b] * weights.x[a];
      sum.x += weight * shifts[begin + 2 * a];
      sum.y += weight * shifts[begin + 2 * a + 1];
    }
  }
  return sum;
}

void scatter(const SplineWeights& weights, int columns, const Point2& value, Eigen::VectorXd& to) {
  for (int b = 0; b < 4; ++b) {
    const Eigen::Index begin = 2 * (static_cast<Eigen::Index>(weights.row + b) * columns + weights.column);
    for (Eigen::Index a = 0; a < 4; ++a) {
      const double weight = weights.y[b] * weights.x[a];
      to[begin + 2 * a] += weight * value.x;
      to[begin + 2 * a + 1] += weight * value.y;
    }
  }
}

/// What a gap pulls with.
Point2 pull(const WallTie& tie, const Point2& gap) {
  const double across = tie.across * (tie.normal.x * gap.x + tie.normal.y * gap.y);
  const double along = tie.along * (-tie.normal.y * gap.x + tie.normal.x * gap.y);
  return {across * tie.normal.x - along * tie.normal.y, across * tie.normal.y + along * tie.normal.x};
}

class System {
 public:
  System(const std::vector<ElasticMember>& members, const std::vector<TiedPair>& pairs,
         const std::vector<Eigen::SparseMatrix<double>>& energies)
      : members_(members), pairs_(pairs), energies_(energies), pulls_(pairs.size()) {
    for (const ElasticMember& member : members) turns_.emplace_back(member);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      pulls_[i] = {Eigen::VectorXd::Zero(unknowns_of(members[pairs[i].first])),
                   Eigen::VectorXd::Zero(unknowns_of(members[pairs[i].second]))};
    for (const ElasticMember& member : members) spans_.push_back(span_of(member.sheet, member.freedom));
    factors_.resize(members.size());
    parallel_for(members.size(), [&](std::size_t i) { factorise(i); });
  }

  /// The gradient of the energy at the present shifts, turned round.
  Vectors forces(const Vectors& shifts) {
    Vectors force = collect([](const WallTie& tie, std::size_t) { return pull(tie, tie.gap); });
    for (std::size_t i = 0; i < members_.size(); ++i) force[i] = -(force[i] + energies_[i] * shifts[i]);
    confine(force);
    return force;
  }

  /// The second derivative of the energy, times a change of the shifts.
  Vectors times(const Vectors& change) {
    Vectors product = collect([&](const WallTie& tie, std::size_t i) {
      const TiedPair& pair = pairs_[i];
      const Point2 first = shift_of(pair.first, tie.at_first, change);
      const Point2 second = shift_of(pair.second, tie.at_second, change);
      return pull(tie, {first.x - second.x, first.y - second.y});
    });
    for (std::size_t i = 0; i < members_.size(); ++i) product[i] += energies_[i] * change[i];
    confine(product);
    return product;
  }

  Vectors preconditioned(const Vectors& residual) const {
    Vectors result(residual.size());
    parallel_for(residual.size(), [&](std::size_t i) {
      if (members_[i].held) {
        result[i] = residual[i];
      } else if (spans_[i]) {
        result[i] = *spans_[i] * factors_[i].solve(spans_[i]->transpose() * residual[i]);
      } else {
        result[i] = factors_[i].solve(residual[i]);
      }
    });
    return result;
  }

 private:
  Point2 shift_of(std::size_t map, const SplineWeights& at, const Vectors& shifts) const {
    return turns_[map].to_group(gathered(at, members_[map].sheet.columns(), shifts[map]));
  }

  /// What the ties pull at each shift, with the pull of each by `pull_of`. Pair by pair, and the pairs' sums
  /// in their order, so that threads change nothing.
  template <typename PullOf>
  Vectors collect(PullOf pull_of) {
    parallel_for(pairs_.size(), [&](std::size_t i) {
      const TiedPair& pair = pairs_[i];
      auto& [first, second] = pulls_[i];
      first.setZero();
      second.setZero();
      for (const WallTie& tie : pair.ties) {
        const Point2 force = pull_of(tie, i);
        scatter(tie.at_first, members_[pair.first].sheet.columns(), turns_[pair.first].from_group(force),
                first);
        scatter(tie.at_second, members_[pair.second].sheet.columns(),
                turns_[pair.second].from_group({-force.x, -force.y}), second);
      }
    });
    Vectors sums = zeros(members_);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      sums[pairs_[i].first] += pulls_[i].first;
      sums[pairs_[i].second] += pulls_[i].second;
    }
    return sums;
  }

  /// To what each sheet may become.
  void confine(Vectors& vectors) const {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (members_[i].held) {
        vectors[i].setZero();
      } else if (spans_[i]) {
        vectors[i] = *spans_[i] * (spans_[i]->transpose() * vectors[i]);
      }
    }
  }

  void factorise(std::size_t map) {
    if (members_[map].held) return;
    Eigen::MatrixXd matrix = energies_[map];
    for (const TiedPair& pair : pairs_) {
      if (pair.first != map && pair.second != map) continue;
      throw_if_cancelled();
      for (const WallTie& tie : pair.ties) add_stiffness(tie, map, pair.first == map, matrix);
    }
    if (spans_[map]) {
      const Eigen::MatrixXd& span = *spans_[map];
      matrix = (span.transpose() * (matrix.selfadjointView<Eigen::Lower>() * span)).eval();
    }
    factors_[map].compute(matrix);
  }

  /// Of a tie, into the lower half.
  void add_stiffness(const WallTie& tie, std::size_t map, bool is_first, Eigen::MatrixXd& matrix) const {
    const SplineWeights& at = is_first ? tie.at_first : tie.at_second;
    const Point2 x = turns_[map].from_group(pull(tie, turns_[map].to_group({1.0, 0.0})));
    const Point2 y = turns_[map].from_group(pull(tie, turns_[map].to_group({0.0, 1.0})));
    const int columns = members_[map].sheet.columns();
    for (int k = 0; k < 16; ++k) {
      const Eigen::Index i = 2 * (static_cast<Eigen::Index>(at.row + k / 4) * columns + at.column + k % 4);
      const double weight = at.y[k / 4] * at.x[k % 4];
      for (int l = 0; l <= k; ++l) {
        const Eigen::Index j = 2 * (static_cast<Eigen::Index>(at.row + l / 4) * columns + at.column + l % 4);
        const double both = weight * at.y[l / 4] * at.x[l % 4];
        matrix(i, j) += both * x.x;
        matrix(i + 1, j) += both * x.y;
        if (l < k) matrix(i, j + 1) += both * y.x;
        matrix(i + 1, j + 1) += both * y.y;
      }
    }
  }

  const std::vector<ElasticMember>& members_;
  const std::vector<TiedPair>& pairs_;
  const std::vector<Eigen::SparseMatrix<double>>& energies_;
  std::vector<Turn> turns_;
  std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>> pulls_;  // of each pair, at its two maps
  std::vector<std::optional<Eigen::MatrixXd>> spans_;               // of what each sheet may become
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factors_;
};

}  // namespace

std::vector<std::vector<Point2>> solve_shifts(const std::vector<ElasticMember>& members,
                                              const std::vector<TiedPair>& pairs,
                                              const std::vector<Eigen::SparseMatrix<double>>& energies) {
  System system(members, pairs, energies);
  Vectors shifts = zeros(members);
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (std::size_t k = 0; k < members[i].sheet.size(); ++k) {
      shifts[i][2 * static_cast<Eigen::Index>(k)] = members[i].sheet.shifts()[k].x;
      shifts[i][2 * static_cast<Eigen::Index>(k) + 1] = members[i].sheet.shifts()[k].y;
    }
  }
  // Conjugate gradients (Hestenes and Stiefel 1952) for the change of the shifts.
  Vectors residual = system.forces(shifts);
  Vectors direction = system.preconditioned(residual);
  double size = dot(residual, direction);
  const double enough = kEnough * kEnough * size;
  for (int step = 0; step < kMostSteps && size > enough; ++step) {
    throw_if_cancelled();
    const Vectors product = system.times(direction);
    const double length = size / dot(direction, product);
    add(length, direction, shifts);
    add(-length, product, residual);
    Vectors next = system.preconditioned(residual);
    const double next_size = dot(residual, next);
    add(next_size / size, direction, next);
    direction = std::move(next);
    size = next_size;
  }
  std::vector<std::vector<Point2>> solved;
  for (const Eigen::VectorXd& of : shifts) {
    std::vector<Point2>& points = solved.emplace_back();
    for (Eigen::Index k = 0; k < of.size(); k += 2) points.push_back({of[k], of[k + 1]});
  }
  return solved;
}

}  // namespace gridmerge::internal
