// SPDX-License-Identifier: Apache-2.0
// Prints what the signatures of maps say of each pair, a line each, for fit_preselection.py.
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/match/match.hpp"
#include "match/prepared_map.hpp"
#include "preselect/compare.hpp"

using namespace gridmerge;
using namespace gridmerge::internal;

int main(int argc, char** argv) try {
  const std::vector<std::string> names(argv + 1, argv + argc);
  std::vector<Signature> signatures(names.size());
  with_threads(2, [&] {
    const auto now = [] { return std::chrono::steady_clock::now(); };
    const auto seconds = [](auto a, auto b) { return std::chrono::duration<double>(b - a).count(); };
    std::vector<std::unique_ptr<PreparedMap>> maps(names.size());
    parallel_for(names.size(),
                 [&](std::size_t i) { maps[i] = std::make_unique<PreparedMap>(load_map(names[i]).grid); });
    const auto begin = now();
    parallel_for(names.size(), [&](std::size_t i) { signatures[i] = make_signature(maps[i]->known()); });
    const auto made = now();
    std::vector<std::vector<SignatureMatch>> matches(names.size());
    parallel_for(names.size(), [&](std::size_t a) {
      for (std::size_t b = a + 1; b < names.size(); ++b) {
        const bool swap = is_smaller(*maps[b], *maps[a]);
        matches[a].push_back(swap ? compare(signatures[a], signatures[b])
                                  : compare(signatures[b], signatures[a]));
        if (!swap) matches[a].back().T_fixed_moving = inverse(matches[a].back().T_fixed_moving);
      }
    });
    std::fprintf(stderr, "signatures %.3f s, comparisons %.3f s\n", seconds(begin, made),
                 seconds(made, now()));
    std::printf(
        "fixed\tmoving\tx\ty\ttheta\tseen\tmet\topen\tchance\tvotes\tnext_votes\tlikeness\twalls_a\twalls_"
        "b\tarea_a\tarea_"
        "b\tkeys_a\tkeys_b\n");
    for (std::size_t a = 0; a < names.size(); ++a) {
      for (std::size_t b = a + 1; b < names.size(); ++b) {
        const SignatureMatch& m = matches[a][b - a - 1];
        const Signature &sa = signatures[a], &sb = signatures[b];
        std::printf(
            "%s\t%s\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%"
            "zu\t%zu\n",
            names[a].c_str(), names[b].c_str(), m.T_fixed_moving.x, m.T_fixed_moving.y,
            m.T_fixed_moving.theta, m.seen, m.met, m.open, m.chance, m.votes, m.next_votes, m.likeness,
            sa.wall_length, sb.wall_length, sa.known_area, sb.known_area, sa.keypoints.size(),
            sb.keypoints.size());
      }
    }
  });
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "gridmerge_signatures: %s\n", error.what());
  return 1;
}
