// SPDX-License-Identifier: MIT
#include "cycle/tension.h"

#include <algorithm>
#include <new>

#include "cairn/detail/spans.h"

namespace cairn {

ContactProblem Tension::Stiffen(const ContactProblem& problem, const Settings& settings) {
  // where velocities are counted from motions, only the caller can change what torques do
  acts_ = settings.geometric_stiffness && problem.time_step > 0 && problem.time_step < kInfinity &&
          problem.motions.empty();
  if (!acts_) stiffness_.Reset();
  if (stiffness_.empty()) return problem;
  const SpanClock clock(settings.tuning.spans, 0, {SpanKind::kTension});
  const bool by_caller = std::any_of(problem.bodies.begin(), problem.bodies.end(),
                                     [](const Body& body) { return body.strain != 0; });
  if (by_caller) {
    // raised inertia is not raised once more
    stiffness_.Reset();
    return problem;
  }
  bodies_.assign(problem.bodies.begin(), problem.bodies.end());
  stiffness_.Apply(problem.time_step / settings.substeps, problem, bodies_);
  ContactProblem stiff = problem;
  stiff.bodies = bodies_;
  return stiff;
}

void Tension::Learn(const ContactProblem& problem, const Impulses& impulses,
                    const Settings& settings, const Report& report) {
  if (!acts_) return;
  const SpanClock clock(settings.tuning.spans, 0, {SpanKind::kTension});
  try {
    stiffness_.Learn(problem.time_step, problem, impulses, report);
  } catch (const std::bad_alloc&) {
    // the results are written: what is missing is an estimate for the next step
    Forget();
  }
}

}  // namespace cairn
