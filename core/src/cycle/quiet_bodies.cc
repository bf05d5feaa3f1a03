// SPDX-License-Identifier: MIT
#include "cycle/quiet_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cairn/detail/eigen.h"
#include "cycle/end_velocity.h"

namespace cairn {
namespace {

/// A count that a game does not reach, and that does not overflow.
constexpr int kMost = std::numeric_limits<int>::max() / 2;

/// As many are looked at by one thread at a time.
constexpr int kBodiesOfPart = 512;

int PartsOf(std::size_t bodies) {
  return static_cast<int>((bodies + kBodiesOfPart - 1) / kBodiesOfPart);
}

}  // namespace

void QuietBodies::Reserve(std::size_t bodies) {
  if (counts_.size() < bodies) counts_.resize(bodies);
  by_id_.reserve(counts_.size());
  if (runs_.size() < bodies) runs_.resize(bodies);
  const auto parts = static_cast<std::size_t>(PartsOf(bodies));
  if (runs_of_.size() < parts) runs_of_.resize(parts);
}

bool QuietBodies::AnyMoved(const ContactProblem& problem, detail::Threads* threads) {
  const int bodies = static_cast<int>(problem.bodies.size());
  const auto look = [&](int first, int count) {
    bool moved = false;
    for (int i = first; i < first + count; ++i) {
      const std::uint64_t id = problem.bodies[i].id;
      moved |= id != 0 && counts_[i].id != id;
    }
    runs_of_[first / kBodiesOfPart] = moved ? 1 : 0;
  };
  threads->For(bodies, kBodiesOfPart, look, {SpanKind::kResults});
  const auto parts = std::span(runs_of_).first(PartsOf(problem.bodies.size()));
  return std::any_of(parts.begin(), parts.end(), [](int moved) { return moved != 0; });
}

void QuietBodies::Follow(std::span<const Body> bodies) {
  by_id_.assign(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(known_));
  const auto before = [](const Count& a, const Count& b) { return a.id < b.id; };
  std::sort(by_id_.begin(), by_id_.end(), before);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::uint64_t id = bodies[i].id;
    if (id == 0 || counts_[i].id == id) continue;
    const auto found = std::lower_bound(by_id_.begin(), by_id_.end(), Count{.id = id}, before);
    counts_[i] = found != by_id_.end() && found->id == id ? *found : Count{};
  }
}

int QuietBodies::LookAt(const ContactProblem& problem, std::span<const Velocity> velocities,
                        std::span<const Velocity> means, const Speeds& speeds,
                        std::span<const int> island_of, int first, int count) {
  const bool moves_on = !means.empty() && problem.motions.empty();
  Run* const runs = runs_.data() + first;
  int found = 0;
  for (int i = first; i < first + count; ++i) {
    const int at = island_of[i];
    Count& known = counts_[i];
    const Body& body = problem.bodies[i];
    if (at < 0 || known.id != body.id || known.inv_mass != body.inv_mass) {
      known = {.id = body.id, .inv_mass = body.inv_mass};
    }
    if (at < 0) continue;
    const Velocity end = EndOf(problem, velocities, i);
    const Velocity& mean = moves_on ? means[i] : end;
    const double linear2 =
        std::max(View(end.linear).squaredNorm(), View(mean.linear).squaredNorm());
    const double angular2 =
        std::max(View(end.angular).squaredNorm(), View(mean.angular).squaredNorm());
    const bool is_quiet =
        linear2 < speeds.linear * speeds.linear && angular2 < speeds.angular * speeds.angular;
    known.solves = is_quiet ? std::min(known.solves + 1, kMost) : 0;
    if (found == 0 || runs[found - 1].island != at) runs[found++] = {at, 0, 0, kMost};
    Run& run = runs[found - 1];
    run.linear2 = std::max(run.linear2, linear2);
    run.angular2 = std::max(run.angular2, angular2);
    run.solves = std::min(run.solves, known.solves);
  }
  return found;
}

void QuietBodies::Tell(const ContactProblem& problem, std::span<const Velocity> velocities,
                       std::span<const Velocity> means, const Speeds& speeds,
                       detail::Threads* threads, Report* report) {
  const int bodies = static_cast<int>(problem.bodies.size());
  const auto end = static_cast<std::ptrdiff_t>(known_);
  if (bodies > end) std::fill(counts_.begin() + end, counts_.begin() + bodies, Count{});
  if (AnyMoved(problem, threads)) Follow(problem.bodies);
  known_ = problem.bodies.size();
  const auto look = [&](int first, int count) {
    runs_of_[first / kBodiesOfPart] =
        LookAt(problem, velocities, means, speeds, report->island_of, first, count);
  };
  threads->For(bodies, kBodiesOfPart, look, {SpanKind::kResults});
  for (IslandReport& island : report->islands) {
    // one of rows that push nothing has no body to be quiet
    island.quiet = island.bodies > 0 ? kMost : 0;
  }
  for (int part = 0; part < PartsOf(bodies); ++part) {
    const Run* const runs = runs_.data() + part * kBodiesOfPart;
    for (const Run& run : std::span(runs, runs_of_[part])) {
      IslandReport& island = report->islands[run.island];
      // squares until all are seen
      island.speed = std::max(island.speed, run.linear2);
      island.spin = std::max(island.spin, run.angular2);
      island.quiet = std::min(island.quiet, run.solves);
    }
  }
  for (IslandReport& island : report->islands) {
    island.speed = std::sqrt(island.speed);
    island.spin = std::sqrt(island.spin);
  }
}

}  // namespace cairn
