// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <span>
#include <vector>

#include "cairn/bullet/precision.h"
#include "cairn/contact_problem.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// The rows that btSequentialImpulseConstraintSolver and the solvers derived from it hold between
/// their set-up and their finish. The names are those of its protected members, less "m_tmpSolver".
struct RowPools {
  btAlignedObjectArray<btSolverBody>* bodies;
  btConstraintArray* joints;
  btConstraintArray* contacts;
  btConstraintArray* frictions;
  btConstraintArray* rolling;
};

/// Whether rows keep the sweep limits that Bullet gives them.
enum class SweepLimits { kBullet, kNone };

/// The row pools of a group as a ContactProblem, and back. The unknown velocities are the changes
/// that the group makes (the bodies of the problem start at rest), as in Bullet's own iteration:
/// everything known is in the targets of the rows.
class GroupRows {
 public:
  /// Reads rows in the order in which Bullet sweeps them, and impulses as they stand in the pools.
  void Read(const RowPools& pools, const btContactSolverInfo& info, SweepLimits limits);

  ContactProblem problem() const { return {.bodies = bodies_, .rows = rows_}; }
  std::span<double> impulses() { return impulses_; }
  std::span<const double> impulses() const { return impulses_; }
  std::span<Velocity> velocities() { return velocities_; }

  /// Whether impulses() and velocities() are finite in Bullet's numbers.
  bool FitsBullet() const;
  /// Writes impulses() and velocities() into the pools that were read.
  void Write(const RowPools& pools) const;
  /// Reads velocity changes from the pools, as a solver of Bullet's left them.
  void ReadVelocities(const RowPools& pools);

 private:
  void ReadBodies(const RowPools& pools);
  void ReadJoints(const RowPools& pools, const btContactSolverInfo& info, SweepLimits limits);
  void ReadContacts(const RowPools& pools, const btContactSolverInfo& info, SweepLimits limits);
  int ReadRow(const RowPools& pools, const Row& common, btSolverConstraint* source);

  std::vector<Body> bodies_;
  std::vector<Row> rows_;
  std::vector<double> impulses_;
  std::vector<Velocity> velocities_;
  std::vector<btSolverConstraint*> sources_;  ///< one per row
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
