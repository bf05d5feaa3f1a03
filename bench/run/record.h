// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "cairn/detail/recorder.h"
#include "run/options.h"

namespace cairn::cli {

/// What `cairn record` was asked for, checked.
struct RecordOptions {
  RunOptions run;  ///< With one solver, which makes the frames.
  FrameChoice frames;
  std::string folder;
};

/// A file that was written.
struct RecordedFrame {
  std::string path;
  int bodies = 0, joint_rows = 0, points = 0;
  std::size_t bytes = 0;
};

/// @throws Failure (kBadInput) that names a file of these that is there already
void RefuseToOverwrite(const RecordOptions& options);

/// Plays the scenes and writes the frames asked for, FOLDER/SCENE-000040.cairn: the problem and
/// the start that the solver had; of a solver of Bullet's, those it would have had in the adapter.
/// @throws Failure if a file cannot be written, or the solver failed before the last frame
std::vector<RecordedFrame> RecordScenes(const RecordOptions& options);

}  // namespace cairn::cli
