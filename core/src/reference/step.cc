// SPDX-License-Identifier: MIT
#include "reference/step.h"

#include <algorithm>
#include <cmath>

#include "cairn/detail/memory.h"

namespace cairn {
namespace {

/// W = 1 / (E + eps d) on free rows, 0 elsewhere. eps d is the proximal term: the step minimises
/// the energy plus eps d (x - x_start)^2 / 2, because the free rows of a contact face are redundant
/// and contradict each other.
Array<double> Weights(const PackedIsland& island, const ActiveSet& set,
                      const StepSettings& settings) {
  Array<double> weights(island.rows.size(), 0.0);
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    if (set[i] != RowSide::kFree) continue;
    const double eps = HasBounds(row) ? settings.proximal : settings.proximal_joints;
    weights[i] = 1 / (row.compliance + eps * row.diagonal);
  }
  return weights;
}

/// Rows that are not free go to their bounds, sliding friction to that of the present normal.
void FixRows(const PackedIsland& island, const ActiveSet& set, IslandState* state) {
  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (set[i] == RowSide::kFree || island.rows[i].diagonal <= 0) continue;
    state->x[i] = FixedImpulse(set[i], BoundsOf(island.rows[i], state->x));
  }
}

/// H v = rhs in place.
void SolveBodies(const PackedIsland& island, const BodySystem& system, Array<Vector6>* rhs) {
  Array<Vector6d> du(island.bodies);
  for (int body = 0; body < island.bodies; ++body) {
    du[body] = Eigen::Map<const Vector6d>((*rhs)[body + 1].data());
  }
  system.Solve(du);
  (*rhs)[0].fill(0);
  for (int body = 0; body < island.bodies; ++body) {
    Eigen::Map<Vector6d>((*rhs)[body + 1].data()) = du[body];
  }
}

/// One solve for the free rows:  H du = G_F' W r,  x_F += W (r - G_F du)  with  r = -w_F.
void Refine(const PackedIsland& island, const ActiveSet& set, const Array<double>& weights,
            const BodySystem& system, IslandState* state) {
  FixRows(island, set, state);
  RecomputeVelocities(island, state);

  Array<Vector6> rhs(state->u.size(), Vector6{});
  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] == 0) continue;
    const PackedRow& row = island.rows[i];
    const double r = -RelativeVelocity(row, state->u, state->x[i]);
    AddScaled(row.g_a, weights[i] * r, &rhs[row.a]);
    AddScaled(row.g_b, weights[i] * r, &rhs[row.b]);
  }

  SolveBodies(island, system, &rhs);

  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] == 0) continue;
    const PackedRow& row = island.rows[i];
    const double r = -RelativeVelocity(row, state->u, state->x[i]);
    state->x[i] += weights[i] * (r - RelativeVelocity(row, rhs));
  }
}

/// Solves again with the same factor while the predicted set holds: each time the error of a mode
/// with eigenvalue l (relative to d) shrinks by eps / (eps + l), and redundant rows drift apart by
/// what they contradict each other. The solve after which a row leaves its bounds is taken back.
void RefineWhileSetHolds(const PackedIsland& island, const StepSettings& settings,
                         const Array<double>& weights, const BodySystem& system,
                         const ActiveSet& set, IslandState* state) {
  for (int k = 1; k < settings.refinements; ++k) {
    const Array<double> before = state->x;
    ActiveSet shrunk = set;
    Refine(island, set, weights, system, state);
    if (RemoveViolated(island, *state, &shrunk) == 0) continue;
    state->x = before;
    return;
  }
}

double JointSpeed(const PackedIsland& island, const IslandState& state) {
  double speed = 0;
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    if (!HasBounds(row)) speed = std::max(speed, row.diagonal * std::abs(state.x[i]));
  }
  return speed;
}

/// A joint that has no compliance: impulses of others are what they are.
bool IsCondensed(const PackedRow& row) { return !HasBounds(row) && row.compliance == 0; }

/// v := G_J' x_J of the joints
void JointVelocities(const PackedIsland& island, const IslandState& state, Array<Vector6>* v) {
  v->assign(state.u.size(), Vector6{});
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    if (!IsCondensed(row)) continue;
    AddScaled(row.g_a, state.x[i], &(*v)[row.a]);
    AddScaled(row.g_b, state.x[i], &(*v)[row.b]);
  }
  (*v)[0].fill(0);
}

/// One solve of  (G_J G_J' + eps D) dx_J = G_J v  for the smallest dx_J that moves bodies by v.
void AddSmallest(const PackedIsland& island, const Array<double>& weights, const BodySystem& system,
                 const Array<Vector6>& v, IslandState* state) {
  Array<Vector6> rhs(v.size(), Vector6{});
  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] == 0) continue;
    const PackedRow& row = island.rows[i];
    const double r = weights[i] * RelativeVelocity(row, v);
    AddScaled(row.g_a, r, &rhs[row.a]);
    AddScaled(row.g_b, r, &rhs[row.b]);
  }
  SolveBodies(island, system, &rhs);
  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] == 0) continue;
    const PackedRow& row = island.rows[i];
    state->x[i] += weights[i] * (RelativeVelocity(row, v) - RelativeVelocity(row, rhs));
  }
}

/// Nothing changes if the system of the joints alone cannot be factorised, or if they turn out not
/// to be redundant.
void CondenseJoints(const PackedIsland& island, const StepSettings& settings, BodySystem* system,
                    IslandState* state) {
  Array<double> weights(island.rows.size(), 0.0);
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    if (!IsCondensed(row) || row.diagonal <= 0) continue;
    weights[i] = 1 / (settings.proximal_joints * row.diagonal);
  }
  if (!system->Factorise(island, weights)) return;
  const Array<double> before = state->x;
  const double speed = JointSpeed(island, *state);
  Array<Vector6> wanted, now;
  JointVelocities(island, *state, &wanted);
  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] != 0) state->x[i] = 0;
  }
  for (int k = 0; k < kCondensingSolves; ++k) {
    JointVelocities(island, *state, &now);
    for (size_t body = 0; body < now.size(); ++body) {
      for (int axis = 0; axis < 6; ++axis) now[body][axis] = wanted[body][axis] - now[body][axis];
    }
    AddSmallest(island, weights, *system, now, state);
  }
  if (!(JointSpeed(island, *state) <= kCondensed * speed)) state->x = before;
}

}  // namespace

StepResult TakeStep(const PackedIsland& island, const StepSettings& settings, BodySystem* system,
                    IslandState* state) {
  StepResult result;
  const IslandState start = *state;
  ActiveSet set = PredictActiveSet(island, *state);
  for (int pass = 0; pass < settings.factorisations; ++pass) {
    const Array<double> weights = Weights(island, set, settings);
    ++result.factorisations;
    if (!system->Factorise(island, weights)) {
      *state = start;
      return result;
    }
    state->x = start.x;
    Refine(island, set, weights, *system, state);
    if (RemoveViolated(island, *state, &set) > 0) continue;
    RefineWhileSetHolds(island, settings, weights, *system, set, state);
    break;
  }

  result.solved_joint_speed = JointSpeed(island, *state);
  if (settings.condense_joints) {
    CondenseJoints(island, settings, system, state);
    ++result.factorisations;
  }
  // back inside the bounds: parents come before their friction rows
  for (size_t i = 0; i < island.rows.size(); ++i) {
    state->x[i] = Clamp(state->x[i], BoundsOf(island.rows[i], state->x));
  }
  RecomputeVelocities(island, state);
  result.joint_speed = JointSpeed(island, *state);
  result.solved = true;
  return result;
}

}  // namespace cairn
