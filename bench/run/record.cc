// SPDX-License-Identifier: MIT
#include "run/record.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "run/solver_run.h"
#include "support/failure.h"
#include "support/progress.h"

namespace cairn::cli {
namespace {

RecordedFrame Look(const std::string& path) {
  Recording recording;
  if (const RecordingStatus status = Load(path, &recording); !status.ok()) {
    throw Failure(kBadInput, fmt::format("'{}': {}", path, status.message));
  }
  return {.path = path,
          .bodies = static_cast<int>(recording.bodies.size()),
          .joint_rows = static_cast<int>(recording.rows.size() + recording.joint_rows.size()),
          .points = static_cast<int>(recording.points.size()),
          .bytes = std::filesystem::file_size(path)};
}

std::string PathOf(const RecordOptions& options, const SceneChoice& scene, int frame) {
  return fmt::format("{}/{}-{:06}.cairn", options.folder, scene.info->name, frame);
}

/// A scene whose frames are written.
class RecordedScene {
 public:
  RecordedScene(const SceneChoice& scene, const RecordOptions& options)
      : options_(options), scene_(scene), run_(scene, options.run.solvers.front(), options.run) {}

  void Step(int frame) {
    const bool wanted = options_.frames.Contains(frame);
    const std::string path = PathOf(options_, scene_, frame);
    if (wanted) run_.RecordNext(path, frame);
    run_.Step(SolverRun::Observing::kOff);
    if (wanted) Check(frame, path);
    if (!run_.failed()) return;
    throw Failure(kCheckFailed, fmt::format("{}: {} failed in frame {}: {}", scene_.info->name,
                                            run_.label(), frame, run_.failure()));
  }
  std::vector<RecordedFrame> TakeFrames() { return std::move(frames_); }

 private:
  void Check(int frame, const std::string& path) {
    const std::string fault = run_.TakeRecording();
    if (fault.starts_with("cannot")) throw Failure(kBadInput, fault);
    if (!fault.empty()) {
      throw Failure(kBadInput, fmt::format("{}: {} in frame {}", scene_.info->name, fault, frame));
    }
    frames_.push_back(Look(path));
  }

  const RecordOptions& options_;
  SceneChoice scene_;
  SolverRun run_;
  std::vector<RecordedFrame> frames_;
};

}  // namespace

void RefuseToOverwrite(const RecordOptions& options) {
  for (const SceneChoice& scene : options.run.scenes) {
    for (int frame = 0; frame < options.run.frames; ++frame) {
      const std::string path = PathOf(options, scene, frame);
      if (!options.frames.Contains(frame) || !std::filesystem::exists(path)) continue;
      throw Failure(kBadInput, fmt::format("'{}' is there already: --force writes over it", path));
    }
  }
}

std::vector<RecordedFrame> RecordScenes(const RecordOptions& options) {
  std::vector<RecordedFrame> all;
  Progress progress(options.run.progress);
  double scenes_done = 0;
  for (const SceneChoice& choice : options.run.scenes) {
    RecordedScene scene(choice, options);
    for (int frame = 0; frame < options.run.frames; ++frame) {
      progress.Show(fmt::format("{}: frame {} of {}", choice.info->name, frame, options.run.frames),
                    (scenes_done + 1.0 * frame / options.run.frames) /
                        static_cast<double>(options.run.scenes.size()));
      scene.Step(frame);
    }
    ++scenes_done;
    for (RecordedFrame& frame : scene.TakeFrames()) all.push_back(std::move(frame));
  }
  return all;
}

}  // namespace cairn::cli
