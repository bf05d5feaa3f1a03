// SPDX-License-Identifier: MIT
#include "rigid/castle_frame.h"

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "measure/observed.h"
#include "scenes/scene.h"
#include "scenes/world.h"

namespace cairn::bench {
namespace {

int Shifted(int index, int by) { return index < 0 ? index : index + by; }

/// Islands share no body that moves, so their problems are one problem side by side.
void Append(bullet::GroupRows* group, ContactFrame* frame) {
  const int bodies = static_cast<int>(frame->bodies.size());
  const int rows = static_cast<int>(frame->rows.size());
  const ContactProblem problem = group->problem();
  frame->bodies.insert(frame->bodies.end(), problem.bodies.begin(), problem.bodies.end());
  for (Row row : problem.rows) {
    row.body_a = Shifted(row.body_a, bodies);
    row.body_b = Shifted(row.body_b, bodies);
    row.parent = Shifted(row.parent, rows);
    frame->rows.push_back(row);
  }
  const auto impulses = group->impulses();
  frame->impulses.insert(frame->impulses.end(), impulses.begin(), impulses.end());
}

}  // namespace

ContactFrame CastleFrame(int frame) {
  Observed<btSequentialImpulseConstraintSolver> solver;
  World world(&solver);
  const std::unique_ptr<Scene> scene = Make(*FindScene("castle"));
  scene->Build(&world, {});
  const auto step = [&](int i) {
    scene->BeforeStep(&world, i);
    world.Step();
  };
  for (int i = 0; i < frame; ++i) step(i);

  ContactFrame captured;
  solver.Observe([&](bullet::GroupRows& rows) { Append(&rows, &captured); });
  step(frame);
  return captured;
}

}  // namespace cairn::bench
