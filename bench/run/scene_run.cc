// SPDX-License-Identifier: MIT
#include "run/scene_run.h"

#include <limits>
#include <stdexcept>
#include <utility>

namespace cairn::cli {

BuiltScene::BuiltScene(const SceneChoice& choice, btConstraintSolver* solver)
    : world_(solver), choice_(choice), scene_(choice.make()) {
  scene_->Build(&world_, choice.options());
}

void BuiltScene::Step(int parts) {
  scene_->BeforeStep(&world_, frame_++);
  world_.Step(parts);
}

SceneRun::SceneRun(const SceneChoice& choice, btConstraintSolver* driver)
    : instrumented_(driver), scene_(choice, &instrumented_) {}

void SceneRun::Skip(int frames) {
  for (int i = 0; i < frames; ++i) Step();
}

void SceneRun::StepAfter(bench::InstrumentedSolver::Probe probe) {
  instrumented_.ProbeNext(std::move(probe));
  Step();
}

StateRun::StateRun(const SceneChoice& choice, int iterations) : run_(choice, &solver_) {
  btContactSolverInfo& info = run_.world().solver_info();
  info.m_numIterations = iterations;
  // islands would be solved in several groups, where the adapter makes one problem of all
  info.m_minimumSolverBatchSize = std::numeric_limits<int>::max();
}

bench::ContactFrame StateRun::Record() {
  bench::ContactFrame frame;
  solver_.RecordTo(&frame);
  run_.Step();
  solver_.RecordTo(nullptr);
  if (frame.rows.empty()) throw std::runtime_error("nothing touches in this frame");
  return frame;
}

}  // namespace cairn::cli
