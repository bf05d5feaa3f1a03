// SPDX-License-Identifier: MIT
#include "cycle/quiet_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cairn/detail/eigen.h"

namespace cairn {
namespace {

/// A count that a game does not reach, and that does not overflow.
constexpr int kMost = std::numeric_limits<int>::max() / 2;

/// Velocity at the end of the step, also where those of a problem count from its start.
Velocity EndOf(const ContactProblem& problem, std::span<const Velocity> velocities, size_t body) {
  Velocity end = velocities[body];
  if (problem.motions.empty()) return end;
  const ContactMotion& motion = problem.motions[body];
  View(end.linear) += Eigen::Map<const Eigen::Vector3f>(motion.free_velocity).cast<double>();
  View(end.angular) += Eigen::Map<const Eigen::Vector3f>(motion.free_spin).cast<double>();
  return end;
}

}  // namespace

void QuietBodies::Reserve(std::size_t bodies) {
  if (counts_.size() < bodies) counts_.resize(bodies);
}

void QuietBodies::Tell(const ContactProblem& problem, std::span<const Velocity> velocities,
                       std::span<const Velocity> means, double speed, Report* report) {
  for (IslandReport& island : report->islands) {
    // one of rows that push nothing has no body to be quiet
    island.quiet = island.bodies > 0 ? kMost : 0;
  }
  counts_.resize(problem.bodies.size());
  for (size_t i = 0; i < problem.bodies.size(); ++i) {
    const int at = report->island_of[i];
    Count& count = counts_[i];
    if (at < 0 || count.id != problem.bodies[i].id) count = {.id = problem.bodies[i].id};
    if (at < 0) continue;
    IslandReport& island = report->islands[at];
    const Velocity end = EndOf(problem, velocities, i);
    const bool moves_on = !means.empty() && problem.motions.empty();
    const Velocity& mean = moves_on ? means[i] : end;
    const double linear = std::max(View(end.linear).squaredNorm(), View(mean.linear).squaredNorm());
    const double angular =
        std::max(View(end.angular).squaredNorm(), View(mean.angular).squaredNorm());
    const bool is_quiet = linear < speed * speed && angular < speed * speed;
    count.solves = is_quiet ? std::min(count.solves + 1, kMost) : 0;
    // squares until all are seen
    island.speed = std::max(island.speed, linear);
    island.spin = std::max(island.spin, angular);
    island.quiet = std::min(island.quiet, count.solves);
  }
  for (IslandReport& island : report->islands) {
    island.speed = std::sqrt(island.speed);
    island.spin = std::sqrt(island.spin);
  }
}

}  // namespace cairn
