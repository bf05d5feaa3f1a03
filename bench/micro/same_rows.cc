// SPDX-License-Identifier: MIT
#include "micro/same_rows.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "micro/bullet_rows.h"
#include "micro/pair_scene.h"
#include "simd/target.h"

namespace cairn::micro {
namespace {

constexpr int kPairs = 1024;
constexpr int kSweeps = 200;
// Of the largest impulse: both sides round the numbers of a row to float, and not the same numbers,
// because ours are whitened; what a row is off by goes on to those after it.
constexpr double kTolerance = 1e-5;
// Of the squared residual at the start.
constexpr double kEnergyLeft = 1e-3;

double LargestDifference(const std::vector<float>& ours, const std::vector<float>& theirs) {
  double difference = 0, largest = 0;
  for (size_t i = 0; i < ours.size(); ++i) {
    difference = std::max(difference, std::fabs(double{ours[i]} - theirs[i]));
    largest = std::max(largest, std::fabs(double{ours[i]}));
  }
  return difference / largest;
}

double Measure(const simd::PairKernels& kernels, PairScene* scene) {
  kernels.measure(scene->Work());
  return scene->MeasuredEnergy();
}

std::string Describe(const std::string& what, double value, double limit) {
  std::ostringstream text;
  text << what << ": " << value << ", at most " << limit;
  return text.str();
}

}  // namespace

std::string FindFault(SceneKind kind) {
  const simd::PairKernels& kernels = simd::PairKernelsFor(simd::BestTarget());
  const RowScene rows = MakeRowScene(kind, kPairs);
  PairScene ours(rows);
  BulletRows theirs(rows);
  ours.Reset();
  theirs.Reset();

  const double energy = Measure(kernels, &ours);
  kernels.sweep(ours.Work());
  theirs.SweepPairByPair();
  const double difference = LargestDifference(ours.Impulses(), theirs.Impulses());
  if (!(difference <= kTolerance)) {
    return Describe("impulses differ from Bullet's", difference, kTolerance);
  }

  for (int i = 0; i < kSweeps; ++i) {
    kernels.sweep(ours.Work());
    theirs.Sweep();
  }
  const double left = Measure(kernels, &ours) / energy;
  if (!(left <= kEnergyLeft)) return Describe("sweeps do not converge", left, kEnergyLeft);
  if (!ours.IsSound() || !theirs.IsSound()) return "infinite or denormal numbers";
  return "";
}

}  // namespace cairn::micro
