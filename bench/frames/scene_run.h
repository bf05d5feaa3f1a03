// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "measure/contact_frame.h"
#include "measure/row_recorder.h"
#include "scenes/scene.h"
#include "scenes/world.h"

namespace cairn::frames {

struct SceneChoice {
  std::string name;
  int size = 0;    ///< 0: the scene's default.
  int frame = -1;  ///< The first that is looked at; -1: that of the options.

  int FirstFrame(int of_options) const { return frame >= 0 ? frame : of_options; }
};

/// "castle", "pyramid:100" (its size) or "rubble@240" (its first frame).
/// @throws std::invalid_argument if it is none of these, or there is no such scene.
SceneChoice ParseScene(const std::string& text);

/// A scene under Bullet's own solver, and what that solver was asked in each frame: all islands as
/// one problem, impulses as the warm start left them, as the adapter sees it.
class SceneRun {
 public:
  explicit SceneRun(const SceneChoice& choice);
  ~SceneRun();

  void Skip(int frames);
  /// Makes one more step.
  bench::ContactFrame Next();

 private:
  void Step();

  std::unique_ptr<bench::RowRecorder> recorder_;
  std::unique_ptr<bench::World> world_;
  std::unique_ptr<bench::Scene> scene_;
  int frame_ = 0;
};

/// Body pairs, each with its number of rows, that only one of the frames has. Bodies are told apart
/// by Body::id.
int ChangedPairs(const bench::ContactFrame& a, const bench::ContactFrame& b);

}  // namespace cairn::frames
