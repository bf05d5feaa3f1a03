// SPDX-License-Identifier: MIT
// The range of every setting.
#include "cairn/lcp/settings.h"

#include "problem/setting_judge.h"

namespace cairn::lcp {

BadSetting FindBadSetting(const Settings& settings) {
  // names every field: a new one does not compile until its range is checked here
  const auto& [method, order, k_gs, k_sm, max_sweeps, tolerance, min_progress, budget, min_sweeps,
               threads, executor, omega, always_solve, active_tolerance] = settings;
  static_cast<void>(executor);  // any will do, and either of these
  static_cast<void>(always_solve);
  SettingJudge judge;
  judge.Enumerator("method", method, Method::kInteriorPoint, "one of lcp::Method");
  judge.Enumerator("order", order, SweepOrder::kColoured, "one of lcp::SweepOrder");
  judge.AtLeast("k_gs", k_gs, 1);
  judge.Inside("k_sm", k_sm, 0, 1000, "0 to 1000");
  judge.AtLeast("max_sweeps", max_sweeps, 0);
  judge.AtLeast("tolerance", tolerance, 0);
  judge.AtLeast("min_progress", min_progress, 0);
  judge.Limit("budget", budget);
  judge.AtLeast("min_sweeps", min_sweeps, 0);
  judge.Inside("threads", threads, 1, 1024, "1 to 1024");
  judge.Holds(omega > 0 && omega < 2, {"omega", omega, "above 0 and below 2"});
  judge.AtLeast("active_tolerance", active_tolerance, 0);
  return judge.bad();
}

}  // namespace cairn::lcp
