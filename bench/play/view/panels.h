// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "play/session.h"
#include "play/view/renderer.h"

struct ImFont;

namespace cairn::play {

/// What a button, a key or a command asks for.
struct Request {
  const char *name, *title;
  int key;
};
inline constexpr Request kRequests[] = {{"restart", "Restart", 'R'},
                                        {"step", "Step", 'N'},
                                        {"shoot", "Shoot", 'B'},
                                        {"save", "Save", 'S'},
                                        {"view", "View", 'V'}};
using Requests = std::set<std::string_view>;  ///< By name.

/// What panels show beside the session.
struct Facts {
  double picture_ms = 0, draw_ms = 0;  ///< Means: from picture to picture, and drawing in it.
  std::string message;                 ///< What went wrong, or was saved.
  int side = -1, body = -1;            ///< Under the mouse; -1: none.
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
  void DrawSide(int side, Controls* controls);
  void DrawPlots(const Session& session, int width, int height);
  void DrawLabel(Session* session, int side, const Facts& facts, const Area& area, int height);
  bool Button(const char* title, const std::string& name, float width);
  /// The widget of a control, which has its name.
  void Control(const std::string& name, const char* unit = "");
  void Mark(const std::string& name);

  std::map<std::string, Place> widgets_;
  std::map<std::string, Field> fields_;
  Requests requests_;
  ImFont* large_ = nullptr;
};

}  // namespace cairn::play
