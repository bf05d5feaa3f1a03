// SPDX-License-Identifier: MIT
#include "frames/step.h"

#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <chrono>

#include "frames/frame_solver.h"
#include "frames/markdown.h"
#include "frames/size_series.h"
#include "measure/instrumented_solver.h"
#include "support/statistics.h"

namespace cairn::frames {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kIterations = 10;

double Microseconds(std::chrono::nanoseconds time) {
  return 1e-3 * static_cast<double>(time.count());
}

/// A scene in a world of its own.
class TimedWorld {
 public:
  TimedWorld(const SceneChoice& choice, btConstraintSolver* solver)
      : timed_(solver), world_(&timed_), scene_(bench::Make(*bench::FindScene(choice.name))) {
    scene_->Build(&world_, {.size = choice.size});
    world_.solver_info().m_numIterations = kIterations;
  }

  void Step(int frame, bool keep) {
    scene_->BeforeStep(&world_, frame);
    timed_.TakeTime();
    const Clock::time_point start = Clock::now();
    world_.Step();
    const double step = Microseconds(Clock::now() - start);
    if (!keep) return;
    const double solver = Microseconds(timed_.TakeTime());
    whole.push_back(step);
    inside.push_back(solver);
    outside.push_back(step - solver);
  }

  std::vector<double> whole, inside, outside;  ///< [us]

 private:
  bench::InstrumentedSolver timed_;
  bench::World world_;
  std::unique_ptr<bench::Scene> scene_;
};

}  // namespace

void PrintSteps(const StepOptions& options, const std::string& command) {
  PrintOrigin("Whole steps of a world: ten iterations, no subspace step, one thread", command);
  fmt::print("- two worlds in turn, {} frames; medians, wall clock, milliseconds\n\n",
             options.frames);
  MarkdownTable table({"scene", "step, Bullet", "of it solver", "step, Cairn", "of it solver",
                       "outside the solver", "ratio of steps", "ratio of solvers"});
  for (const SceneChoice& scene : options.scenes) {
    btSequentialImpulseConstraintSolver stock;
    bullet::ConstraintSolver cairn(Sweeps(kIterations, 1));
    TimedWorld bullet_world(scene, &stock), cairn_world(scene, &cairn);
    const int first = scene.FirstFrame(options.frame);
    for (int frame = 0; frame < first + options.frames; ++frame) {
      bullet_world.Step(frame, frame >= first);
      cairn_world.Step(frame, frame >= first);
    }
    const auto ms = [](const std::vector<double>& us) {
      return fmt::format("{:.3f}", 1e-3 * cli::Median(us));
    };
    const auto ratio = [](const std::vector<double>& a, const std::vector<double>& b) {
      return fmt::format("{:.1f}", cli::Median(a) / cli::Median(b));
    };
    table.Add({NameOf(scene), ms(bullet_world.whole), ms(bullet_world.inside),
               ms(cairn_world.whole), ms(cairn_world.inside), ms(cairn_world.outside),
               ratio(bullet_world.whole, cairn_world.whole),
               ratio(bullet_world.inside, cairn_world.inside)});
  }
  table.Print();
}

}  // namespace cairn::frames
