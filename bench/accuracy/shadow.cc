// SPDX-License-Identifier: MIT
#include "accuracy/shadow.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "support/duration.h"

namespace cairn::accuracy {
const char* NameOf(Kind kind) {
  switch (kind) {
    case Kind::kSweeps:
      return "sweeps";
    case Kind::kAccelerated:
      return "accelerated";
    case Kind::kSteps:
      break;
  }
  return "steps";
}

Settings SettingsOf(Kind kind) {
  Settings settings;
  settings.max_sweeps = std::numeric_limits<int>::max();
  settings.tolerance = 0;
  if (kind == Kind::kSweeps) settings.method = Method::kPgs;
  if (kind != Kind::kSteps) settings.k_sm = 0;
  return settings;
}

ShadowFrame Shadow::Solve(const bench::Substep& substep, const btContactSolverInfo& info,
                          double budget) {
  solver_.settings().budget =
      Budget::Time(std::chrono::nanoseconds(std::llround(std::max(0.0, budget) * 1e6)));
  substep.Restore();
  joints_.Put(substep);
  const cli::ThreadStopwatch stopwatch;
  substep.SolveWith(&solver_, info, nullptr);
  const cli::ThreadTime time = stopwatch.Read();
  joints_.Keep(substep);
  ShadowFrame frame = Describe();
  frame.budget = budget;
  frame.time = time;
  return frame;
}

ShadowFrame Shadow::Describe() const {
  const Report& report = solver_.report();
  if (!report.ok()) throw std::runtime_error(std::string(cairn::Describe(report.status)));
  if (solver_.fell_back()) throw std::runtime_error("a substep was left to Bullet");
  const bullet::SubstepTimes times = solver_.times();
  const ContactProblem problem = solver_.problem();
  return {.budget = 0,
          .time = {},
          .build = cli::Milliseconds(times.build),
          .solve = cli::Milliseconds(times.solve),
          .write = cli::Milliseconds(times.write),
          .step_predicted = cli::Milliseconds(report.step_predicted),
          .step_time = cli::Milliseconds(report.step_time),
          .residual_max = report.residual_max,
          .sweeps = report.sweeps,
          .factorisations = report.factorisations,
          .accepted = report.steps_accepted,
          .restored = report.steps_restored,
          .empty = AllRows(problem) == 0};
}

}  // namespace cairn::accuracy
