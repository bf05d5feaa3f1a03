// SPDX-License-Identifier: MIT
#include "accuracy/states/states.h"

#include <cmath>
#include <limits>
#include <vector>

#include "support/statistics.h"

namespace cairn::accuracy {
namespace {

Tail TailOf(const std::vector<double>& values) {
  return {
      .p50 = cli::Median(values), .p99 = cli::Quantile(values, 0.99), .max = cli::Largest(values)};
}

double Ratio(double above, double below) {
  return below > 0 ? above / below : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

FrameStatistics StatisticsOf(std::span<const ShadowFrame> frames) {
  FrameStatistics result;
  std::vector<double> cpu, wall, calm, errors;
  double stepped = 0, restored = 0, steps = 0, factorisations = 0;
  for (const ShadowFrame& frame : frames) {
    stepped += frame.steps() > 0 ? 1 : 0;
    restored += frame.restored;
    steps += frame.steps();
    factorisations += frame.factorisations;
    cpu.push_back(1e3 * (frame.time.cpu - frame.budget));
    wall.push_back(1e3 * (frame.time.wall - frame.budget));
    result.interrupted += frame.time.preempted ? 1 : 0;
    if (frame.time.preempted) continue;
    calm.push_back(wall.back());
    if (frame.step_predicted > 0) {
      errors.push_back(std::abs(frame.step_time / frame.step_predicted - 1));
    }
  }
  result.frames = static_cast<int>(frames.size());
  result.stepped = Ratio(stepped, result.frames);
  result.restored = Ratio(restored, steps);
  result.factorisations = Ratio(factorisations, result.frames);
  result.cpu_over = TailOf(cpu);
  result.wall_over = TailOf(wall);
  result.wall_over_calm = TailOf(calm);
  result.step_error = TailOf(errors);
  return result;
}

}  // namespace cairn::accuracy
