// SPDX-License-Identifier: MIT
#include "play/view/app.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "support/failure.h"
#include "support/output_file.h"

namespace cairn::play {
namespace {

using cli::Failure;
using cli::kBadInput;

btVector3 ToBullet(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

App::App(const AppOptions& options) : options_(options), session_(options.controls) {
  if (!options.commands.empty()) {
    std::ifstream file(options.commands);
    if (!file) throw Failure(kBadInput, fmt::format("cannot read '{}'", options.commands));
    for (std::string line; std::getline(file, line);) commands_.push_back(line);
  }
  if (!options.screenshot.empty()) cli::CheckWritable(options.screenshot);
  if (!options.video.empty()) cli::CheckFolder(options.video);
  OpenWindow();
  renderer_ = std::make_unique<Renderer>();
  panels_ = std::make_unique<Panels>();
  areas_ = Panels::Areas(session_.controls(), options_.width, options_.height);
  camera_.Fit(session_.player(0).world(), areas_[0].aspect());
}

App::~App() {
  renderer_.reset();
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void App::OpenWindow() {
  if (glfwInit() == GLFW_FALSE) {
    throw Failure(kBadInput,
                  "there is no screen to open a window on; 'xvfb-run -a cairn play ...' "
                  "makes one that nobody sees");
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  window_ = glfwCreateWindow(options_.width, options_.height, "Cairn play", nullptr, nullptr);
  if (window_ == nullptr) {
    glfwTerminate();
    throw Failure(kBadInput, "no window with OpenGL 3.3 can be opened here");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(options_.frames > 0 || !options_.commands.empty() ? 0 : 1);
  ImGui::CreateContext();
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

void App::Run() {
  last_picture_ = glfwGetTime();
  while (!done_ && glfwWindowShouldClose(window_) == GLFW_FALSE) {
    glfwPollEvents();
    ReadCommands();
    if (!done_) Picture();
    done_ |= ++picture_ == options_.frames;
  }
  if (!options_.screenshot.empty()) WritePng(options_.screenshot, renderer_->picture());
}

void App::Picture() {
  const double start = glfwGetTime(), passed = start - std::exchange(last_picture_, start);
  glfwGetFramebufferSize(window_, &options_.width, &options_.height);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  TakeInput();
  ImGui::NewFrame();
  areas_ = Panels::Areas(session_.controls(), options_.width, options_.height);
  Hover();
  DragOrTurn();
  const double solver_time = Steps(passed);
  try {
    Requests requests = panels_->Draw(&session_, facts_, options_.width, options_.height);
    AddKeys(&requests);
    Obey(requests);
  } catch (const Failure& failure) {
    facts_.message = failure.what();  // no such scene, size or file
  }
  ImGui::Render();

  const double begin = glfwGetTime();
  DrawWorlds();
  Show();
  const double end = glfwGetTime();
  glfwSwapBuffers(window_);  // waits for the screen, which costs nothing
  facts_.draw_ms += 0.1 * (1000 * (end - begin) - facts_.draw_ms);
  facts_.picture_ms += 0.1 * (1000 * passed - facts_.picture_ms);
  loop_.Learn(end - start - solver_time);
}

void App::TakeInput() {
  if (options_.frames == 0 && options_.commands.empty()) return;  // there is a person
  ImGuiIO& io = ImGui::GetIO();
  const Mouse mouse = mouse_.front();
  if (mouse_.size() > 1) mouse_.pop_front();
  io.MousePos = {mouse.x, mouse.y};
  for (int button = 0; button < 3; ++button) io.MouseDown[button] = mouse.button == button;
  io.MouseWheel = std::exchange(wheel_, 0);
  std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
  if (key_ > 0) io.KeysDown[std::exchange(key_, 0)] = true;
}

void App::AddKeys(Requests* requests) {
  if (ImGui::GetIO().WantCaptureKeyboard) return;
  Controls& controls = session_.controls();
  controls.paused ^= ImGui::IsKeyPressed(' ', false);
  controls.panels ^= ImGui::IsKeyPressed('P', false);
  for (const Request& request : kRequests) {
    if (ImGui::IsKeyPressed(request.key, false)) requests->insert(request.name);
  }
}

int App::SideUnderMouse() const {
  const ImGuiIO& io = ImGui::GetIO();
  const float y = static_cast<float>(options_.height) - io.MousePos.y;
  for (int side = 0; side < session_.worlds() && !io.WantCaptureMouse; ++side) {
    const Area& area = areas_[std::min<size_t>(side, areas_.size() - 1)];
    if (io.MousePos.x >= area.x && io.MousePos.x < area.x + area.width && y >= area.y &&
        y < area.y + area.height) {
      return side;
    }
  }
  return -1;
}

btVector3 App::RayUnderMouse(int side) const {
  const Area& area = areas_[side];
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float x = (mouse.x - area.x) / area.width;
  const float y = (options_.height - mouse.y - area.y) / area.height;
  return ToBullet(camera_.Ray(2 * x - 1, 2 * y - 1, area.aspect()));
}

void App::Hover() {
  facts_.body = -1;
  facts_.side = SideUnderMouse();
  if (facts_.side < 0) return;
  const btVector3 eye = ToBullet(camera_.eye());
  btVector3 at;
  facts_.body =
      session_.player(facts_.side).Pick(eye, eye + 1000 * RayUnderMouse(facts_.side), &at);
  if (facts_.body < 0) {
    facts_.side = -1;
  } else if (ImGui::IsMouseClicked(0) && !session_.player(facts_.side).played().recorded()) {
    session_.Grab(facts_.body, at);
    grip_ = static_cast<float>((at - eye).length());
  }
}

void App::DragOrTurn() {
  const ImGuiIO& io = ImGui::GetIO();
  if (grip_ && !io.MouseDown[0]) {
    session_.Release();
    grip_.reset();
  }
  const int side = SideUnderMouse();
  if (side < 0) return;
  if (grip_) {
    session_.Move(ToBullet(camera_.eye()) + *grip_ * RayUnderMouse(side));
  } else if (io.MouseDown[0] || io.MouseDown[1]) {
    camera_.Orbit(io.MouseDelta.x, io.MouseDelta.y);
  } else if (io.MouseDown[2]) {
    camera_.Pan(io.MouseDelta.x, io.MouseDelta.y, static_cast<float>(areas_[side].height));
  }
  camera_.Zoom(io.MouseWheel);
}

void App::Obey(const Requests& requests) {
  const bool again = requests.contains("restart"), another = again && session_.Restart();
  if (again) facts_.message.clear();
  session_.Apply();
  if (another || requests.contains("view"))
    camera_.Fit(session_.player(0).world(), areas_[0].aspect());
  if (requests.contains("shoot")) {
    const int side = SideUnderMouse();
    const btVector3 eye = ToBullet(camera_.eye());
    session_.Shoot(eye, side < 0 ? ToBullet(camera_.target) - eye : RayUnderMouse(side));
  }
  const bool save = requests.contains("save");
  if (save) session_.Save(fmt::format("frame-{:06}.cairn", session_.frame()));
  if (save || requests.contains("step")) session_.Step();
  if (save) facts_.message = session_.player(session_.worlds() - 1).saved();
}

double App::Steps(double passed) {
  const Controls& controls = session_.controls();
  const bool by_itself =
      options_.frames > 0 || (!options_.commands.empty() && last_picture_ > live_);
  const double step = 1 / controls.rate;
  const examples::FixedSteps::Plan plan = loop_.Advance(
      by_itself ? step : passed, {.step = step, .speed = controls.paused ? 0 : controls.speed},
      session_.worlds());
  session_.SetRest(plan.budget);
  share_ = controls.interpolate && !by_itself && !controls.paused ? plan.share : 1;
  double solver_time = 0;
  for (int i = 0; i < plan.steps; ++i) {
    session_.Step();
    for (int side = 0; side < session_.worlds(); ++side) {
      const auto& history = session_.player(side).history();
      if (!history.empty()) solver_time += 1e-3 * history.back().solver_ms;
    }
  }
  return solver_time;
}

void App::DrawWorlds() {
  const Controls& controls = session_.controls();
  if (std::exchange(built_, session_.built()) != session_.built()) renderer_->Forget();
  renderer_->Begin(options_.width, options_.height, controls.smooth ? 4 : 1);
  areas_ = Panels::Areas(controls, options_.width, options_.height);
  for (int side = 0; side < session_.worlds(); ++side) {
    renderer_->Draw(session_.player(side), camera_,
                    {controls.colours, controls.shadows, controls.contacts, controls.joints,
                     btScalar(share_), facts_.body},
                    areas_[side]);
  }
}

void App::Show() {
  const Target& picture = renderer_->Resolve();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (!options_.video.empty()) {
    WritePng(fmt::format("{}/{:06}.png", options_.video, picture_), picture);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.frame());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, 0, picture.width(),
                    picture.height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glFinish();
}

}  // namespace cairn::play
