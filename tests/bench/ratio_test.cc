// SPDX-License-Identifier: MIT
#include "compare/ratio.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace cairn::cli {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kThreshold = 0.05;
constexpr int kWarmup = 5, kRuns = 100;

/// What a machine does to a run.
struct Weather {
  double clock = 1;             ///< How slow the core is.
  double drift = 0.03;          ///< How far the clock wanders from one repetition to the next.
  double outliers = 0.05;       ///< Share of frames that are interrupted.
  double pressure = 0;          ///< Of others on the memory, at least.
  double pressure_changes = 0;  ///< And at most this much more in a repetition.
};

/// What is run.
struct Program {
  double slowness = 1;
  double memory_share = 0;  ///< How much of the pressure on memory it feels.
  int repetitions = 10, frames = 60;
};

struct OneRun {
  Repetitions times, arithmetic, memory;
  MeasuredSolver solver() const { return {times, arithmetic, memory}; }
};

class Machine {
 public:
  explicit Machine(unsigned seed) : generator_(seed) {}

  OneRun Measure(const Program& program, const Weather& weather) {
    OneRun run;
    double clock = weather.clock;
    for (int r = 0; r < program.repetitions; ++r) {
      clock *= 1 + weather.drift * (2 * Uniform() - 1);
      const double pressure = weather.pressure + weather.pressure_changes * Uniform();
      auto& times = run.times.emplace_back();
      auto& arithmetic = run.arithmetic.emplace_back();
      auto& memory = run.memory.emplace_back();
      for (int f = 0; f < program.frames; ++f) {
        const double work = 0.3 + 0.1 * std::sin(0.3 * f);
        const double felt = 1 + program.memory_share * pressure;
        times.push_back(f < kWarmup ? kNone
                                    : Disturbed(program.slowness * work * clock * felt, weather));
        arithmetic.push_back(Disturbed(0.015 * clock, weather));
        memory.push_back(Disturbed(0.02 * clock * (1 + pressure), weather));
      }
    }
    return run;
  }

 private:
  double Uniform() { return std::uniform_real_distribution<>()(generator_); }
  double Disturbed(double time, const Weather& weather) {
    const double quiet = time * (1 + 0.01 * Uniform());
    return Uniform() < weather.outliers ? quiet * (1 + 5 * Uniform()) : quiet;
  }

  std::mt19937 generator_;
};

bool IsRegression(const Ratio& ratio) { return ratio.value > 1 + kThreshold && ratio.low > 1; }

Ratio CompareRuns(unsigned seed, const Program& before, const Weather& weather_before,
                  const Program& after, const Weather& weather_after) {
  Machine machine(seed);
  const OneRun first = machine.Measure(before, weather_before);
  const OneRun second = machine.Measure(after, weather_after);
  return CompareTimes(first.solver(), second.solver());
}

int CountRegressions(const Program& before, const Weather& weather_before, const Program& after,
                     const Weather& weather_after) {
  int count = 0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    count += IsRegression(CompareRuns(seed, before, weather_before, after, weather_after));
  }
  return count;
}

TEST(TimeRatio, TheSameProgramIsNoRegression) { EXPECT_EQ(CountRegressions({}, {}, {}, {}), 0); }

TEST(TimeRatio, TenPercentAreFound) {
  EXPECT_GE(CountRegressions({}, {}, {.slowness = 1.1}, {}), 95);
}

TEST(TimeRatio, TenPercentAreFoundInFiveRepetitions) {
  EXPECT_GE(CountRegressions({.repetitions = 5}, {}, {.slowness = 1.1, .repetitions = 5}, {}), 95);
}

TEST(TimeRatio, LessThanTheThresholdIsNoRegression) {
  EXPECT_LE(CountRegressions({}, {}, {.slowness = 1.03}, {}), 1);
}

TEST(TimeRatio, HoldsTheTruth) {
  int held = 0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Ratio ratio = CompareRuns(seed, {}, {}, {.slowness = 1.2}, {});
    EXPECT_LT(ratio.low, ratio.value);
    EXPECT_LT(ratio.value, ratio.high);
    held += ratio.low < 1.2 && 1.2 < ratio.high;
  }
  EXPECT_GE(held, 98);
}

TEST(TimeRatio, ASlowerClockIsTakenOff) {
  const Weather slow{.clock = 1.3};
  EXPECT_EQ(CountRegressions({}, {}, {}, slow), 0);
  EXPECT_GE(CountRegressions({}, {}, {.slowness = 1.1}, slow), 95);
  // A slowdown does not hide behind a quicker clock either.
  EXPECT_GE(CountRegressions({}, slow, {.slowness = 1.1}, {}), 95);
}

TEST(TimeRatio, InterruptionsDoNotCount) {
  const Weather rough{.outliers = 0.3};
  EXPECT_EQ(CountRegressions({}, {}, {}, rough), 0);
  EXPECT_GE(CountRegressions({}, {}, {.slowness = 1.1}, rough), 95);
}

TEST(TimeRatio, MemoryThatOthersUseExplainsWhatItMay) {
  const Program bound{.memory_share = 0.4};
  const Weather alone{.pressure_changes = 0.3}, crowded{.pressure = 0.3, .pressure_changes = 0.3};
  EXPECT_GT(CompareRuns(1, bound, alone, bound, crowded).value, 1 + kThreshold);
  EXPECT_LE(CountRegressions(bound, alone, bound, crowded), 1);
  // What does not feel it is judged all the same, mostly.
  EXPECT_GE(CountRegressions({}, alone, {.slowness = 1.1}, crowded), 60);
}

TEST(TimeRatio, ShortTimesHaveWideIntervals) {
  Machine machine(1);
  OneRun first = machine.Measure({}, {}), second = machine.Measure({}, {});
  const Ratio usual = CompareTimes(first.solver(), second.solver());
  for (Repetitions* series : {&first.times, &second.times}) {
    for (auto& values : *series) {
      for (double& value : values) value *= 0.01;
    }
  }
  const Ratio tiny = CompareTimes(first.solver(), second.solver());
  EXPECT_DOUBLE_EQ(tiny.value, usual.value);
  EXPECT_GT(tiny.high - tiny.low, usual.high - usual.low + 0.1);
}

Repetitions Residuals(unsigned seed, double size, double scatter) {
  std::mt19937 generator(seed);
  std::normal_distribution<> normal;
  Repetitions all(5);
  for (auto& values : all) {
    for (int f = 0; f < 60; ++f) {
      values.push_back(f < kWarmup ? kNone : size * std::exp(scatter * normal(generator)));
    }
  }
  return all;
}

TEST(ResidualRatio, TheSameNumbersAreExactlyTheSame) {
  const Repetitions residuals = Residuals(1, 0.1, 1);
  const Ratio ratio = CompareResiduals(residuals, residuals);
  EXPECT_EQ(ratio.value, 1);
}

TEST(ResidualRatio, SameSizesAreNotToldApartAndTwiceTheSizeIs) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Repetitions before = Residuals(seed, 0.1, 0.5);
    const Ratio same = CompareResiduals(before, Residuals(seed + 100, 0.1, 0.5));
    EXPECT_FALSE(same.value > 1.25 && same.low > 1) << seed;
    const Ratio twice = CompareResiduals(before, Residuals(seed + 100, 0.2, 0.5));
    EXPECT_GT(twice.low, 1.25) << seed;
  }
}

TEST(ResidualRatio, RoundingDoesNotCount) {
  EXPECT_EQ(CompareResiduals(Residuals(1, 1e-9, 0), Residuals(2, 3e-7, 0)).value, 1);
}

}  // namespace
}  // namespace cairn::cli
