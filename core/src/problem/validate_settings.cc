// SPDX-License-Identifier: MIT
// The range of every setting.
#include <limits>

#include "cairn/settings.h"

namespace cairn {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Keeps the first setting that is out of its range.
class SettingJudge {
 public:
  /// @p range says "lo to hi" for people
  void Inside(const char* name, double value, double lo, double hi, const char* range) {
    // a comparison with what is not a number is false
    Holds(value >= lo && value <= hi, {name, value, range});
  }
  template <class Enum>
  void Enumerator(const char* name, Enum value, Enum last, const char* range) {
    Inside(name, static_cast<double>(value), 0, static_cast<double>(last), range);
  }
  void Holds(bool holds, const BadSetting& otherwise) {
    if (!holds && bad_.name == nullptr) bad_ = otherwise;
  }
  const BadSetting& bad() const { return bad_; }

 private:
  BadSetting bad_;
};

double AmountOf(const Budget& budget) {
  const bool is_time = budget.kind() == Budget::Kind::kTime;
  return static_cast<double>(is_time ? budget.time().count() : budget.work());
}

}  // namespace

BadSetting FindBadSetting(const Settings& settings) {
  // names every field: a new one does not compile until its range is checked here
  const auto& [method, order, k_gs, k_sm, max_sweeps, tolerance, min_progress, budget, replay,
               min_sweeps, threads, executor, spans, omega, lifted_friction, acceleration,
               step_policy, proximal, proximal_joints, refinements, active_tolerance] = settings;
  static_cast<void>(executor);  // any will do, and any of these
  static_cast<void>(spans);
  SettingJudge judge;
  judge.Enumerator("method", method, Method::kInteriorPoint, "one of Method");
  judge.Enumerator("order", order, SweepOrder::kColoured, "one of SweepOrder");
  judge.Inside("k_gs", k_gs, 1, kInfinity, "1 or more");
  judge.Inside("k_sm", k_sm, 0, 1000, "0 to 1000");
  judge.Inside("max_sweeps", max_sweeps, 0, kInfinity, "0 or more");
  judge.Inside("tolerance", tolerance, 0, kInfinity, "0 or more");
  judge.Inside("min_progress", min_progress, 0, kInfinity, "0 or more");
  judge.Holds(budget.valid(), {"budget", AmountOf(budget), "0 or more"});
  if (replay != nullptr) {
    const auto work = static_cast<double>(replay->work);
    judge.Inside("replay->work", work, 0, kInfinity, "0 or more");
  }
  judge.Inside("min_sweeps", min_sweeps, 0, kInfinity, "0 or more");
  judge.Inside("threads", threads, 1, 1024, "1 to 1024");
  judge.Holds(omega > 0 && omega < 2, {"omega", omega, "above 0 and below 2"});
  judge.Enumerator("lifted_friction", lifted_friction, LiftedFriction::kHold,
                   "one of LiftedFriction");
  judge.Enumerator("acceleration", acceleration, Acceleration::kNncg, "one of Acceleration");
  judge.Enumerator("step_policy", step_policy, StepPolicy::kWeighed, "one of StepPolicy");
  judge.Inside("proximal", proximal, 1e-8, 1, "1e-8 to 1");
  judge.Inside("proximal_joints", proximal_joints, 1e-12, 1, "1e-12 to 1");
  judge.Inside("refinements", refinements, 1, 1000, "1 to 1000");
  judge.Inside("active_tolerance", active_tolerance, 0, kInfinity, "0 or more");
  return judge.bad();
}

}  // namespace cairn
