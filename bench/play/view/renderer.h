// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "animation/shape_mesh.h"
#include "examples/debug_draw.h"
#include "play/player.h"
#include "play/view/camera.h"
#include "play/view/gl.h"

namespace cairn::play {

/// A part of the picture in pixels, from the lower left corner.
struct Area {
  int x = 0, y = 0, width = 1, height = 1;
  float aspect() const { return static_cast<float>(width) / static_cast<float>(height); }
};

/// How a world is to look.
struct Look {
  std::string_view colours = "stone";  ///< As Controls::colours.
  bool shadows = true, contacts = false, joints = false;
  btScalar share = 1;  ///< See Player::Pose().
  int marked = -1;     ///< A dynamic body that stands out; -1: none.
};

/// Draws worlds into a target of its own: one draw call for all bodies of a shape.
class Renderer : private examples::DebugDraw {
 public:
  /// @pre an OpenGL 3.3 context is current, and stays so
  Renderer();
  ~Renderer();

  /// Begins a picture of that size, with so many samples a pixel.
  void Begin(int width, int height, int samples);
  void Draw(const Player& player, const Camera& camera, const Look& look, const Area& area);
  /// The picture, without several samples a pixel: panels go on top.
  const Target& Resolve();
  const Target& picture() const { return picture_; }
  /// When worlds are gone: shapes are known by their address.
  void Forget();

  int bodies_drawn() const { return bodies_drawn_; }
  int calls() const { return calls_; }

 private:
  /// How a surface is painted, in Instance::colour[3].
  enum Surface { kPlain, kBox, kBall, kGround };
  struct Instance {
    float rows[12], scale[4], colour[4];
  };
  struct GpuMesh;
  struct LineVertex {
    float position[3], colour[3];
  };

  static LineVertex Corner(const Point& at, unsigned colour);
  void Line(const Point& from, const Point& to, unsigned colour) override {
    lines_.insert(lines_.end(), {Corner(from, colour), Corner(to, colour)});
  }
  void Dot(const Point& at, unsigned colour) override { dots_.push_back(Corner(at, colour)); }

  void Collect(const Player& player, const Look& look);
  void AddShape(const btCollisionShape& shape, const btTransform& pose, const float* colour);
  void DrawBodies();
  void DrawShadows(const Eigen::Matrix4f& light);
  void DrawLines(const Eigen::Matrix4f& camera);

  Program body_, depth_, sky_, line_;
  Target samples_, picture_, shadow_;
  std::unique_ptr<GpuMesh> box_, ball_;
  std::unordered_map<const btCollisionShape*, std::unique_ptr<GpuMesh>> own_;
  std::map<GpuMesh*, std::vector<Instance>> instances_;
  std::vector<LineVertex> lines_, dots_;
  int smooth_ = 0;
  GLuint line_array_ = 0, line_buffer_ = 0;
  int bodies_drawn_ = 0, calls_ = 0;
};

/// Writes the pixels of a target as PNG. @throws cli::Failure (kBadInput) with the path
void WritePng(const std::string& path, const Target& target);

}  // namespace cairn::play
