// SPDX-License-Identifier: MIT
#include "run/state_run.h"

#include <limits>
#include <utility>

namespace cairn::cli {

StateRun::StateRun(const SceneChoice& choice, int iterations) : scene_(bench::Make(*choice.info)) {
  scene_->Build(&world_, {.size = choice.size, .seed = choice.seed});
  world_.solver_info().m_numIterations = iterations;
  // islands would be solved in several groups, where the adapter makes one problem of all
  world_.solver_info().m_minimumSolverBatchSize = std::numeric_limits<int>::max();
}

void StateRun::Step() {
  scene_->BeforeStep(&world_, frame_++);
  world_.Step();
}

bench::ContactFrame StateRun::Record() {
  bench::ContactFrame frame;
  solver_.RecordTo(&frame);
  Step();
  solver_.RecordTo(nullptr);
  return frame;
}

void StateRun::StepAfter(bench::InstrumentedSolver::Probe probe) {
  instrumented_.ProbeNext(std::move(probe));
  Step();
}

}  // namespace cairn::cli
