// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "play/session.h"
#include "play/view/renderer.h"

struct ImFont;

namespace cairn::play {

/// What a person asked for in a picture.
struct Requests {
  bool restart = false, step = false, shoot = false, save = false, fit = false;
};

/// What panels show beside the session.
struct Facts {
  double picture_ms = 0, draw_ms = 0;  ///< Means: from picture to picture, and drawing in it.
  std::string message;                 ///< What went wrong, or was saved.
  int lane = -1, body = -1;            ///< Under the mouse; -1: none.
};

/// All windows of Dear ImGui.
class Panels {
 public:
  /// Fonts and colours. @pre a context of Dear ImGui is current
  Panels();

  /// Where worlds are drawn, in pixels from the lower left.
  static std::vector<Area> Areas(const Controls& controls, int width, int height);
  Requests Draw(Session* session, const Facts& facts, int width, int height);

  /// The middle of each button, box and slider by its name, in pixels from the upper left.
  struct Place {
    float x, y;
  };
  const std::map<std::string, Place>& widgets() const { return widgets_; }

 private:
  void DrawSidebar(Session* session, const Facts& facts, int height);
  void DrawScene(Controls* controls);
  void DrawLane(int lane, Controls* controls);
  void DrawPlots(const Session& session, int width, int height);
  void DrawLabel(Session* session, int lane, const Facts& facts, const Area& area, int height);
  bool Button(const char* title, const std::string& name, float width);
  /// The widget of a control.
  void Control(const std::string& name, const char* label);
  void Mark(const std::string& name);

  std::map<std::string, Place> widgets_;
  std::map<std::string, Field> fields_;
  Requests requests_;
  ImFont* large_ = nullptr;
};

}  // namespace cairn::play
