// SPDX-License-Identifier: MIT
#include "compare/ratio.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "support/statistics.h"

namespace cairn::cli {
namespace {

constexpr int kDraws = 500;
constexpr double kTail = 0.01;  ///< Of the draws on either side.
/// Frames that are near each other are disturbed together.
constexpr int kBlock = 8;
constexpr double kRestart = 0.015;       ///< Between two starts of the same program,
constexpr double kRestartTime = 0.0005;  ///< and so much [ms].
/// What the quickest of few repetitions still has of interruptions.
constexpr double kFew = 0.03;
/// Memory beats are noisy themselves, which makes slopes against them look flatter than they are.
constexpr double kFlattened = 2;
constexpr double kTiny = 1e-9;      ///< In place of 0, which has no logarithm.
constexpr double kRounding = 1e-6;  ///< [m/s]

using Picks = std::vector<int>;

/// Draws what a bootstrap is made of. The same numbers each time: a comparison must not depend on
/// luck.
class Lots {
 public:
  Picks Repetitions(size_t count) {
    Picks picks(count);
    for (int& pick : picks) pick = Below(static_cast<int>(count));
    return picks;
  }
  Picks Frames(size_t count) {
    const int blocks = std::max<int>(1, static_cast<int>(count) - kBlock + 1);
    Picks picks;
    while (picks.size() < count) {
      const int first = Below(blocks);
      for (int i = 0; i < kBlock && picks.size() < count; ++i) {
        picks.push_back(std::min(first + i, static_cast<int>(count) - 1));
      }
    }
    return picks;
  }

 private:
  int Below(int end) { return static_cast<int>(generator_() % static_cast<unsigned>(end)); }

  std::minstd_rand generator_{20};
};

Picks All(size_t count) {
  Picks picks(count);
  std::iota(picks.begin(), picks.end(), 0);
  return picks;
}

/// Numbers of the frames that count.
Picks CountedFrames(const Repetitions& series) {
  Picks frames;
  for (int f = 0; f < static_cast<int>(series.front().size()); ++f) {
    if (std::isfinite(series.front()[f])) frames.push_back(f);
  }
  return frames;
}

/// Values of the frames that count, those of each repetition divided by its unit.
Repetitions Scale(const Repetitions& series, const std::vector<double>& units,
                  const Picks& frames) {
  Repetitions scaled;
  for (size_t r = 0; r < series.size(); ++r) {
    std::vector<double>& values = scaled.emplace_back();
    for (const int f : frames) values.push_back(std::max(series[r][f], kTiny) / units[r]);
  }
  return scaled;
}

std::vector<double> Medians(const Repetitions& series) {
  std::vector<double> medians;
  for (const auto& values : series) medians.push_back(Median(values));
  return medians;
}

double Quickest(const Repetitions& series, const Picks& repetitions, int frame) {
  double least = series[repetitions.front()][frame];
  for (const int r : repetitions) least = std::min(least, series[r][frame]);
  return least;
}

/// Two runs, frame by frame.
struct Pair {
  const Repetitions &before, &after;

  /// The logarithm of the ratio.
  double Difference(const Picks& before_picks, const Picks& after_picks,
                    const Picks& frames) const {
    std::vector<double> differences;
    for (const int f : frames) {
      differences.push_back(
          std::log(Quickest(after, after_picks, f) / Quickest(before, before_picks, f)));
    }
    return Median(differences);
  }
  double Difference() const {
    return Difference(All(before.size()), All(after.size()), All(before.front().size()));
  }
};

struct Interval {
  double low, high;
};

template <class Draw>
Interval Bootstrap(const Repetitions& before, const Repetitions& after, Draw draw) {
  Lots lots;
  std::vector<double> draws;
  for (int i = 0; i < kDraws; ++i) {
    const Picks first = lots.Repetitions(before.size()), second = lots.Repetitions(after.size());
    draws.push_back(draw(first, second, lots.Frames(before.front().size())));
  }
  return {Quantile(draws, kTail), Quantile(draws, 1 - kTail)};
}

/// Times and memory beats of repetitions as logarithms, each less its mean over the run.
struct Cloud {
  double xx = 0, xy = 0, yy = 0;
  int freedom = -1;

