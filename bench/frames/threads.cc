// SPDX-License-Identifier: MIT
#include "frames/experiments.h"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "frames/frame_solver.h"
#include "run/scene_run.h"
#include "support/machine/run_context.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

constexpr int kSweeps = 10;
/// One thread twice: what differs between the two is noise.
constexpr std::array<int, 3> kThreads = {1, 1, 2};

/// [us]
using Times = std::array<std::vector<double>, kThreads.size()>;

Times TimeFrame(const bench::ContactFrame& frame, int rounds) {
  std::vector<FrameSolver> solvers;
  for (const int threads : kThreads) solvers.emplace_back(Sweeps(kSweeps, threads));
  for (FrameSolver& solver : solvers) solver.Solve(frame);
  Times times;
  for (int round = 0; round < rounds; ++round) {
    for (size_t k = 0; k < solvers.size(); ++k) {
      const size_t lane = (k + static_cast<size_t>(round)) % solvers.size();
      times[lane].push_back(1e3 * solvers[lane].Solve(frame).wall);
    }
  }
  return times;
}

}  // namespace

void PrintThreads(const SeriesOptions& options, const std::string& command) {
  fmt::print("{}", cli::Origin("Threads: wall time of a Solve() of ten sweeps",
                               cli::DescribeContext(command)));
  fmt::print(
      "- {} rounds, in turn; medians, and ratios of medians and of the fastest tenths\n"
      "- 1 / 1: one thread against one thread again, which is noise\n\n",
      options.rounds);
  cli::TextTable table = cli::TableOf({"scene", "rows", "1 thread us", "2 threads us", "1 / 2",
                                       "1 / 2 fast", "1 / 1", "1 / 1 fast"});
  for (const SceneChoice& scene : options.scenes) {
    cli::StateRun run(scene);
    run.Skip(scene.FirstFrame(options.frame));
    const bench::ContactFrame frame = run.Record();
    const Times times = TimeFrame(frame, options.rounds);
    const auto ratio = [&](int lane, double share) {
      return fmt::format("{:.2f}",
                         cli::Quantile(times[0], share) / cli::Quantile(times[lane], share));
    };
    table.rows.push_back({NameOf(scene), fmt::format("{}", frame.rows.size()),
                          fmt::format("{:.1f}", cli::Median(times[0])),
                          fmt::format("{:.1f}", cli::Median(times[2])), ratio(2, 0.5),
                          ratio(2, 0.1), ratio(1, 0.5), ratio(1, 0.1)});
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
