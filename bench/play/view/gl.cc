// SPDX-License-Identifier: MIT
#include "play/view/gl.h"

#include <array>
#include <string>

#include "support/failure.h"

namespace cairn::play {
namespace {

void Attach(GLuint program, GLenum stage, const char* text) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glDeleteShader(shader);
}

}  // namespace

Program::Program(const char* vertex, const char* fragment) : id_(glCreateProgram()) {
  Attach(id_, GL_VERTEX_SHADER, vertex);
  Attach(id_, GL_FRAGMENT_SHADER, fragment);
  glLinkProgram(id_);
  GLint fine = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &fine);
  if (fine != 0) return;
  std::array<char, 1000> log{};
  glGetProgramInfoLog(id_, static_cast<GLsizei>(log.size() - 1), nullptr, log.data());
  throw cli::Failure(cli::kBadInput, std::string("OpenGL refuses a shader: ") + log.data());
}

void Target::Free() {
  glDeleteFramebuffers(1, &frame_);  // 0 is ignored
  glDeleteRenderbuffers(2, buffers_);
  glDeleteTextures(1, &texture_);
}

void Target::MakeColour(int width, int height, int samples) {
  Free();
  width_ = width;
  height_ = height;
  glGenFramebuffers(1, &frame_);
  Bind();
  glGenRenderbuffers(2, buffers_);
  const auto add = [&](GLenum format, GLenum place, GLuint buffer) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, width,
                                     height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  };
  add(GL_RGBA8, GL_COLOR_ATTACHMENT0, buffers_[0]);
  add(GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, buffers_[1]);
}

void Target::MakeShadow(int size) {
  Free();
  width_ = height_ = size;
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
               nullptr);
  for (const auto& [name, value] : {std::pair{GL_TEXTURE_MIN_FILTER, GL_LINEAR},
                                    {GL_TEXTURE_MAG_FILTER, GL_LINEAR},
                                    {GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE},
                                    {GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE},
                                    {GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE}}) {
    glTexParameteri(GL_TEXTURE_2D, static_cast<GLenum>(name), value);
  }
  glGenFramebuffers(1, &frame_);
  Bind();
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
}

}  // namespace cairn::play
