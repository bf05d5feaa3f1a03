// SPDX-License-Identifier: MIT
#include "rows/bullet_row_solver.h"

#include "cairn/detail/eigen.h"
#include "measure/pool_rows.h"
#include "measure/row_velocities.h"

namespace cairn::cli {
namespace {

Eigen::Vector3d Convert(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

template <class Base>
std::string BulletRowSolver<Base>::Prepare(const RowProblem& problem) {
  const ContactProblem rows = problem.rows.problem();
  const std::span<const double> start = problem.rows.row_impulses;
  const bench::PoolProblem converted = bench::ToPools(rows, start, problem.first_contact);
  if (!converted.refusal.empty()) return converted.refusal;
  pools_.Clear();
  places_.clear();
  for (const bench::PoolBody& body : converted.bodies) pools_.AddBody(body);
  for (const bench::PoolRow& row : converted.rows) {
    places_.push_back({row.pool, pools_.AddRow(row)});
  }
  free_ = bench::FreeVelocities(rows.bodies);
  std::vector<Velocity> changes(rows.bodies.size());
  bench::Push(rows, start, changes);
  for (size_t i = 0; i < changes.size(); ++i) {
    btSolverBody& body = pools_.bodies()[static_cast<int>(i)];
    body.m_deltaLinearVelocity = btVector3(changes[i].linear);
    body.m_deltaAngularVelocity = btVector3(changes[i].angular);
  }
  pools_.Begin();
  return {};
}

template <class Base>
void BulletRowSolver<Base>::IterateUntil(const RowLimit& limit) {
  sweeps_ = 0;
  for (const RowStop stop(limit); !stop(sweeps_); ++sweeps_) pools_.Sweep();
}

template <class Base>
RowOutcome BulletRowSolver<Base>::Result() {
  RowOutcome outcome;
  for (const Place& place : places_) {
    outcome.impulses.push_back(pools_.rows(place.pool)[place.number].m_appliedImpulse);
  }
  outcome.velocities = free_;
  for (size_t i = 0; i < free_.size(); ++i) {
    const btSolverBody& body = pools_.bodies()[static_cast<int>(i)];
    View(outcome.velocities[i].linear) += Convert(body.m_deltaLinearVelocity);
    View(outcome.velocities[i].angular) += Convert(body.m_deltaAngularVelocity);
  }
  outcome.iterations = sweeps_;
  outcome.stop = "effort spent";
  return outcome;
}

template class BulletRowSolver<btSequentialImpulseConstraintSolver>;
template class BulletRowSolver<btNNCGConstraintSolver>;

}  // namespace cairn::cli
