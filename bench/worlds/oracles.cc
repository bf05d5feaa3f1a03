// SPDX-License-Identifier: MIT
#include "worlds/oracles.h"

#include <algorithm>
#include <cmath>

namespace cairn::bench {
namespace {

enum { kOwn, kTen, kHundred };  // of BulletVariants()

/// The largest of a fact in Bullet's runs.
double Largest(std::span<const Trial> bullet, double Trial::*fact) {
  double largest = 0;
  for (const Trial& trial : bullet) largest = std::max(largest, trial.*fact);
  return largest;
}

}  // namespace

std::string_view NameOf(Oracle oracle) {
  constexpr std::array<std::string_view, kOracles> kNames = {
      "flies apart", "audit", "restless", "gap", "penetration", "momentum", "bits"};
  return kNames[static_cast<size_t>(oracle)];
}

std::vector<Finding> Judge(const Trial& trial, std::span<const Trial> bullet, const Lines& lines) {
  std::vector<Finding> findings;
  // NaN is above any line.
  const auto check = [&](Oracle oracle, double value, double line) {
    if (!(value <= line)) findings.push_back({oracle, value, line});
  };
  const std::span<const Trial> few = bullet.first(2);  // the world's and 10 iterations
  check(Oracle::kFliesApart, trial.fastest,
        std::max(lines.fast, lines.fast_factor * Largest(bullet, &Trial::fastest)));
  if (trial.audits_violated > 0) {
    check(Oracle::kAudit, trial.worst_audit.merit, trial.worst_audit.tolerance);
  }
  if (Largest(bullet, &Trial::late_fastest) < lines.resting) {
    check(Oracle::kRestless, trial.late_fastest, lines.restless);
  }
  check(Oracle::kGap, trial.gap, lines.gap_factor * Largest(few, &Trial::gap) + lines.gap_more);
  check(Oracle::kPenetration, trial.penetration,
        lines.penetration_factor * Largest(few, &Trial::penetration) + lines.penetration_more);
  for (double Trial::*drift : {&Trial::linear_drift, &Trial::angular_drift}) {
    check(Oracle::kMomentum, trial.*drift,
          std::max(lines.drift, lines.drift_factor * Largest(bullet, drift)));
  }
  return findings;
}

bool IsBulletRestless(std::span<const Trial> bullet, const Lines& lines) {
  return bullet[kHundred].late_fastest < lines.resting &&
         !(bullet[kTen].late_fastest <= lines.restless);
}

bool DoesBulletFlyApart(std::span<const Trial> bullet, const Lines& lines) {
  return std::any_of(bullet.begin(), bullet.end(),
                     [&](const Trial& trial) { return !(trial.fastest <= lines.fast); });
}

}  // namespace cairn::bench
