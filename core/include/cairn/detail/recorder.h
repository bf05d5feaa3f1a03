// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cairn/detail/recording.h"
#include "cairn/report.h"

namespace cairn {

/// Frames that are to be recorded.
class FrameChoice {
 public:
  /// All.
  FrameChoice() = default;
  /// "40,90" or "40-49,90": numbers and ranges, with commas between. False, and no frame at all, if
  /// it is none of that.
  bool Parse(std::string_view text);

  bool Contains(std::int64_t frame) const;
  /// The last one; -1 if there is none, the largest number if they are all.
  std::int64_t last() const;

 private:
  bool all_ = true;
  std::vector<std::pair<std::int64_t, std::int64_t>> ranges_;  ///< first and last
};

/// What a Recorder did.
struct RecordedFiles {
  int written = 0;
  int failed = 0;
  std::string last_file;     ///< Path of the last one written.
  std::string last_failure;  ///< One sentence; empty if none failed.
};

/// Writes problems of a running game to files, one for each frame. A file that cannot be written is
/// counted; nothing else comes of it. For those who call Solver::Solve(), in a frame:
///
///     const bool recording = recorder.Begin(problem, impulses);
///     solver.Solve(problem, impulses, velocities, &report);
///     if (recording) recorder.End(solver.settings(), report);
///     recorder.NextFrame();
class Recorder {
 public:
  /// Records nothing until it is asked to.
  /// @param source  see Recording::source
  explicit Recorder(std::string source) { recording_.source = std::move(source); }

  /// Obeys CAIRN_RECORD, a folder, and CAIRN_RECORD_FRAMES, a FrameChoice (all frames if it is not
  /// set). nullptr if CAIRN_RECORD is not set.
  static std::unique_ptr<Recorder> FromEnvironment(std::string source);

  /// Files become FOLDER/world-N/frame-000040.cairn, N being the first that is not there yet: games
  /// with several worlds, and games that are played again, overwrite nothing.
  void RecordTo(std::string folder, FrameChoice frames);
  /// Writes the next frame to this file.
  /// @param frame  see Recording::frame
  void RecordNext(std::string path, std::int64_t frame = -1);

  /// Copies the problem and its start, if this frame is wanted.
  bool Begin(const ContactProblem& problem, const Impulses& start);
  /// Writes the file. @pre Begin() answered true in this frame
  void End(const Settings& settings, const Report& report);
  void NextFrame();

  const RecordedFiles& files() const { return files_; }

 private:
  void Write(const Settings& settings, const Report& report);
  void Fail(std::string why);
  /// Makes the folder of this world. Empty if that cannot be done.
  std::string OwnFolder();

  std::string folder_, own_folder_, next_path_;
  FrameChoice frames_;
  bool in_folder_ = false;  ///< RecordTo() was called, and nothing went wrong with the folder.
  std::int64_t frame_ = 0, next_frame_ = -1;
  Recording recording_;
  RecordedFiles files_;
};

}  // namespace cairn
