// SPDX-License-Identifier: MIT
#include "cycle/tension/tension.h"

#include <algorithm>
#include <new>

#include "cairn/detail/spans.h"
#include "problem/joint_errors.h"

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
  TakeBackLess(&stiff);
  return stiff;
}

void Tension::TakeBackLess(ContactProblem* problem) {
  joint_rows_.clear();
  joint_errors_.assign(problem->joint_errors.begin(), problem->joint_errors.end());
  const size_t bodies = problem->bodies.size(), rows = problem->joint_rows.size();
  const auto strain = [&](int body) {
    return static_cast<size_t>(body) < bodies ? problem->bodies[body].strain : 0;
  };
  for (const Joint& joint : problem->joints) {
    const double share = ShareOfErp(std::max(strain(joint.body_a), strain(joint.body_b)));
    if (share == 1) continue;
    if (joint_rows_.empty()) {
      joint_rows_.assign(problem->joint_rows.begin(), problem->joint_rows.end());
    }
    for (int i = 0; i < std::min(joint.rows, Joint::kMostRows); ++i) {
      const size_t row = static_cast<size_t>(joint.first_row) + i;
      if (row >= rows) continue;
      const float error = ErrorOf(*problem, joint, i);
      const auto taken_back = static_cast<float>(share * error);
      joint_rows_[row].target = (joint_rows_[row].target - error) + taken_back;
      if (!joint_errors_.empty()) joint_errors_[row] = taken_back;
    }
  }
  if (joint_rows_.empty()) return;
  problem->joint_rows = joint_rows_;
  problem->joint_errors = joint_errors_;
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
