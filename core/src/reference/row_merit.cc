// SPDX-License-Identifier: MIT
#include "reference/row_merit.h"

#include <algorithm>
#include <cmath>

namespace cairn {

Merit MeasureMerit(const PackedIsland& island, const IslandState& state) {
  Merit merit;
  for (const Vector6& u : state.u) {
    for (const double part : u) merit.square += part * part;
  }
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    const double x = state.x[i];
    merit.gain += row.target * x;
    merit.square += row.compliance * x * x;
    merit.may_be_none = merit.may_be_none && row.lo <= 0 && row.hi >= 0;
  }
  return merit;
}

IslandMotion MeasureMotion(const PackedIsland& island, const IslandState& state, double share) {
  IslandMotion motion;
  for (size_t i = 0; i < island.motions.size(); ++i) {
    const auto u = Eigen::Map<const Eigen::Vector3d>(state.u[i + 1].data());
    const auto& [free, whitening, mass] = island.motions[i];
    const double square = (free + whitening.cwiseProduct(share * u)).squaredNorm();
    motion.speed = std::max(motion.speed, std::sqrt(square));
    motion.energy += 0.5 * mass * square;
  }
  return motion;
}

void ScaleState(double factor, IslandState* state) {
  for (double& x : state->x) x = factor == 0 ? 0 : factor * x;
  for (Vector6& u : state->u) {
    for (double& part : u) part = factor == 0 ? 0 : factor * part;
  }
}

}  // namespace cairn
