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

/// "50 s left", "3 min left": what is left of work of which a share is done after so many seconds,
/// if the rest goes as fast. Empty where too little is done to tell.
std::string TimeLeft(double seconds, double done);

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
  /// The same with the time left, once that can be told. @param done  share of the work, in [0, 1]
  void Show(const std::string& text, double done);

 private:
  using Clock = std::chrono::steady_clock;

  bool shown_ = false, enabled_;
  Clock::time_point begin_ = Clock::now(), next_ = begin_ + std::chrono::seconds(1);
};

}  // namespace cairn::cli
