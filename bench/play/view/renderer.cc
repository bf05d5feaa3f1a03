// SPDX-License-Identifier: MIT
#include "play/view/renderer.h"

#include <stb_image_write.h>

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "play/view/shaders.h"
#include "support/failure.h"

namespace cairn::play {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;

constexpr int kShadowSize = 2048;
const Vector3f kSun = Vector3f(-0.50f, 0.72f, 0.52f).normalized();
const Vector3f kHorizon(0.60f, 0.70f, 0.79f), kZenith(0.13f, 0.29f, 0.55f);

using Colour = std::array<float, 3>;
constexpr std::array<Colour, 4> kStones = {
    {{0.52f, 0.33f, 0.17f}, {0.44f, 0.26f, 0.13f}, {0.58f, 0.40f, 0.22f}, {0.48f, 0.31f, 0.19f}}};
constexpr Colour kStatic = {0.20f, 0.24f, 0.20f}, kAsleep = {0.08f, 0.15f, 0.38f},
                 kMarked = {0.95f, 0.62f, 0.10f};

Colour FromHue(float hue) {
  const auto wave = [hue](float shift) {
    return 0.40f + 0.27f * std::cos(6.2832f * (hue - shift));
  };
  return {wave(0), wave(0.33f), wave(0.67f)};
}

Colour ColourOf(const btRigidBody& body, int index, const Look& look) {
  if (index == look.marked) return kMarked;
  if (!body.isActive()) return kAsleep;
  if (look.colours == "islands") {
    return FromHue(std::fmod(0.618034f * static_cast<float>(body.getIslandTag()), 1.0f));
  }
  return kStones[(static_cast<unsigned>(index) * 2654435761u >> 16) % kStones.size()];
}

void SetMatrix(GLint place, const Matrix4f& matrix) {
  glUniformMatrix4fv(place, 1, GL_FALSE, matrix.data());
}

}  // namespace

/// A mesh in the GPU's memory, with a buffer for its instances.
struct Renderer::GpuMesh {
  explicit GpuMesh(const std::vector<cli::Vertex>& mesh)
      : vertices(static_cast<GLsizei>(mesh.size())) {
    glGenVertexArrays(1, &array);
    glGenBuffers(2, buffers);
    glBindVertexArray(array);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.size() * sizeof(cli::Vertex)),
                 mesh.data(), GL_STATIC_DRAW);
    const auto attribute = [](GLuint place, GLint floats, size_t stride, size_t at) {
      glEnableVertexAttribArray(place);
      glVertexAttribPointer(place, floats, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                            reinterpret_cast<const void*>(at));
    };
    attribute(0, 3, sizeof(cli::Vertex), offsetof(cli::Vertex, position));
    attribute(1, 3, sizeof(cli::Vertex), offsetof(cli::Vertex, normal));
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    for (GLuint i = 0; i < 5; ++i) {  // three rows, scale, colour
      attribute(2 + i, 4, sizeof(Instance), i * 4 * sizeof(float));
      glVertexAttribDivisor(2 + i, 1);
    }
  }
  ~GpuMesh() {
    glDeleteVertexArrays(1, &array);
    glDeleteBuffers(2, buffers);
  }
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  GLuint array = 0, buffers[2] = {0, 0};
  GLsizei vertices;
};

Renderer::Renderer()
    : body_(kBodyVertex, kBodyFragment),
      depth_(kBodyVertex, kDepthFragment),
      sky_(kSkyVertex, kSkyFragment),
      line_(kLineVertex, kLineFragment),
      box_(std::make_unique<GpuMesh>(cli::MeshOf(btBoxShape({1, 1, 1})))),
      ball_(std::make_unique<GpuMesh>(cli::MeshOf(btSphereShape(1)))) {
  shadow_.MakeShadow(kShadowSize);
  glGenVertexArrays(1, &line_array_);
  glGenBuffers(1, &line_buffer_);
  glBindVertexArray(line_array_);
  glBindBuffer(GL_ARRAY_BUFFER, line_buffer_);
  for (GLuint i = 0; i < 2; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(LineVertex),
                          reinterpret_cast<const void*>(i * 3 * sizeof(float)));
  }
}

