// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contestants/solver_registry.h"
#include "rows/cairn_row_solver.h"
#include "rows/frame_layout.h"
#include "rows/row_solver.h"
#include "scenes/world.h"

namespace cairn::cli {

/// A recorded frame as a Bullet world, to be solved and looked at: boxes, points of contact and
/// joints as in FrameLayout. It is never stepped. How deep contacts are and how far joints gape is
/// not recorded, and 0.
class FrameWorld {
 public:
  /// @param host  of the world, which has to have one; it outlives the world
  FrameWorld(std::shared_ptr<const RowProblem> problem, btConstraintSolver* host);
  ~FrameWorld();
  FrameWorld(const FrameWorld&) = delete;
  FrameWorld& operator=(const FrameWorld&) = delete;

  /// Solves the frame from its start; bodies and contacts get velocities and impulses.
  /// @param entry     of the solvers of a run, the one that `cairn solve` knows by that name
  /// @param settings  of Cairn's solvers
  /// @return why this one does not solve it; empty if it does
  std::string Solve(const SolverEntry& entry, const Settings& settings, const RowLimit& limit);
  // Of the last Solve().
  const RowOutcome& outcome() const { return outcome_; }
  std::chrono::nanoseconds time() const { return time_; }
  double Residual() const;  ///< [m/s]
  /// nullptr of Bullet's solvers.
  CairnRowSolver* cairn() { return cairn_; }
  /// Of a body of the world; none of Bullet's solvers, and without rows.
  std::optional<IslandReport> ReportOf(const btRigidBody& body) const;

  bench::World& world() { return world_; }
  const RowProblem& problem() const { return *problem_; }

 private:
  /// @return false if it solves no frames
  bool Use(const SolverEntry& entry);
  void Show();
  void AddContacts();
  void AddJoints(const FrameLayout& layout);
  /// What is left of kWorld: the ground.
  btRigidBody* BodyOf(int number) const { return number == kWorld ? ground_ : bodies_[number]; }

  std::shared_ptr<const RowProblem> problem_;
  bench::World world_;
  btRigidBody* ground_;
  std::vector<btRigidBody*> bodies_;
  std::vector<btPersistentManifold*> manifolds_;

  const SolverEntry* used_ = nullptr;
  std::unique_ptr<RowSolver> solver_;
  CairnRowSolver* cairn_ = nullptr;  ///< The same, if it is Cairn's.
  RowOutcome outcome_;
  std::chrono::nanoseconds time_{0};
};

}  // namespace cairn::cli
