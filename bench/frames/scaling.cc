// SPDX-License-Identifier: MIT
#include <cairn/bullet/constraint_solver.h>
#include <cairn/detail/spans.h>
#include <cairn/detail/threads.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "frames/experiments.h"
#include "run/scene_run.h"
#include "support/duration.h"
#include "support/machine/run_context.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

constexpr int kIterations = 10, kMostSpans = 65536;

/// Nobody ever comes: the caller does all, cut as for the threads that were asked for.
class Nobody final : public Executor {
 public:
  ~Nobody() override {
    for (const auto& [work, what] : tasks_) work(what);
  }
  void Submit(void (*work)(void*), void* what) override { tasks_.emplace_back(work, what); }

 private:
  std::vector<std::pair<void (*)(void*), void*>> tasks_;
};

double Microseconds(Span::Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

/// A substep of one thread that is to be shared by several [us].
struct Forecast {
  double serial = 0;     ///< nobody can help with
  double shared = 0;     ///< the rest, on all threads evenly
  double imbalance = 0;  ///< until the last of them is done
  double barriers = 0;
  std::array<double, kSpanKinds> serial_of{};  ///< of serial

  double all() const { return serial + shared + imbalance + barriers; }
};

/// What @p threads threads would take for what one did.
/// @param whole    the substep [us]
/// @param barrier  the end of a stage [us]
Forecast Predict(std::span<const Span> spans, double whole, int threads, double barrier) {
  Forecast forecast;
  double staged = 0;
  std::array<double, kSpanKinds> outer_of{}, staged_of{};
  Span::Clock::time_point outer = Span::Clock::time_point::max();
  // a span comes after those that it contains
  for (size_t i = spans.size(); i-- > 0;) {
    const Span& span = spans[i];
    const double time = Microseconds(span.end - span.begin);
    const auto kind = static_cast<size_t>(span.label.kind);
    if (span.begin < outer) {
      outer = span.begin;
      outer_of[kind] += time;
    }
    if (span.units == 0) continue;
    staged += time;
    staged_of[kind] += time;
    if (span.units == 1) {
      forecast.serial += time;
      forecast.serial_of[kind] += time;
      continue;
    }
    const double rounds = std::ceil(static_cast<double>(span.units) / threads);
    const double together = time / threads;
    forecast.shared += together;
    forecast.imbalance += std::max(0.0, time * rounds / span.units - together);
    forecast.barriers += threads > 1 ? barrier : 0;
  }
  forecast.serial += std::max(0.0, whole - staged);
  for (size_t k = 0; k < kSpanKinds; ++k) {
    forecast.serial_of[k] += std::max(0.0, outer_of[k] - staged_of[k]);
  }
  return forecast;
}

/// The end of a stage of little work on so many threads [us].
double MeasureBarrier(int threads) {
  constexpr int kStages = 20000, kPartsOfThread = 4;
  detail::Threads team;
  team.Follow(threads, nullptr);
  const detail::AwakeHelpers awake(&team, threads);
  const auto nothing = [](int, int) {};
  const int parts = kPartsOfThread * threads;
  team.For(parts * 1000, 1, nothing);
  const auto begin = Span::Clock::now();
  for (int i = 0; i < kStages; ++i) team.For(parts, 1, nothing);
  return Microseconds(Span::Clock::now() - begin) / kStages;
}

/// By the number of threads: measured on as many as there are cores for, beyond that taken to grow
/// with the logarithm of their number.
class Barriers {
 public:
  Barriers(const std::vector<int>& threads, int cores) {
    for (const int count : threads) {
      if (count > 1 && count <= cores) measured_.emplace(count, MeasureBarrier(count));
    }
    if (measured_.empty()) measured_.emplace(2, MeasureBarrier(2));
  }
  double operator()(int threads) const {
    if (threads == 1) return 0;
    const auto known = measured_.find(threads);
    if (known != measured_.end()) return known->second;
    const auto [most, us] = *measured_.rbegin();
    return us * std::log2(threads) / std::log2(most);
  }
  std::string Describe() const {
    std::string text;
    for (const auto& [threads, us] : measured_) {
      text += fmt::format("{}{:.2f} us on {}", text.empty() ? "" : ", ", us, threads);
    }
    return text;
  }

 private:
  std::map<int, double> measured_;
};

/// What one thread does alone between two stages, or in a stage of one unit; and stages of so few
/// units that threads have none.
struct Alone {
  std::string after, before;
  std::vector<double> us;  ///< of each frame, 0 where there was none
  int times = 0;           ///< in the last frame
};

/// Adds what happened in @p frame, which is one more than before.
void AddAlone(std::span<const Span> spans, size_t frame, int threads, std::vector<Alone>* alone) {
  const auto add = [&](std::string_view after, std::string_view before, double us) {
    auto at = std::find_if(alone->begin(), alone->end(), [&](const Alone& known) {
      return known.after == after && known.before == before;
    });
    if (at == alone->end()) {
      at = alone->insert(alone->end(), {std::string(after), std::string(before), {}, 0});
    }
    if (at->us.size() <= frame) at->times = 0;
    at->us.resize(frame + 1, 0);
    at->us[frame] += us;
    ++at->times;
  };
  const Span* last = nullptr;
  for (const Span& span : spans) {
    if (span.units == 0) continue;
    const std::string_view kind = Describe(span.label.kind);
    add(last != nullptr ? Describe(last->label.kind) : "the begin", kind,
        Microseconds(span.begin - (last != nullptr ? last->end : spans.front().begin)));
    if (span.units < threads) {
      add(fmt::format("{} unit{} of", span.units, span.units == 1 ? "" : "s"), kind,
          Microseconds(span.end - span.begin) / span.units);
    }
    last = &span;
  }
  if (last != nullptr) {
    add(Describe(last->label.kind), "the end", Microseconds(spans.back().end - last->end));
  }
}

void PrintAlone(std::vector<Alone> alone, size_t frames, int most, const std::string& what) {
  for (Alone& stretch : alone) stretch.us.resize(frames, 0);
  std::ranges::sort(alone, std::greater(),
                    [](const Alone& stretch) { return cli::Median(stretch.us); });
  cli::TextTable table = cli::TableOf({what + ": alone after", "before", "times", "us"});
  for (const Alone& stretch : std::span(alone).first(std::min<size_t>(alone.size(), most))) {
    table.rows.push_back({stretch.after, stretch.before, fmt::format("{}", stretch.times),
                          fmt::format("{:.1f}", cli::Median(stretch.us))});
  }
  fmt::print("{}\n", table.ToMarkdown());
}

/// A world that Cairn drives.
class World {
 public:
  World(const SceneChoice& scene, Work work, int threads, Executor* executor)
      : solver_(SettingsFor(work, threads)), run_(scene, &solver_) {
    solver_.settings().executor = executor;
    run_.world().solver_info().m_numIterations = kIterations;
  }
  void Record() { solver_.settings().tuning.spans = &spans_; }
  /// @return what the solver took [us]
  double Step() {
    spans_.Clear();
    run_.Step();
    const bullet::SubstepTimes times = solver_.times();
    return Microseconds(times.build + times.solve + times.write);
  }
  std::span<const Span> spans() const { return spans_.spans(0); }

 private:
  SpanRecorder spans_{1, kMostSpans};
  bullet::ConstraintSolver solver_;
  cli::SceneRun run_;
};

double MedianOf(const std::vector<Forecast>& forecasts, double (*value)(const Forecast&)) {
  std::vector<double> values;
  for (const Forecast& forecast : forecasts) values.push_back(value(forecast));
  return cli::Median(values);
}

/// Medians of a kind that anybody would notice.
std::string SerialParts(const std::vector<Forecast>& forecasts) {
  std::string parts;
  for (size_t k = 0; k < kSpanKinds; ++k) {
    std::vector<double> values;
    for (const Forecast& forecast : forecasts) values.push_back(forecast.serial_of[k]);
    const double us = cli::Median(values);
    if (us < 20) continue;
    if (!parts.empty()) parts += ", ";
    parts += fmt::format("{} {:.2f}", Describe(static_cast<SpanKind>(k)), us / 1000);
  }
  return parts.empty() ? "-" : parts;
}

}  // namespace

