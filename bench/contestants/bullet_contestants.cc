// SPDX-License-Identifier: MIT
#include "contestants/bullet_contestants.h"

#include <fmt/format.h>

#include <algorithm>

namespace cairn::cli {

void SequentialImpulses::Begin(const Effort& effort, btContactSolverInfo* info) {
  info->m_numIterations = iterations_ = effort.iterations;
}

void QuarterImpulses::Begin(const Effort& effort, btContactSolverInfo* info) {
  info->m_numIterations = iterations_ = std::max(1, effort.iterations / kParts);
}

void Nncg::Begin(const Effort& effort, btContactSolverInfo* info) {
  info->m_numIterations = iterations_ = effort.iterations;
}

void SafeMlcpSolver::BeginSubstep() { refusal_.clear(); }

void SafeMlcpSolver::convertJoints(btTypedConstraint** constraints, int num_constraints,
                                   const btContactSolverInfo& info) {
  btMLCPSolver::convertJoints(constraints, num_constraints, info);
  // createMLCPFast() takes the n-th entry for the n-th joint that has rows.
  int kept = 0;
  for (int i = 0; i < m_tmpConstraintSizesPool.size(); ++i) {
    if (m_tmpConstraintSizesPool[i].m_numConstraintRows > 0) {
      m_tmpConstraintSizesPool[kept++] = m_tmpConstraintSizesPool[i];
    }
  }
  m_tmpConstraintSizesPool.resize(kept);
}

void SafeMlcpSolver::createMLCPFast(const btContactSolverInfo& info) {
  const int rows = m_allConstraintPtrArray.size();
  too_large_ = rows > kMostRows;
  if (!too_large_) {
    btMLCPSolver::createMLCPFast(info);
    return;
  }
  const double gigabytes = static_cast<double>(rows) * rows * sizeof(btScalar) / 1e9;
  refusal_ =
      fmt::format("refused: {} rows in one island (a matrix of {:.2g} GB), above {} is too slow",
                  rows, gigabytes, kMostRows);
}

btScalar SafeMlcpSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds, int num_manifolds,
    btTypedConstraint** constraints, int num_constraints, const btContactSolverInfo& info,
    btIDebugDraw* debug_drawer) {
  if (m_allConstraintPtrArray.size() > 0) ++calls_;
  if (!std::exchange(too_large_, false)) {
    return btMLCPSolver::solveGroupCacheFriendlyIterations(bodies, num_bodies, manifolds,
                                                           num_manifolds, constraints,
                                                           num_constraints, info, debug_drawer);
  }
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
      bodies, num_bodies, manifolds, num_manifolds, constraints, num_constraints, info,
      debug_drawer);
}

void Dantzig::Begin(const Effort& effort, btContactSolverInfo* info) {
  solver_.BeginSubstep();
  info->m_numIterations = effort.iterations;  // for its fallback
  // One island, one matrix; and without cfm the matrix of any resting box is singular.
  info->m_minimumSolverBatchSize = 1;
  info->m_globalCfm = btScalar(1e-5);
}

void PgsMlcp::Begin(const Effort& effort, btContactSolverInfo* info) {
  solver_.BeginSubstep();
  info->m_numIterations = iterations_ = effort.iterations;
  info->m_minimumSolverBatchSize = 1;  // one island, one matrix
}

std::optional<double> Dantzig::fallback_share() const {
  if (solver_.calls() == 0) return {};
  return static_cast<double>(solver_.getNumFallbacks()) / solver_.calls();
}

}  // namespace cairn::cli
