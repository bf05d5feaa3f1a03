// SPDX-License-Identifier: MIT
#include "subspace/step.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cairn {
namespace {

bool HasBounds(const PackedRow& row) {
  return row.parent != kNoRow || row.lo != -kInfinity || row.hi != kInfinity;
}

/// W = 1 / (E + eps d) on free rows, 0 elsewhere. eps d is the proximal term: the step minimises
/// the energy plus eps d (x - x_start)^2 / 2, because the free rows of a contact face are redundant
/// and contradict each other.
std::vector<double> Weights(const PackedIsland& island, const ActiveSet& set,
                            const StepSettings& settings) {
  std::vector<double> weights(island.rows.size(), 0.0);
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

/// One solve for the free rows:  H du = G_F' W r,  x_F += W (r - G_F du)  with  r = -w_F.
void Refine(const PackedIsland& island, const ActiveSet& set, const std::vector<double>& weights,
            const BodySystem& system, IslandState* state) {
  FixRows(island, set, state);
  RecomputeVelocities(island, state);

  std::vector<Vector6> rhs(state->u.size(), Vector6{});
  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] == 0) continue;
    const PackedRow& row = island.rows[i];
    const double r = -Slack(row, state->u, state->x[i]);
    AddScaled(row.g_a, weights[i] * r, &rhs[row.a]);
    AddScaled(row.g_b, weights[i] * r, &rhs[row.b]);
  }

  std::vector<Vector6d> du(island.bodies);
  for (int body = 0; body < island.bodies; ++body) {
    du[body] = Eigen::Map<const Vector6d>(rhs[body + 1].data());
  }
  system.Solve(du);
  rhs[0].fill(0);
  for (int body = 0; body < island.bodies; ++body) {
    Eigen::Map<Vector6d>(rhs[body + 1].data()) = du[body];
  }

  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] == 0) continue;
    const PackedRow& row = island.rows[i];
    const double r = -Slack(row, state->u, state->x[i]);
    state->x[i] += weights[i] * (r - RelativeVelocity(row, rhs));
  }
}

/// Solves again with the same factor while the predicted set holds: each time the error of a mode
/// with eigenvalue l (relative to d) shrinks by eps / (eps + l), and redundant rows drift apart by
/// what they contradict each other. The solve after which a row leaves its bounds is taken back.
void RefineWhileSetHolds(const PackedIsland& island, const StepSettings& settings,
                         const std::vector<double>& weights, const BodySystem& system,
                         ActiveSet* set, IslandState* state) {
  for (int k = 1; k < settings.refinements; ++k) {
    const std::vector<double> before = state->x;
    ActiveSet shrunk = *set;
    Refine(island, *set, weights, system, state);
    if (RemoveViolated(island, *state, &shrunk) == 0) continue;
    state->x = before;
    return;
  }
}

void LeakJoints(const PackedIsland& island, const StepSettings& settings, IslandState* state) {
  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (!HasBounds(island.rows[i])) state->x[i] *= 1 - settings.leak_joints;
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

}  // namespace

StepResult TakeStep(const PackedIsland& island, const StepSettings& settings, BodySystem* system,
                    IslandState* state) {
  StepResult result;
  const IslandState before = *state;
  ActiveSet set = PredictActiveSet(island, *state);
  LeakJoints(island, settings, state);
  const IslandState start = *state;
  for (int pass = 0; pass < settings.factorisations; ++pass) {
    const std::vector<double> weights = Weights(island, set, settings);
    ++result.factorisations;
    if (!system->Factorise(island, weights)) {
      *state = before;
      return result;
    }
    state->x = start.x;
    Refine(island, set, weights, *system, state);
    if (RemoveViolated(island, *state, &set) > 0) continue;
    RefineWhileSetHolds(island, settings, weights, *system, &set, state);
    break;
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
