// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>

#include <string>

#include "contestants/contestant.h"

namespace cairn::cli {

/// btSequentialImpulseConstraintSolver, Bullet's default.
class SequentialImpulses : public ObservedContestant<btSequentialImpulseConstraintSolver> {
 public:
  void Begin(const Effort& effort, btContactSolverInfo* info) override;
  Work work() const override { return {.iterations = iterations_}; }

 private:
  int iterations_ = 0;
};

/// The same for a world that takes a frame in four parts: a quarter of the iterations in each, one
/// at least.
class QuarterImpulses : public ObservedContestant<btSequentialImpulseConstraintSolver> {
 public:
  static constexpr int kParts = 4;

  void Begin(const Effort& effort, btContactSolverInfo* info) override;
  Work work() const override { return {.iterations = kParts * iterations_}; }

 private:
  int iterations_ = 0;  ///< of a part
};

/// btNNCGConstraintSolver on all rows.
class Nncg : public ObservedContestant<btNNCGConstraintSolver> {
 public:
  Nncg() { solver_.m_onlyForNoneContact = false; }
  void Begin(const Effort& effort, btContactSolverInfo* info) override;
  Work work() const override { return {.iterations = iterations_}; }

 private:
  int iterations_ = 0;
};

/// btMLCPSolver without two of its faults: it writes past the end of an array if a joint has no
/// rows, and it takes any number of rows into its dense matrices.
class SafeMlcpSolver : public btMLCPSolver {
 public:
  /// Rows of a group at most. Measured on pyramids: 432 rows take 0.02 s a call, 768 rows 0.14 s,
  /// 1200 rows 0.6 s, 1728 rows 2.2 s. 300 frames of 1000 rows are about two minutes.
  static constexpr int kMostRows = 1000;

  using btMLCPSolver::btMLCPSolver;

  void BeginSubstep();
  const std::string& refusal() const { return refusal_; }
  /// Groups with rows, since the solver was made.
  int calls() const { return calls_; }

 protected:
  void convertJoints(btTypedConstraint** constraints, int num_constraints,
                     const btContactSolverInfo& info) override;
  void createMLCPFast(const btContactSolverInfo& info) override;
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int num_bodies,
                                             btPersistentManifold** manifolds, int num_manifolds,
                                             btTypedConstraint** constraints, int num_constraints,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* debug_drawer) override;

 private:
  std::string refusal_;
  int calls_ = 0;
  bool too_large_ = false;
};

/// btMLCPSolver with btDantzigSolver, set up as Bullet's examples do.
class Dantzig : public ObservedContestant<SafeMlcpSolver> {
 public:
  Dantzig() : ObservedContestant<SafeMlcpSolver>(&direct_) {}
  void Begin(const Effort& effort, btContactSolverInfo* info) override;
  Work work() const override { return {}; }
  std::string refusal() const override { return solver_.refusal(); }
  std::optional<double> fallback_share() const override;

 private:
  btDantzigSolver direct_;
};

/// btMLCPSolver with btSolveProjectedGaussSeidel, one matrix for each island.
class PgsMlcp : public ObservedContestant<SafeMlcpSolver> {
 public:
  PgsMlcp() : ObservedContestant<SafeMlcpSolver>(&sweeps_) {}
  void Begin(const Effort& effort, btContactSolverInfo* info) override;
  Work work() const override { return {.iterations = iterations_}; }
  std::string refusal() const override { return solver_.refusal(); }

 private:
  btSolveProjectedGaussSeidel sweeps_;
  int iterations_ = 0;
};

}  // namespace cairn::cli
