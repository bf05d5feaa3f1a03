// SPDX-License-Identifier: MIT
#include "rigid/castle.h"

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "measure/observed.h"
#include "rigid/contact_matrix.h"
#include "rigid/nearest_rows.h"
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

std::span<const CastleSize> CastleSizes() {
  static constexpr CastleSize kSizes[] = {
      {7, 18, 58},        {8, 45, 2.9e3},      {8, 48, 2.4e3},     {235, 1044, 4.6e4},
      {449, 1821, 4.2e4}, {907, 5832, 5.1e7},  {948, 7344, 6.1e7}, {966, 8220, 7.2e7},
      {976, 8745, 8.6e7}, {977, 9534, 1.03e8},
  };
  return kSizes;
}

SizedCastle MakeSizedCastle(const ContactFrame& frame, const CastleSize& size, ContactModel model) {
  const ContactFrame rows =
      NearestRows(frame, {.contacts = size.inequalities, .frictions = size.equations});
  const ContactFrame bilateral = WithCompliance(ApplyModel(rows, ContactModel::kBilateral), 0);
  SizedCastle castle;
  castle.compliance = FindCompliance(ToBoxed(bilateral.problem()).M, size.condition);
  castle.frame = WithCompliance(ApplyModel(rows, model), castle.compliance.share);
  return castle;
}

}  // namespace cairn::bench
