// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/settings.h"

namespace cairn {

/// Whether the sweeps of an island of contacts that has not converged end with one over friction
/// alone, where no budget is set. Bullet ends each of its iterations so: of what is left along
/// normals the next step sees depth, and takes it back; slip is never taken back, and arches and
/// towers creep by it. Islands with joints would gape by what friction leaves these. Plain methods
/// are what their names say.
inline bool SettlesFriction(const Settings& settings) {
  return settings.method == Method::kPgsSm &&
         settings.tuning.lifted_friction == detail::LiftedFriction::kRelease;
}

}  // namespace cairn
