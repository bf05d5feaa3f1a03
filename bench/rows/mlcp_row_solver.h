// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>

#include <vector>

#include "rows/row_solver.h"

namespace cairn::cli {

/// What Bullet's solvers of dense matrices (btMLCPSolverInterface) have in common: the whole frame
/// is one matrix, J M^-1 J' + E, in which friction names the row that bounds it.
class MlcpRowSolver : public RowSolver {
 public:
  std::string Prepare(const RowProblem& problem) override;
  RowOutcome Result() override;

 protected:
  /// @param diagonal  is added to that of the matrix [1/kg]
  explicit MlcpRowSolver(double diagonal) : diagonal_(diagonal) {}

  /// @return false if the solver gave up
  bool Solve(btMLCPSolverInterface* solver, int iterations);

  int iterations_ = 0;
  bool gave_up_ = false;

 private:
  double diagonal_;
  const RowProblem* problem_ = nullptr;
  btMatrixXu a_;
  btVectorXu b_, x_, lo_, hi_;
  btAlignedObjectArray<int> limits_;
};

/// btSolveProjectedGaussSeidel, which has no clock: it is called with 1, 2, 4 ... iterations.
class PgsMlcpRowSolver : public MlcpRowSolver {
 public:
  PgsMlcpRowSolver() : MlcpRowSolver(0) {}
  void IterateUntil(const RowLimit& limit) override;

 private:
  btSolveProjectedGaussSeidel solver_;
};

/// btDantzigSolver, which ends when it is done, whatever the limit.
class DantzigRowSolver : public MlcpRowSolver {
 public:
  DantzigRowSolver();
  void IterateUntil(const RowLimit& limit) override;
  RowOutcome Result() override;

 private:
  btDantzigSolver solver_;
};

}  // namespace cairn::cli
