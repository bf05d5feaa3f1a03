// SPDX-License-Identifier: MIT
#include "cli/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <thread>
#include <vector>

#include "cli/duration.h"
#include "cli/statistics.h"

namespace cairn::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kUnitOfWork(2);
constexpr double kQuiet = 3;  // [%]
constexpr double kNoisy = 15;

/// A chain of dependent additions and multiplications: nothing but the clock of the CPU decides how
/// long it takes.
void Work(int length) {
  volatile double start = 0.5, sink = 0;  // volatile: the compiler knows how the chain ends
  double value = start;
  for (int i = 0; i < length; ++i) value = value * 0.999999 + 1e-6;
  sink = value;
  static_cast<void>(sink);
}

double TimeWork(int length) {
  const Clock::time_point start = Clock::now();
  Work(length);
  return Milliseconds(Clock::now() - start);
}

int LengthOfWork() {
  int length = 1 << 16;
  while (TimeWork(length) < Milliseconds(kUnitOfWork) / 2) length *= 2;
  double best = TimeWork(length);
  for (int i = 0; i < 5; ++i) best = std::min(best, TimeWork(length));
  return std::max(1, static_cast<int>(length * Milliseconds(kUnitOfWork) / best));
}

std::string FirstLine(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string CpuModel() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

}  // namespace

Noise MeasureNoise(std::chrono::milliseconds duration) {
  const int length = LengthOfWork();
  std::vector<double> times;
  const Clock::time_point end = Clock::now() + duration;
  while (Clock::now() < end || times.size() < 10) times.push_back(TimeWork(length));

  Noise noise;
  noise.repetitions = static_cast<int>(times.size());
  noise.median = Median(times);
  noise.p99_over_median = Quantile(times, 0.99) / noise.median;
  noise.threshold =
      std::max(1.0, 100 * (Quantile(times, 0.9) - Quantile(times, 0.1)) / noise.median);
  const std::string_view kind = noise.threshold <= kQuiet   ? "quiet"
                                : noise.threshold <= kNoisy ? "some noise"
                                                            : "noisy";
  noise.verdict = fmt::format("{}: differences above {:.0f} % can be trusted", kind,
                              std::max(kQuiet, noise.threshold));
  return noise;
}

Machine DescribeMachine() {
  Machine machine;
  machine.cpu = CpuModel();
  machine.cores = static_cast<int>(std::thread::hardware_concurrency());
  machine.governor = FirstLine("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  const std::string load = FirstLine("/proc/loadavg");
  size_t end = 0;
  for (int i = 0; i < 3 && end != std::string::npos; ++i) end = load.find(' ', end + 1);
  machine.load_average = load.substr(0, end);
  return machine;
}

}  // namespace cairn::cli
