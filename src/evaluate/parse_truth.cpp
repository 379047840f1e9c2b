// SPDX-License-Identifier: Apache-2.0
#include "evaluate/parse_truth.hpp"

#include <algorithm>

#include "io/text_table.hpp"

namespace gridmerge::internal {

namespace {

// Reads the columns that the formats share, one row at a time.
class TruthRows {
 public:
  TruthRows(const std::filesystem::path& path, std::string_view text,
            const std::vector<std::string_view>& required, const std::vector<std::string_view>& optional = {})
      : table_(path, text, required, optional), directory_(path.parent_path()) {}

  const TextTable& table() const { return table_; }

  TruthMap map(std::size_t row, std::string_view column) const {
    const std::string& name = table_.text(row, column);
    // The system would read the name up to there, and open another file than the one that messages show.
    if (name.find('\0') != std::string::npos)
      table_.fail(row, std::string(column) + " holds a NUL character");
    return {name, directory_ / name, table_.place(row)};
  }

  SE2 transform(std::size_t row) const {
    return {table_.number(row, "x"), table_.number(row, "y"), normalize_angle(table_.number(row, "theta"))};
  }

  double tolerance(std::size_t row) const {
    const double tolerance = table_.number(row, "tolerance");
    if (tolerance <= 0.0) table_.fail(row, "tolerance must be positive");
    return tolerance;
  }

  double overlap(std::size_t row) const {
    const double overlap = table_.number(row, "overlap");
    if (overlap < 0.0 || overlap > 1.0) table_.fail(row, "overlap must be between 0 and 1");
    return overlap;
  }

  double shared_wall(std::size_t row) const {
    const double metres = table_.number(row, "shared_wall");
    if (metres < 0.0) table_.fail(row, "shared_wall must not be negative");
    return metres;
  }

 private:
  TextTable table_;
  std::filesystem::path directory_;
};

}  // namespace

std::vector<TruePair> parse_pairs(const std::filesystem::path& path, std::string_view text) {
  const TruthRows rows(path, text, {"fixed", "moving", "x", "y", "theta", "tolerance"},
                       {"tier", "overlap", "shared_wall"});
  const TextTable& table = rows.table();
  std::vector<TruePair> pairs;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    pairs.push_back({rows.map(row, "fixed"), rows.map(row, "moving"), rows.transform(row),
                     rows.tolerance(row), table.has("tier") ? table.text(row, "tier") : std::string(),
                     table.has("overlap") ? rows.overlap(row) : 0.0,
                     table.has("shared_wall") ? rows.shared_wall(row) : 0.0});
  }
  return pairs;
}

std::vector<NegativePair> parse_negatives(const std::filesystem::path& path, std::string_view text) {
  const TruthRows rows(path, text, {"fixed", "moving"});
  std::vector<NegativePair> negatives;
  for (std::size_t row = 0; row < rows.table().rows(); ++row) {
    negatives.push_back({rows.map(row, "fixed"), rows.map(row, "moving")});
  }
  return negatives;
}

std::vector<TrueSet> parse_sets(const std::filesystem::path& path, std::string_view text) {
  const TruthRows rows(path, text, {"set", "map", "x", "y", "theta", "tolerance"});
  std::vector<TrueSet> sets;
  std::vector<std::size_t> first_rows;
  for (std::size_t row = 0; row < rows.table().rows(); ++row) {
    const std::string& name = rows.table().text(row, "set");
    auto set =
        std::find_if(sets.begin(), sets.end(), [&](const TrueSet& other) { return other.name == name; });
    if (set == sets.end()) {
      set = sets.insert(sets.end(), {name, {}});
      first_rows.push_back(row);
    }
    set->members.push_back({rows.map(row, "map"), rows.transform(row), rows.tolerance(row)});
  }
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (sets[i].members.size() < 2)
      rows.table().fail(first_rows[i], "set '" + sets[i].name + "' has a single map");
  }
  return sets;
}

}  // namespace gridmerge::internal
