// SPDX-License-Identifier: Apache-2.0
// What a merge of many maps takes to write and to read: arguments are the number of maps, and of how many
// pairs one was compared. "bytes" is the size of transforms.json.
#include <benchmark/benchmark.h>

#include "gridmerge/report/merge_record.hpp"
#include "report/fleet.hpp"

namespace gridmerge {
namespace {

void arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)
      ->Args({50, 1})
      ->Args({1000, 1})
      ->Args({1000, 24})
      ->Args({3000, 24});
}

MergeResult fleet_of(const benchmark::State& state) {
  return test::fleet(static_cast<std::size_t>(state.range(0)), static_cast<std::size_t>(state.range(1)));
}

void write_transforms(benchmark::State& state) {
  const MergeResult result = fleet_of(state);
  const std::vector<std::string> names = test::fleet_names(static_cast<std::size_t>(state.range(0)));
  std::size_t bytes = 0;
  for (auto _ : state) bytes = transforms_json(names, result).size();
  state.counters["bytes"] = static_cast<double>(bytes);
  state.counters["joins"] = static_cast<double>(result.joins.size());
}
BENCHMARK(write_transforms)->Apply(arguments);

void read_transforms(benchmark::State& state) {
  const std::string text =
      transforms_json(test::fleet_names(static_cast<std::size_t>(state.range(0))), fleet_of(state));
  for (auto _ : state) benchmark::DoNotOptimize(parse_transforms("transforms.json", text).names.size());
}
BENCHMARK(read_transforms)->Apply(arguments);

}  // namespace
}  // namespace gridmerge
