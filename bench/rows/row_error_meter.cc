// SPDX-License-Identifier: MIT
#include "rows/row_error_meter.h"

#include "measure/row_velocities.h"
#include "support/statistics.h"

namespace cairn::cli {

RowErrorMeter::RowErrorMeter(const RowProblem& problem, Reference reference)
    : problem_(problem), norm_(problem.rows.bodies) {
  if (reference == Reference::kNone) return;
  reference_ = bench::Converge({.bodies = problem.rows.bodies,
                                .rows = problem.rows.rows,
                                .impulses = problem.rows.row_impulses},
                               norm_);
}

RowError RowErrorMeter::Measure(const RowOutcome& outcome) const {
  const Report report = cairn::Measure(problem_.rows.problem(), outcome.impulses);
  RowError error{.residual = report.ok() ? report.residual_max : kNotMeasured,
                 .residual_energy = report.ok() ? report.residual_energy : kNotMeasured,
                 .velocity = kNotMeasured,
                 .velocity_rms = kNotMeasured};
  if (!reference_) return error;
  const bench::VelocityDistance distance =
      norm_.Between(outcome.velocities, reference_->velocities);
  error.velocity = distance.max;
  error.velocity_rms = distance.rms;
  return error;
}

RowError RowErrorMeter::MeasureStart() const {
  RowOutcome start;
  start.impulses = problem_.rows.row_impulses;
  start.velocities = bench::FreeVelocities(problem_.rows.bodies);
  bench::Push(problem_.rows.problem(), start.impulses, start.velocities);
  return Measure(start);
}

}  // namespace cairn::cli