  void Add(std::vector<double> x, std::vector<double> y) {
    const double x_mean = Mean(x), y_mean = Mean(y);
    for (size_t i = 0; i < x.size(); ++i) {
      xx += (x[i] - x_mean) * (x[i] - x_mean);
      xy += (x[i] - x_mean) * (y[i] - y_mean);
      yy += (y[i] - y_mean) * (y[i] - y_mean);
    }
    freedom += static_cast<int>(x.size()) - 1;
  }
  /// How steeply times may rise with memory beats: the slope and two standard errors, in [0, 1].
  double SteepestSlope() const {
    if (xx <= 0 || freedom < 1) return 1;
    const double slope = xy / xx;
    const double rest = std::max(0.0, yy - slope * xy);
    return std::clamp(slope + 2 * std::sqrt(rest / freedom / xx), 0.0, 1.0);
  }
};

std::vector<double> LogMedians(const Repetitions& series) {
  std::vector<double> logs = Medians(series);
  for (double& value : logs) value = std::log(value);
  return logs;
}

}  // namespace

Ratio CompareTimes(const MeasuredSolver& before, const MeasuredSolver& after) {
  const Picks frames = CountedFrames(before.times);
  const std::vector<double> clock = Medians(before.arithmetic),
                            clock_after = Medians(after.arithmetic);
  const Repetitions times = Scale(before.times, clock, frames);
  const Repetitions times_after = Scale(after.times, clock_after, frames);
  const Repetitions memory = Scale(before.memory, clock, frames);
  const Repetitions memory_after = Scale(after.memory, clock_after, frames);

  const Pair pair{times, times_after};
  const double difference = pair.Difference();
  Interval interval = Bootstrap(times, times_after,
                                [&](const Picks& first, const Picks& second, const Picks& drawn) {
                                  return pair.Difference(first, second, drawn);
                                });

  Cloud cloud;
  cloud.Add(LogMedians(memory), LogMedians(times));
  cloud.Add(LogMedians(memory_after), LogMedians(times_after));
  const double explained =
      kFlattened * cloud.SteepestSlope() * Pair{memory, memory_after}.Difference();

  const double shortest = std::min(Median(Medians(before.times)), Median(Medians(after.times)));
  const bool few = std::min(times.size(), times_after.size()) < kFewestRepetitions;
  const double restart = kRestart + kRestartTime / shortest + (few ? kFew : 0);
  interval.low = std::min(interval.low, difference) - restart - std::max(0.0, explained);
  interval.high = std::max(interval.high, difference) + restart - std::min(0.0, explained);
  return {std::exp(difference), std::exp(interval.low), std::exp(interval.high)};
}

Ratio CompareResiduals(const Repetitions& before, const Repetitions& after) {
  const Picks frames = CountedFrames(before);
  const Repetitions first = Scale(before, std::vector<double>(before.size(), 1), frames);
  const Repetitions second = Scale(after, std::vector<double>(after.size(), 1), frames);
  const auto mean = [](const Repetitions& series, const Picks& repetitions, const Picks& drawn) {
    double sum = 0;
    for (const int r : repetitions) {
      for (const int f : drawn) sum += series[r][f];
    }
    const auto count = static_cast<double>(repetitions.size() * drawn.size());
    return std::max(kRounding, sum / count);
  };
  const auto ratio = [&](const Picks& old_picks, const Picks& new_picks, const Picks& drawn) {
    return std::log(mean(second, new_picks, drawn) / mean(first, old_picks, drawn));
  };
  const double difference = ratio(All(first.size()), All(second.size()), All(frames.size()));
  const Interval interval = Bootstrap(first, second, ratio);
  return {std::exp(difference), std::exp(std::min(interval.low, difference)),
          std::exp(std::max(interval.high, difference))};
}

}  // namespace cairn::cli
