// SPDX-License-Identifier: MIT
#include "frames/experiments.h"

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "frames/frame_solver.h"
#include "run/scene_run.h"
#include "support/machine/run_context.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

using bench::ContactFrame;
using cli::Median;

constexpr int kFew = 10, kMany = 20;
/// Frames that are looked at for one of another structure than the frame before.
constexpr int kLookAhead = 20;

using Pair = std::tuple<std::uint64_t, std::uint64_t, int>;  // two ids, rows

std::set<Pair> PairsOf(const bench::ContactFrame& frame) {
  const auto id = [&](int body) { return body == kWorld ? 0 : frame.bodies[body].id; };
  std::map<std::pair<std::uint64_t, std::uint64_t>, int> rows;
  for (const Row& row : frame.rows) ++rows[std::minmax({id(row.body_a), id(row.body_b)})];
  std::set<Pair> pairs;
  for (const auto& [bodies, count] : rows) pairs.emplace(bodies.first, bodies.second, count);
  return pairs;
}

/// Body pairs, each with its number of rows, that only one of the frames has. Bodies are told apart
/// by Body::id.
int ChangedPairs(const bench::ContactFrame& a, const bench::ContactFrame& b) {
  const std::set<Pair> of_a = PairsOf(a), of_b = PairsOf(b);
  std::vector<Pair> changed;
  std::set_symmetric_difference(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                                std::back_inserter(changed));
  return static_cast<int>(changed.size());
}

/// Two neighbouring frames, of different structure if there are any.
struct Neighbours {
  ContactFrame before, after;
  int changed = 0;  ///< ChangedPairs()
  /// Of `before`: the same structure, but in memory that was not read a moment ago.
  ContactFrame copy;
};

Neighbours FindNeighbours(const SceneChoice& scene, int first) {
  cli::StateRun run(scene);
  run.Skip(first);
  Neighbours found;
  found.before = run.Record();
  found.after = run.Record();
  found.changed = ChangedPairs(found.before, found.after);
  for (int i = 0; i < kLookAhead && found.changed == 0; ++i) {
    found.before = std::exchange(found.after, run.Record());
    found.changed = ChangedPairs(found.before, found.after);
  }
  found.copy = found.before;
  return found;
}

/// What one thread count was timed with [ns per row of the frame]: CPU time for one thread, wall
/// time for more.
class Lane {
 public:
  explicit Lane(int threads)
      : threads_(threads),
        steady_(Sweeps(kFew, threads)),
        copied_(Sweeps(kFew, threads)),
        changing_(Sweeps(kFew, threads)) {}

  /// @p round: 0 and 1 make what is compared in opposite order.
  void Round(const Neighbours& frames, int round) {
    steady_.Solve(frames.before);  // into the caches, for both of the next two
    for (const int sweeps : {round == 0 ? kFew : kMany, round == 0 ? kMany : kFew}) {
      steady_.settings().max_sweeps = sweeps;
      const bool few = sweeps == kFew;
      (few ? few_ : many_).push_back(Time(frames.before, &steady_, few ? &few_wall_ : &many_wall_));
    }
    for (const int kind : {round, 1 - round}) {
      FrameSolver* const solver = kind == 0 ? &copied_ : &changing_;
      std::vector<double>* const times = kind == 0 ? &copy_ : &changed_;
      times->push_back(Time(kind == 0 ? frames.copy : frames.after, solver, nullptr));
      times->push_back(Time(frames.before, solver, nullptr));
    }
  }
  void Forget() {
    for (auto* times : {&few_, &many_, &few_wall_, &many_wall_, &copy_, &changed_}) times->clear();
  }

  double sweep() const { return (Median(many_) - Median(few_)) / (kMany - kFew); }
  double wall_sweep(double share) const {
    return (cli::Quantile(many_wall_, share) - cli::Quantile(few_wall_, share)) / (kMany - kFew);
  }
  double steady() const { return Median(few_) - kFew * sweep(); }
  double copied() const { return Median(copy_) - kFew * sweep(); }
  double changed() const { return Median(changed_) - kFew * sweep(); }

 private:
  double Time(const ContactFrame& frame, FrameSolver* solver, std::vector<double>* wall) const {
    const cli::ThreadTime time = solver->Solve(frame);
    const double to_row = 1e6 / static_cast<double>(frame.rows.size());
    if (wall != nullptr) wall->push_back(time.wall * to_row);
    return (threads_ == 1 ? time.cpu : time.wall) * to_row;
  }

  int threads_;
  FrameSolver steady_, copied_, changing_;
  std::vector<double> few_, many_, few_wall_, many_wall_, copy_, changed_;
};

std::string OfTenSweeps(const Lane& lane, double ns) {
  return fmt::format("{:.1f} ({:.0f} %)", ns, 100 * ns / (10 * lane.sweep()));
}

void AddRow(const SceneChoice& scene, const SeriesOptions& options, cli::TextTable* table) {
  const Neighbours frames = FindNeighbours(scene, scene.FirstFrame(options.frame));
  Lane one(1), two(2);
  for (Lane* lane : {&one, &two}) {
    lane->Round(frames, 0);
    lane->Forget();
  }
  for (int round = 0; round < options.rounds; ++round) {
    one.Round(frames, round % 2);
    two.Round(frames, round % 2);
  }
  table->rows.push_back({NameOf(scene), fmt::format("{}", frames.before.rows.size()),
                         fmt::format("{}", frames.changed), fmt::format("{:.3f}", one.sweep()),
                         fmt::format("{:.3f}", two.sweep()),
                         fmt::format("{:.2f}", one.wall_sweep(0.5) / two.wall_sweep(0.5)),
                         fmt::format("{:.2f}", one.wall_sweep(0.1) / two.wall_sweep(0.1)),
                         OfTenSweeps(one, one.steady()), OfTenSweeps(one, one.copied()),
                         OfTenSweeps(one, one.changed()), OfTenSweeps(two, two.steady()),
                         OfTenSweeps(two, two.changed())});
}

}  // namespace

void PrintCosts(const SeriesOptions& options, const std::string& command) {
  fmt::print("{}", cli::Origin("What a frame costs", cli::DescribeContext(command)));
  fmt::print(
      "- ns per row, medians of {} rounds, in turn; 1 thread: CPU time, 2 threads: wall time\n"
      "- sweep: difference of solves of {} and {} sweeps; 1 / 2: its wall time with 1 thread over "
      "that with 2, of medians and of the\n  fastest tenths\n"
      "- frame: begin and end of a Solve(), and in brackets their share of ten sweeps; steady: the "
      "same frame again;\n  copy: a frame and a copy of it in turn, which are not in the caches; "
      "changed: two neighbouring frames in turn,\n  'changed pairs' are in one of them only; each "
      "has a solver of its own\n\n",
      options.rounds, kFew, kMany);
  std::fflush(stdout);
  cli::TextTable table =
      cli::TableOf({"scene", "rows", "changed pairs", "sweep 1", "sweep 2", "1 / 2", "1 / 2 fast",
                    "steady 1", "copy 1", "changed 1", "steady 2", "changed 2"});
  for (const SceneChoice& scene : options.scenes) AddRow(scene, options, &table);
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
