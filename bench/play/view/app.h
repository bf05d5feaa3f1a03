// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "examples/fixed_steps.h"
#include "play/view/panels.h"

struct GLFWwindow;

namespace cairn::play {

/// What `cairn play` was asked for.
struct AppOptions {
  Controls controls;
  int width = 1440, height = 810;
  int frames = 0;  ///< Ends after so many pictures, a step in each; 0: goes on.
  std::string screenshot, video, commands;
};

/// The window: pictures, mouse and keys, and a file of commands in place of a person.
class App {
 public:
  /// @throws cli::Failure if there is no screen or no OpenGL 3.3, or a file cannot be read
  explicit App(const AppOptions& options);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  void Run();

 private:
  struct Mouse {
    float x = -1, y = -1;
    int button = -1;  ///< That is down: 0 left, 1 right, 2 middle.
  };

  void OpenWindow();
  void Picture();
  void TakeInput();
  void AddKeys(Requests* requests);
  void DragOrTurn();
  void Hover();
  void Obey(const Requests& requests);
  /// @return what solvers took [s]
  double Steps(double passed);
  void DrawWorlds();
  void Show();
  void ReadCommands();
  /// One line of the file. @throws cli::Failure
  void Command(const std::string& line);
  std::string State();

  /// From the eye through the mouse, in the world that it is over; -1: in none.
  int SideUnderMouse() const;
  btVector3 RayUnderMouse(int side) const;

  AppOptions options_;
  Session session_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Panels> panels_;
  Camera camera_;
  examples::FixedSteps loop_;
  Facts facts_;
  std::vector<Area> areas_;
  std::deque<std::string> commands_;
  std::deque<Mouse> mouse_ = {{}};  ///< Of commands: one for each picture, the last one stays.
  float wheel_ = 0;                 ///< Of commands, in the next picture; and a key, as GLFW's.
  int key_ = 0;
  int waiting_ = 0;  ///< Pictures until the next command.
  int picture_ = 0, built_ = 0;
  double share_ = 1, last_picture_ = 0;
  double live_ = 0;            ///< Until then steps go by the clock, whatever the commands [s].
  std::optional<float> grip_;  ///< How far away a dragged body is [m].
  bool done_ = false;
};

}  // namespace cairn::play
