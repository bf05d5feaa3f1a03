// SPDX-License-Identifier: MIT
#include "frames/experiments.h"

#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <chrono>

#include "measure/instrumented_solver.h"
#include "run/scene_run.h"
#include "support/duration.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

constexpr int kIterations = 10;

/// A scene in a world of its own.
class TimedWorld {
 public:
  TimedWorld(const SceneChoice& choice, btConstraintSolver* solver) : run_(choice, solver) {
    run_.world().solver_info().m_numIterations = kIterations;
  }

  void Step(bool keep) {
    run_.TakeTime();
    const cli::ThreadStopwatch stopwatch;
    run_.Step();
    const double step = 1e3 * stopwatch.Read().wall;
    if (!keep) return;
    const double solver = 1e3 * cli::Milliseconds(run_.TakeTime());
    whole.push_back(step);
    inside.push_back(solver);
    outside.push_back(step - solver);
  }

  std::vector<double> whole, inside, outside;  ///< [us]

 private:
  cli::SceneRun run_;
};

}  // namespace

void PrintSteps(const WindowOptions& options, Work work, const std::string& command) {
  fmt::print("{}", cli::Origin(fmt::format("Whole steps of a world: Bullet's ten iterations, and "
                                           "Cairn's {}; one thread",
                                           Describe(work)),
                               cli::DescribeContext(command)));
  fmt::print("- two worlds in turn, {} frames; medians, wall clock, milliseconds\n\n",
             options.frames);
  cli::TextTable table =
      cli::TableOf({"scene", "step, Bullet", "of it solver", "step, Cairn", "of it solver",
                    "outside the solver", "ratio of steps", "ratio of solvers"});
  for (const SceneChoice& scene : options.scenes) {
    btSequentialImpulseConstraintSolver stock;
    bullet::ConstraintSolver cairn(SettingsFor(work, 1));
    TimedWorld bullet_world(scene, &stock), cairn_world(scene, &cairn);
    const int first = scene.FirstFrame(options.frame);
    for (int frame = 0; frame < first + options.frames; ++frame) {
      bullet_world.Step(frame >= first);
      cairn_world.Step(frame >= first);
    }
    const auto ms = [](const std::vector<double>& us) {
      return fmt::format("{:.3f}", 1e-3 * cli::Median(us));
    };
    const auto ratio = [](const std::vector<double>& a, const std::vector<double>& b) {
      return fmt::format("{:.1f}", cli::Median(a) / cli::Median(b));
    };
    table.rows.push_back({NameOf(scene), ms(bullet_world.whole), ms(bullet_world.inside),
                          ms(cairn_world.whole), ms(cairn_world.inside), ms(cairn_world.outside),
                          ratio(bullet_world.whole, cairn_world.whole),
                          ratio(bullet_world.inside, cairn_world.inside)});
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
