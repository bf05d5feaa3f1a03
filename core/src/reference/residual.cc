// SPDX-License-Identifier: MIT
#include "reference/residual.h"

#include <algorithm>
#include <cmath>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "problem/contact_expansion.h"
#include "problem/islands.h"
#include "problem/validate.h"
#include "reference/row_merit.h"

namespace cairn {

Residual MeasureResidual(const PackedIsland& island, const IslandState& state) {
  Residual residual;
  double energy_squared = 0;
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    if (row.diagonal <= 0) continue;
    const double x = state.x[i];
    const double w = RelativeVelocity(row, state.u, x);
    const double natural = Clamp(x - w / row.diagonal, BoundsOf(row, state.x));
    const double error = row.diagonal * std::abs(x - natural);

    double& largest = row.angular ? residual.max_angular : residual.max;
    largest = std::max(largest, error);
    energy_squared += error * error / row.diagonal;
  }
  residual.energy = std::sqrt(energy_squared);
  return residual;
}

namespace {

/// The root of a^2 + b^2 for numbers >= 0, also where the squares are out of range; to the bit the
/// same with every C library.
double RootOfSquares(double a, double b) {
  const double larger = std::max(a, b), smaller = std::min(a, b);
  if (!(larger > 0) || std::isinf(larger)) return larger;
  const double ratio = smaller / larger;
  return larger * std::sqrt(1 + ratio * ratio);
}

}  // namespace

void Accumulate(const Residual& part, Report* report) {
  report->residual_max = std::max(report->residual_max, part.max);
  report->residual_angular = std::max(report->residual_angular, part.max_angular);
  report->residual_energy = RootOfSquares(report->residual_energy, part.energy);
}

namespace {

Report MeasureRows(const ContactProblem& problem, std::span<const double> impulses) {
  Report report;
  const Packer packer(problem, Settings{});
  for (const Island& island : FindIslands(problem)) {
    const PackedIsland packed = packer.Pack(island);
    IslandState state{.x = {}, .u = Array<Vector6>(packed.bodies + 1)};
    for (int row : island.rows) state.x.push_back(impulses[row]);
    RecomputeVelocities(packed, &state);

    IslandReport& part = report.islands.emplace_back();
    part.first_body = island.bodies.empty() ? -1 : island.bodies.front();
    part.bodies = packed.bodies;
    part.rows = static_cast<int>(packed.rows.size());
    part.residual = MeasureResidual(packed, state);
    part.merit = MeasureMerit(packed, state).value();
    Accumulate(part.residual, &report);
  }
  return report;
}

}  // namespace

Report Measure(const ContactProblem& problem, std::span<const double> impulses) {
  Array<double> rows(impulses.begin(), impulses.end());
  Array<ContactImpulse> points(problem.points.size());
  Array<TwistImpulse> twists(problem.twists.size());
  Array<float> joint_rows(problem.joint_rows.size());
  Impulses given{.rows = rows, .points = points, .twists = twists, .joint_rows = joint_rows};
  const bool rows_only = problem.manifolds.empty() && problem.joints.empty();
  if (!rows_only) given.rows = given.rows.first(std::min(rows.size(), problem.rows.size()));
  Report report = Validate(problem, given);
  if (!report.ok() || rows_only) return report.ok() ? MeasureRows(problem, impulses) : report;

  const ContactExpansion expansion(problem, given);
  if (expansion.problem().rows.size() == impulses.size()) {
    return MeasureRows(expansion.problem(), impulses);
  }
  report.status = Status::kWrongSize;
  return report;
}

}  // namespace cairn