Renderer::~Renderer() {
  glDeleteVertexArrays(1, &line_array_);
  glDeleteBuffers(1, &line_buffer_);
}

void Renderer::Forget() { own_.clear(); }

void Renderer::Begin(int width, int height, int samples) {
  if (picture_.width() != width || picture_.height() != height || smooth_ != samples) {
    smooth_ = samples;
    samples_.MakeColour(width, height, samples);
    picture_.MakeColour(width, height, 1);
  }
  samples_.Bind();
  glDisable(GL_SCISSOR_TEST);
  glViewport(0, 0, width, height);
  glClearColor(0.1f, 0.11f, 0.12f, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  bodies_drawn_ = calls_ = 0;
}

void Renderer::Draw(const Player& player, const Camera& camera, const Look& look,
                    const Area& area) {
  Collect(player, look);
  const Matrix4f matrix = camera.Matrix(area.aspect());
  const Matrix4f light = LightMatrix(kSun, camera.target, 1.6f * camera.scale());
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  if (look.shadows) DrawShadows(light);

  samples_.Bind();
  glViewport(area.x, area.y, area.width, area.height);
  glScissor(area.x, area.y, area.width, area.height);
  glEnable(GL_SCISSOR_TEST);
  body_.Use();
  SetMatrix(body_.At("camera"), matrix);
  SetMatrix(body_.At("light"), light);
  const Vector3f eye = camera.eye();
  glUniform3fv(body_.At("eye"), 1, eye.data());
  glUniform3fv(body_.At("sun"), 1, kSun.data());
  glUniform3fv(body_.At("horizon"), 1, kHorizon.data());
  glUniform1f(body_.At("haze"), 1 / (2.5f * camera.distance + 20));
  glUniform1i(body_.At("shadows"), look.shadows ? 1 : 0);
  glUniform1i(body_.At("shadow"), 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shadow_.texture());
  DrawBodies();
  sky_.Use();
  SetMatrix(sky_.At("from_camera"), matrix.inverse());
  glUniform3fv(sky_.At("horizon"), 1, kHorizon.data());
  glUniform3fv(sky_.At("zenith"), 1, kZenith.data());
  glDisable(GL_CULL_FACE);
  glBindVertexArray(line_array_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  if (look.contacts) DrawContacts(*player.world().bullet(), player.world().time_step(), this);
  if (look.joints) DrawJoints(*player.world().bullet(), this);
  DrawLines(matrix);
  glDisable(GL_SCISSOR_TEST);
}

void Renderer::Collect(const Player& player, const Look& look) {
  instances_.clear();
  std::unordered_map<const btCollisionObject*, int> index;
  const auto bodies = player.world().dynamic_bodies();
  for (size_t i = 0; i < bodies.size(); ++i) index[bodies[i]] = static_cast<int>(i);
  const btCollisionObjectArray& objects = player.world().bullet()->getCollisionObjectArray();
  for (int i = objects.size() - 1; i >= 0; --i) {  // the ground, which is added first, last
    const btRigidBody* const body = btRigidBody::upcast(objects[i]);
    if (body == nullptr) continue;
    const auto found = index.find(body);
    const bool moves = found != index.end();
    const Colour paint = moves ? ColourOf(*body, found->second, look) : kStatic;
    const float colour[4] = {paint[0], paint[1], paint[2], moves ? 0.0f : float(kGround)};
    AddShape(*body->getCollisionShape(), player.Pose(*body, look.share), colour);
    ++bodies_drawn_;
  }
}

void Renderer::AddShape(const btCollisionShape& shape, const btTransform& pose,
                        const float* colour) {
  if (shape.isCompound()) {
    const auto& parts = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < parts.getNumChildShapes(); ++i) {
      AddShape(*parts.getChildShape(i), pose * parts.getChildTransform(i), colour);
    }
    return;
  }
  GpuMesh* mesh = nullptr;
  btVector3 scale(1, 1, 1);
  float surface = kPlain;
  if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) {
    mesh = box_.get();
    scale = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
    surface = kBox;
  } else if (shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE) {
    mesh = ball_.get();
    scale *= static_cast<const btSphereShape&>(shape).getRadius();
    surface = kBall;
  }
  if (mesh == nullptr) {
    std::unique_ptr<GpuMesh>& own = own_[&shape];
    if (!own) own = std::make_unique<GpuMesh>(cli::MeshOf(shape));
    mesh = own.get();
  }
  Instance& instance = instances_[mesh].emplace_back();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      instance.rows[4 * row + column] = static_cast<float>(pose.getBasis()[row][column]);
    }
    instance.rows[4 * row + 3] = static_cast<float>(pose.getOrigin()[row]);
    instance.scale[row] = static_cast<float>(scale[row]);
  }
  instance.scale[3] = 1;
  std::copy_n(colour, 3, instance.colour);
  instance.colour[3] = colour[3] == float(kGround) ? float(kGround) : surface;
}

