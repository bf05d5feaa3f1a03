// SPDX-License-Identifier: MIT
#pragma once

// OpenGL 3.3 core. Its functions are in libOpenGL, which every libglvnd has.
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <utility>

namespace cairn::play {

/// Linked of the two stages. @throws cli::Failure with the driver's message
class Program {
 public:
  Program(const char* vertex, const char* fragment);
  ~Program() { glDeleteProgram(id_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void Use() const { glUseProgram(id_); }
  GLint At(const char* uniform) const { return glGetUniformLocation(id_, uniform); }

 private:
  GLuint id_;
};

/// What is drawn into: colour and depth, or for shadows depth alone as a texture.
class Target {
 public:
  Target() = default;
  ~Target() { Free(); }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  /// @param samples  of each pixel; 1: none
  void MakeColour(int width, int height, int samples);
  void MakeShadow(int size);
  void Bind() const { glBindFramebuffer(GL_FRAMEBUFFER, frame_); }
  GLuint frame() const { return frame_; }
  GLuint texture() const { return texture_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void Free();

  GLuint frame_ = 0, buffers_[2] = {0, 0}, texture_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace cairn::play
