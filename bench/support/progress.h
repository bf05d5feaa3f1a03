// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace cairn::cli {

enum class ProgressMode {
  kAuto,  ///< Only if stderr is a terminal.
  kAlways,
  kNever,
};

/// One line on stderr that is written over and over, and wiped at the end. Work that is done within
/// a second never shows it.
class Progress {
 public:
  explicit Progress(ProgressMode mode);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows `text`, at most ten times a second.
  void Show(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  bool shown_ = false, enabled_;
  Clock::time_point next_ = Clock::now() + std::chrono::seconds(1);
};

}  // namespace cairn::cli
