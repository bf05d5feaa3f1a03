// SPDX-License-Identifier: MIT
// The range of every setting.
#include "cairn/settings.h"

#include "problem/setting_judge.h"

namespace cairn {

BadSetting FindBadSetting(const Settings& settings) {
  // names every field: a new one does not compile until its range is checked here
  const auto& [method, path, k_gs, k_sm, steps, max_sweeps, substeps, relax, geometric_stiffness,
               tolerance, budget, threads, executor, acceleration, step_policy, proximal_joints,
               tuning] = settings;
  const auto& [min_progress, min_sweeps, omega, proximal, refinements, quiet_speed, units_per_metre,
               lifted_friction, replay, spans, clock] = tuning;
  static_cast<void>(steps);  // any will do, and any of these
  static_cast<void>(geometric_stiffness);
  static_cast<void>(executor);
  static_cast<void>(spans);
  static_cast<void>(clock);
  SettingJudge judge;
  judge.Enumerator("method", method, Method::kPgsSm, "one of Method");
  judge.Enumerator("path", path, Path::kReference, "one of Path");
  judge.AtLeast("k_gs", k_gs, 1);
  judge.Inside("k_sm", k_sm, 0, 1000, "0 to 1000");
  judge.AtLeast("max_sweeps", max_sweeps, 0);
  // a replay is of one meter, and parts have one each
  judge.Inside("substeps", substeps, 1, replay == nullptr ? 64 : 1,
               replay == nullptr ? "1 to 64" : "1 in a replay");
  judge.Holds(!relax || replay == nullptr, {"relax", 1, "0 in a replay"});
  judge.AtLeast("tolerance", tolerance, 0);
  judge.AtLeast("tuning.min_progress", min_progress, 0);
  judge.Limit("budget", budget);
  if (replay != nullptr) {
    const auto work = static_cast<double>(replay->work);
    judge.AtLeast("tuning.replay->work", work, 0);
  }
  judge.AtLeast("tuning.min_sweeps", min_sweeps, Tuning::kByBudget);
  judge.Inside("threads", threads, 1, 1024, "1 to 1024");
  judge.Holds(omega > 0 && omega < 2, {"tuning.omega", omega, "above 0 and below 2"});
  judge.AtLeast("tuning.quiet_speed", quiet_speed, 0);
  if (units_per_metre != 0) {
    judge.Inside("tuning.units_per_metre", units_per_metre, 1e-6, 1e6, "0, or 1e-6 to 1e6");
  }
  judge.Enumerator("tuning.lifted_friction", lifted_friction, detail::LiftedFriction::kHold,
                   "one of LiftedFriction");
  judge.Enumerator("acceleration", acceleration, Acceleration::kNncg, "one of Acceleration");
  judge.Enumerator("step_policy", step_policy, StepPolicy::kWeighed, "one of StepPolicy");
  judge.Inside("tuning.proximal", proximal, 1e-8, 1, "1e-8 to 1");
  judge.Inside("proximal_joints", proximal_joints, 1e-12, 1, "1e-12 to 1");
  judge.Inside("tuning.refinements", refinements, 1, 1000, "1 to 1000");
  return judge.bad();
}

}  // namespace cairn
