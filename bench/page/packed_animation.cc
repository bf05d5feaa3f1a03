// SPDX-License-Identifier: MIT
#include "page/html_report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kBytesOfBody = 13;
constexpr double kLeastError = 1e-4, kErrorDecades = 4;

std::string ToBase64(const std::vector<std::uint8_t>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

/// A cube that holds what is interesting.
struct Box {
  std::array<double, 3> low{};
  double side = 1;
};

/// Around the scene as built, with as much again on each side.
Box BoxOf(const SceneResult& scene) {
  std::array<double, 3> low, high;
  low.fill(INFINITY);
  high.fill(-INFINITY);
  for (const SolverResult& solver : scene.solvers) {
    if (solver.animation.frames.empty()) continue;
    for (const Pose& pose : solver.animation.frames.front().poses) {
      for (int i = 0; i < 3; ++i) {
        low[i] = std::min<double>(low[i], pose.position[i]);
        high[i] = std::max<double>(high[i], pose.position[i]);
      }
    }
  }
  Box box;
  double most = 1;
  for (int i = 0; i < 3; ++i) most = std::max(most, high[i] - low[i]);
  box.side = 3 * most + 20;
  for (int i = 0; i < 3; ++i) {
    const double middle = high[i] >= low[i] ? (low[i] + high[i]) / 2 : 0;
    box.low[i] = middle - box.side / 2;
  }
  return box;
}

class Packer {
 public:
  explicit Packer(const Box& box) : box_(box) {}

  void Add(const AnimationFrame& frame) {
    for (const Pose& pose : frame.poses) {
      for (int i = 0; i < 3; ++i) {
        Append((pose.position[i] - box_.low[i]) / box_.side * 2 - 1);
      }
      const double sign = pose.rotation[3] < 0 ? -1 : 1;
      for (int i = 0; i < 3; ++i) Append(sign * pose.rotation[i]);
    }
    for (const float error : frame.errors) {
      const double share = std::log10(std::max<double>(error, kLeastError) / kLeastError);
      errors_.push_back(
          static_cast<std::uint8_t>(std::clamp(share / kErrorDecades, 0.0, 1.0) * 255));
    }
  }

  std::string poses() const { return ToBase64(poses_); }
  std::string errors() const { return ToBase64(errors_); }

 private:
  /// A number in [-1, 1]; what is none is 0.
  void Append(double number) {
    const double inside = std::isfinite(number) ? std::clamp(number, -1.0, 1.0) : 0;
    const auto bits = static_cast<std::uint16_t>(std::lround(inside * 32767));
    poses_.push_back(static_cast<std::uint8_t>(bits & 255));
    poses_.push_back(static_cast<std::uint8_t>(bits >> 8));
  }

  Box box_;
  std::vector<std::uint8_t> poses_, errors_;
};

Json ToJson(const Pose& pose) {
  Json json = Json::array();
  for (const float number : pose.position) json.push_back(number);
  for (const float number : pose.rotation) json.push_back(number);
  return json;
}

Json ToJson(const std::vector<AnimatedBody>& bodies) {
  Json json = Json::array();
  for (const AnimatedBody& body : bodies) {
    Json parts = Json::array();
    for (const AnimatedPart& part : body.parts) {
      parts.push_back({{"shape", part.shape}, {"pose", ToJson(part.pose)}});
    }
    json.push_back(parts);
  }
  return json;
}

/// What all solvers have in common, from the one that saw most bodies.
Json Things(const SceneResult& scene) {
  const Animation& animation =
      std::max_element(scene.solvers.begin(), scene.solvers.end(),
                       [](const SolverResult& a, const SolverResult& b) {
                         return a.animation.bodies.size() < b.animation.bodies.size();
                       })
          ->animation;
  Json shapes = Json::array(), still = Json::array();
  for (const AnimatedShape& shape : animation.shapes) {
    shapes.push_back({{"kind", shape.kind}, {"numbers", shape.numbers}});
  }
  for (const Pose& pose : animation.still_poses) still.push_back(ToJson(pose));
  return {{"up", animation.up},
          {"shapes", shapes},
          {"bodies", ToJson(animation.bodies)},
          {"still_bodies", ToJson(animation.still_bodies)},
          {"still_poses", still}};
}

/// Keep every k-th frame.
size_t StrideFor(const SceneResult& scene, size_t bytes) {
  size_t all = 0;
  for (const SolverResult& solver : scene.solvers) {
    for (const AnimationFrame& frame : solver.animation.frames)
      all += frame.poses.size() * kBytesOfBody;
  }
  return std::max<size_t>(1, (all * 4 / 3 + bytes - 1) / bytes);
}

}  // namespace

Json PackAnimation(const SceneResult& scene, size_t bytes) {
  const size_t stride = StrideFor(scene, bytes);
  const Box box = BoxOf(scene);
  Json solvers = Json::array();
  for (const SolverResult& solver : scene.solvers) {
    Packer packer(box);
    Json frames = Json::array(), counts = Json::array();
    for (size_t i = 0; i < solver.animation.frames.size(); i += stride) {
      packer.Add(solver.animation.frames[i]);
      frames.push_back(i);
      counts.push_back(solver.animation.frames[i].poses.size());
    }
    solvers.push_back({{"frames", frames},
                       {"counts", counts},
                       {"poses", packer.poses()},
                       {"errors", packer.errors()}});
  }
  Json json = Things(scene);
  json["stride"] = stride;
  json["low"] = box.low;
  json["side"] = box.side;
  json["error_least"] = kLeastError;
  json["error_decades"] = kErrorDecades;
  json["solvers"] = solvers;
  return json;
}

}  // namespace cairn::cli
