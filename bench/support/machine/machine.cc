// SPDX-License-Identifier: MIT
#include "support/machine/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <thread>
#include <vector>

#include "support/duration.h"
#include "support/machine/metronome.h"
#include "support/names.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kUnitOfWork(2);
constexpr double kQuiet = 3;  // [%]
constexpr double kNoisy = 15;

int LengthOfWork() {
  int length = 1 << 16;
  while (TimeChain(length) < Milliseconds(kUnitOfWork) / 2) length *= 2;
  double best = TimeChain(length);
  for (int i = 0; i < 5; ++i) best = std::min(best, TimeChain(length));
  return std::max(1, static_cast<int>(length * Milliseconds(kUnitOfWork) / best));
}

std::string FirstLine(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Of the first core.
std::string CpuInfo(std::string_view name) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with(name) && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

/// The number a text starts with, 0 if there is none.
double LeadingNumber(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

/// Cores in a list of the kernel: "0-3,8" are five.
int CountCores(const std::string& list) {
  int count = 0;
  for (const std::string& part : Split(list, ',')) {
    const std::vector<std::string> ends = Split(part, '-');
    count += 1 + static_cast<int>(LeadingNumber(ends.back()) - LeadingNumber(ends.front()));
  }
  return count;
}

std::vector<Cache> DescribeCaches() {
  std::vector<Cache> caches;
  for (int i = 0;; ++i) {
    const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", i);
    const std::string size = FirstLine((folder + "size").c_str());
    if (size.empty()) return caches;
    const double unit = size.ends_with('M') ? 1 << 20 : size.ends_with('K') ? 1 << 10 : 1;
    caches.push_back(
        {.type = FirstLine((folder + "type").c_str()),
         .level = static_cast<int>(LeadingNumber(FirstLine((folder + "level").c_str()))),
         .bytes = static_cast<std::int64_t>(LeadingNumber(size) * unit),
         .cores = CountCores(FirstLine((folder + "shared_cpu_list").c_str()))});
  }
}

}  // namespace

Noise MeasureNoise(std::chrono::milliseconds duration) {
  const int length = LengthOfWork();
  std::vector<double> times;
  const Clock::time_point end = Clock::now() + duration;
  while (Clock::now() < end || times.size() < 10) times.push_back(TimeChain(length));

  Noise noise;
  noise.repetitions = static_cast<int>(times.size());
  noise.median = Median(times);
  noise.p99_over_median = Quantile(times, 0.99) / noise.median;
  noise.threshold =
      std::max(1.0, 100 * (Quantile(times, 0.9) - Quantile(times, 0.1)) / noise.median);
  const std::string_view kind = noise.threshold <= kQuiet   ? "quiet"
                                : noise.threshold <= kNoisy ? "some noise"
                                                            : "noisy";
  const double line = std::max(kQuiet, noise.threshold);
  noise.verdict = noise.threshold <= kNoisy
                      ? fmt::format("{}: differences above {:.0f} % can be trusted", kind, line)
                      : fmt::format("{}: differences below {:.0f} % cannot be trusted", kind, line);
  return noise;
}

Machine DescribeMachine() {
  Machine machine;
  machine.cpu = CpuInfo("model name");
  machine.megahertz = static_cast<int>(LeadingNumber(CpuInfo("cpu MHz")));
  machine.caches = DescribeCaches();
  machine.cores = static_cast<int>(std::thread::hardware_concurrency());
  machine.governor = FirstLine("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  const std::string load = FirstLine("/proc/loadavg");
  size_t end = 0;
  for (int i = 0; i < 3 && end != std::string::npos; ++i) end = load.find(' ', end + 1);
  machine.load_average = load.substr(0, end);
  return machine;
}

}  // namespace cairn::cli
