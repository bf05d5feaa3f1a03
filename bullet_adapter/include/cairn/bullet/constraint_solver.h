// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "cairn/bullet/options.h"
#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"
#include "cairn/detail/recorder.h"
#include "cairn/report.h"
#include "cairn/settings.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

struct Group;

/// Where the time of a substep went, wall clock, in Mode::kFast.
struct SubstepTimes {
  std::chrono::nanoseconds build{0};  ///< From Bullet's joints and contacts to the problem.
  std::chrono::nanoseconds solve{0};  ///< In cairn::Solver.
  std::chrono::nanoseconds write{0};  ///< Back into Bullet's objects.
};

/// Drop-in for btSequentialImpulseConstraintSolver: pass it to a btDiscreteDynamicsWorld, which
/// does not own it. All islands of a substep are solved as one problem, with one budget.
/// Without a budget (the default) btContactSolverInfo::m_numIterations says how hard to try. Each
/// island makes that many accelerated sweeps, and a subspace step among them where it does more
/// than sweeps in its place would and costs little enough (StepPolicy::kWeighed, in place of the
/// default kMeasured; docs/bullet.md has the limits). Islands without a step go on for up to twice
/// as many sweeps, as long as all of it is predicted to stay below 0.85 of what Bullet's iterations
/// take. All of that is counted, never timed. A Budget::Time is for the whole substep, set-up and
/// write-back included. Options::effort says whose numbers are read.
///
/// What cannot be solved (a setting out of its range, say) is left to Bullet's iteration: report()
/// says so, and complaint() and the debug drawer in words. Bodies and joints with a NaN are left
/// out.
///
/// SOLVER_RANDMIZE_ORDER is ignored. In Mode::kFast btManifoldPoint::m_prevRHS of contacts is used,
/// to know the directions of lateral impulses from one substep to the next, and joints start from
/// the substep before only if its groups came between prepareSolve() and allSolved(), or were one.
/// Not thread safe, like its base: one solver per world.
class ConstraintSolver : public btSequentialImpulseConstraintSolver {
 public:
  explicit ConstraintSolver(const Settings& settings = {}, const Options& options = {});
  ~ConstraintSolver() override;

  Settings& settings();
  Options& options();  ///< May be changed between substeps.
  /// Of the last substep; of the last group if nobody calls allSolved(): btConstraintSolverPoolMt.
  const Report& report() const;
  SubstepTimes times() const;
  /// Left to Mode::kReference, or from there to Bullet's iteration: a setting out of its range, a
  /// Solve() refused; or, of which report() says nothing, islands with joints not of Bullet's, and
  /// what is left out.
  bool fell_back() const;
  /// What is wrong, or was not recorded: "threads is 0, must be 1 to 1024". Empty if nothing.
  std::string complaint() const;
  /// The problem that report() is about, and the impulses that solve it, one per row: joints first,
  /// in the order in which Bullet hands them over, then contacts, those in manifolds last. Valid
  /// until the next substep, impulses until they are asked for again; empty before the first.
  ContactProblem problem() const;
  std::span<const double> impulses() const;
  int place_of(const btRigidBody& body) const;  ///< In problem().bodies; -1: not, or no kFast.

  /// Writes the problem of the next substep to a file. CAIRN_RECORD in the environment, looked at
  /// when a solver is made, writes those of all substeps; see docs/recording.md.
  /// @param frame  its number, which the file carries; -1 if there is none
  void RecordNext(std::string path, std::int64_t frame = -1);
  const RecordedFiles& recorded() const;  ///< What was written, and what could not be.

  void prepareSolve(int bodies, int manifolds) override;
  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** constraints, int num_constraints,
                      const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                      btDispatcher* dispatcher) override;
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override;
  void reset() override;  ///< Forgets everything learnt in earlier substeps.

 protected:
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int num_bodies,
                                             btPersistentManifold** manifolds, int num_manifolds,
                                             btTypedConstraint** constraints, int num_constraints,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* debug_drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int num_bodies,
                                         const btContactSolverInfo& info) override;

 private:
  struct Impl;

  void Analyse(const Group& group, int first_companion);
  void Warn(btIDebugDraw* debug_drawer);

  // no member may need more than 16 bytes of alignment: the operator new of the base gives no more
  std::unique_ptr<Impl> impl_;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