void Renderer::DrawBodies() {
  for (const auto& [mesh, instances] : instances_) {
    (mesh == box_.get() ? glEnable : glDisable)(GL_CULL_FACE);
    glBindVertexArray(mesh->array);
    glBindBuffer(GL_ARRAY_BUFFER, mesh->buffers[1]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(Instance)),
                 instances.data(), GL_STREAM_DRAW);
    glDrawArraysInstanced(GL_TRIANGLES, 0, mesh->vertices, static_cast<GLsizei>(instances.size()));
    ++calls_;
  }
}

void Renderer::DrawShadows(const Matrix4f& light) {
  shadow_.Bind();
  glDisable(GL_SCISSOR_TEST);
  glViewport(0, 0, kShadowSize, kShadowSize);
  glClear(GL_DEPTH_BUFFER_BIT);
  depth_.Use();
  SetMatrix(depth_.At("camera"), light);
  SetMatrix(depth_.At("light"), light);
  glEnable(GL_DEPTH_CLAMP);
  DrawBodies();
  glDisable(GL_DEPTH_CLAMP);
}

Renderer::LineVertex Renderer::Corner(const Point& at, unsigned colour) {
  const auto part = [colour](int shift) { return static_cast<float>(colour >> shift & 255) / 255; };
  return {{at.x, at.y, at.z}, {part(16), part(8), part(0)}};
}

void Renderer::DrawLines(const Matrix4f& camera) {
  glDisable(GL_DEPTH_TEST);  // contacts are inside of piles
  glEnable(GL_PROGRAM_POINT_SIZE);
  line_.Use();
  SetMatrix(line_.At("camera"), camera);
  glBindVertexArray(line_array_);
  glBindBuffer(GL_ARRAY_BUFFER, line_buffer_);
  for (auto [vertices, kind] : {std::pair{&lines_, GL_LINES}, {&dots_, GL_POINTS}}) {
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices->size() * sizeof(LineVertex)),
                 vertices->data(), GL_STREAM_DRAW);
    glDrawArrays(static_cast<GLenum>(kind), 0, static_cast<GLsizei>(vertices->size()));
    vertices->clear();
  }
}

const Target& Renderer::Resolve() {
  const int width = picture_.width(), height = picture_.height();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_.frame());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, picture_.frame());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  picture_.Bind();
  return picture_;
}

void WritePng(const std::string& path, const Target& target) {
  const int width = target.width(), height = target.height();
  std::vector<unsigned char> pixels(static_cast<size_t>(3 * width * height));
  target.Bind();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  stbi_flip_vertically_on_write(1);
  if (stbi_write_png(path.c_str(), width, height, 3, pixels.data(), 3 * width) == 0) {
    throw cli::Failure(cli::kBadInput, fmt::format("cannot write '{}'", path));
  }
}

}  // namespace cairn::play
