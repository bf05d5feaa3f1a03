// SPDX-License-Identifier: MIT
#include "play/view/camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace cairn::play {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;

constexpr float kTanHalfView = 0.38f;  // 42 degrees from top to bottom
constexpr float kTurn = 0.006f;        // [rad] a pixel

Matrix4f LookAt(const Vector3f& eye, const Vector3f& target) {
  const Vector3f back = (eye - target).normalized();
  const Vector3f side = Vector3f(0, 1, 0).cross(back).normalized();
  Matrix4f view = Matrix4f::Identity();
  view.block<1, 3>(0, 0) = side.transpose();
  view.block<1, 3>(1, 0) = back.cross(side).transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * eye;
  return view;
}

}  // namespace

void Camera::Fit(const bench::World& world, float aspect) {
  Eigen::AlignedBox3f box;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    btVector3 low, high;
    body->getAabb(low, high);
    box.extend(Vector3f(float(low.x()), float(low.y()), float(low.z())));
    box.extend(Vector3f(float(high.x()), float(high.y()), float(high.z())));
  }
  if (box.isEmpty()) box.extend(Vector3f::Zero());
  target = box.center();
  scale_ = std::max(0.5f, 0.5f * box.diagonal().norm());
  const float tan_half = kTanHalfView * std::min(1.0f, aspect);
  target.y() += 0.16f * scale_;  // room for the label
  distance = 1.12f * scale_ / std::sin(std::atan(tan_half));
  yaw = 0.6f;
  pitch = 0.34f;
}

void Camera::Orbit(float x, float y) {
  yaw -= kTurn * x;
  pitch = std::clamp(pitch + kTurn * y, -0.2f, 1.5f);
}

void Camera::Pan(float x, float y, float height) {
  const Vector3f back = (eye() - target).normalized();
  const Vector3f side = Vector3f(0, 1, 0).cross(back).normalized();
  const float metres = 2 * kTanHalfView * distance / height;
  target += metres * (y * back.cross(side) - x * side);
}

void Camera::Zoom(float notches) {
  distance = std::clamp(distance * std::pow(0.9f, notches), 0.3f, 500.0f);
}

Vector3f Camera::eye() const {
  return target + distance * Vector3f(std::cos(pitch) * std::sin(yaw), std::sin(pitch),
                                      std::cos(pitch) * std::cos(yaw));
}

Matrix4f Camera::Matrix(float aspect) const {
  const float near = 0.02f * distance, far = 20 * distance + 200;
  Matrix4f projection = Matrix4f::Zero();
  projection(0, 0) = 1 / (kTanHalfView * aspect);
  projection(1, 1) = 1 / kTanHalfView;
  projection(2, 2) = (near + far) / (near - far);
  projection(2, 3) = 2 * near * far / (near - far);
  projection(3, 2) = -1;
  return projection * LookAt(eye(), target);
}

Vector3f Camera::Ray(float x, float y, float aspect) const {
  const Matrix4f back = Matrix(aspect).inverse();
  const Eigen::Vector4f far = back * Eigen::Vector4f(x, y, 1, 1);
  return (far.head<3>() / far.w() - eye()).normalized();
}

Matrix4f LightMatrix(const Vector3f& sun, const Vector3f& middle, float radius) {
  Matrix4f projection = Matrix4f::Identity();
  projection(0, 0) = projection(1, 1) = 1 / radius;
  projection(2, 2) = -1 / (3 * radius);
  return projection * LookAt(middle + sun, middle);
}

}  // namespace cairn::play
