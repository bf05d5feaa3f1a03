// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "measure/bullet_pools.h"
#include "micro/row_scene.h"

namespace cairn::micro {

/// Rows in the memory of Bullet's own solver, swept over by its own compiled code.
class BulletRows : private bench::BulletPools<btSequentialImpulseConstraintSolver> {
 public:
  explicit BulletRows(const RowScene& scene);

  /// All at rest again.
  void Reset();
  /// Bullet's iteration: joints, all contacts, all friction.
  void Sweep() { BulletPools::Sweep(); }
  /// Bullet's row solver in the order of our kernels: pair by pair, contacts before friction.
  void SweepPairByPair();

  int rows() const;
  /// Rows, their order, and of the bodies what a row reads: once for the contacts of a manifold and
  /// once for its friction, or once for a joint.
  std::size_t bytes_per_sweep() const;
  /// What a sweep touches in all.
  std::size_t working_set() const;

  /// In the order of RowScene::rows.
  std::vector<float> Impulses() const;
  /// No number is infinite, none or too small for a normal float.
  bool IsSound() const;

 private:
  /// Where the rows of a pair start.
  struct PairRows {
    int contacts, frictions, joints;
  };

  void AddSceneRow(const RowScene& scene, const RowScene::Pair& pair, int index);
  void SolveFriction(btSolverConstraint* row);
  PairRows NextRows() const;

  std::vector<PairRows> pairs_;  ///< And one more: where the rows end.
};

}  // namespace cairn::micro
