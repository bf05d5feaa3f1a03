// SPDX-License-Identifier: MIT
#include "support/progress.h"

#include <unistd.h>

#include <fmt/format.h>

#include <cstdio>

namespace cairn::cli {

std::string TimeLeft(double seconds, double done) {
  constexpr double kLeastDone = 0.02;
  if (!(done >= kLeastDone)) return "";
  const double left = seconds * (1 - done) / done;
  if (left < 90) return fmt::format("{:.0f} s left", left);
  return fmt::format("{:.0f} min left", left / 60);
}

Progress::Progress(ProgressMode mode)
    : enabled_(mode == ProgressMode::kAlways ||
               (mode == ProgressMode::kAuto && isatty(STDERR_FILENO) != 0)) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::Show(const std::string& text, double done) {
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  const std::string left = TimeLeft(seconds, done);
  Show(left.empty() ? text : fmt::format("{}, {}", text, left));
}

void Progress::Show(const std::string& text) {
  if (!enabled_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  std::fprintf(stderr, "\r%s\033[K", text.c_str());
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace cairn::cli