void PrintScaling(const ThreadOptions& options, const std::string& command) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const Barriers barriers(options.threads, cores);
  fmt::print("{}",
             cli::Origin(fmt::format("Scaling: what substeps of {} would take on so many threads",
                                     Describe(options.work)),
                         cli::DescribeContext(command)));
  fmt::print(
      "- {} frames, medians, ms. One thread does what is cut for so many, and spans say what "
      "others could have done:\n"
      "  serial: nobody could; shared: the rest, evenly; imbalance: what rounds of whole units "
      "add; barriers: a stage\n"
      "  of little work, measured here: {} threads; beyond, taken to grow with the logarithm of "
      "their number\n"
      "- not in it: caches and memory that cores share, and cores that slow each other down\n"
      "- measured: as many threads, where there are as many cores ({})\n\n",
      options.window.frames, barriers.Describe(), cores);
  cli::TextTable table =
      cli::TableOf({"scene", "threads", "serial", "shared", "imbalance", "barriers", "predicted",
                    "measured", "ratio to one", "serial by part"});
  for (const SceneChoice& scene : options.window.scenes) {
    const int first = scene.FirstFrame(options.window.frame);
    double one = 0;
    for (const int threads : options.threads) {
      Nobody nobody;
      const bool can = threads <= cores;
      World cut(scene, options.work, threads, &nobody);
      World real(scene, options.work, can ? threads : 1, nullptr);
      std::vector<Forecast> forecasts;
      std::vector<double> measured;
      const bool with_gaps = options.gaps > 0 && threads == options.threads.back();
      std::vector<Alone> alone;
      for (int frame = 0; frame < first + options.window.frames; ++frame) {
        if (frame == first) cut.Record();
        const double whole = cut.Step(), took = can ? real.Step() : 0;
        if (frame < first) continue;
        if (with_gaps) AddAlone(cut.spans(), forecasts.size(), threads, &alone);
        forecasts.push_back(Predict(cut.spans(), whole, threads, barriers(threads)));
        measured.push_back(took);
      }
      const double predicted =
          MedianOf(forecasts, [](const Forecast& forecast) { return forecast.all(); });
      if (one == 0) one = predicted * (threads == 1 ? 1 : std::numeric_limits<double>::quiet_NaN());
      const auto median = [&](double (*value)(const Forecast&)) {
        return cli::FormatTime(1e-3 * MedianOf(forecasts, value));
      };
      table.rows.push_back({NameOf(scene), fmt::format("{}", threads),
                            median([](const Forecast& forecast) { return forecast.serial; }),
                            median([](const Forecast& forecast) { return forecast.shared; }),
                            median([](const Forecast& forecast) { return forecast.imbalance; }),
                            median([](const Forecast& forecast) { return forecast.barriers; }),
                            cli::FormatTime(1e-3 * predicted),
                            can ? cli::FormatTime(1e-3 * cli::Median(measured)) : "-",
                            std::isnan(one) ? "-" : fmt::format("{:.2f}", one / predicted),
                            SerialParts(forecasts)});
      if (with_gaps) PrintAlone(alone, forecasts.size(), options.gaps, NameOf(scene));
    }
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
