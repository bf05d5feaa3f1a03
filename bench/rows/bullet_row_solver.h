// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "measure/bullet_pools.h"
#include "rows/row_solver.h"

namespace cairn::cli {

/// One of Bullet's own solvers, btSequentialImpulseConstraintSolver or btNNCGConstraintSolver,
/// sweeping over the rows of a frame that are put into its memory.
template <class Base>
class BulletRowSolver : public RowSolver {
 public:
  std::string Prepare(const RowProblem& problem) override;
  void IterateUntil(const RowLimit& limit) override;
  RowOutcome Result() override;

 private:
  bench::BulletPools<Base> pools_;
  std::vector<Velocity> free_;  ///< Velocities without any row.
  /// Where each row of the problem is.
  struct Place {
    bench::PoolRow::Pool pool;
    int number;
  };
  std::vector<Place> places_;
  int sweeps_ = 0;
};

extern template class BulletRowSolver<btSequentialImpulseConstraintSolver>;
extern template class BulletRowSolver<btNNCGConstraintSolver>;

}  // namespace cairn::cli
