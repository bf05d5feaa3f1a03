// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "scenes/world.h"

namespace cairn::play {

/// Turns about a point.
class Camera {
 public:
  float yaw = 0.7f, pitch = 0.32f;  ///< [rad]
  float distance = 20;              ///< [m]
  Eigen::Vector3f target{0, 2, 0};

  /// So that all that moves is seen from the front and a little above.
  void Fit(const bench::World& world, float aspect);
  /// By pixels of a picture so many pixels high.
  void Orbit(float x, float y);
  void Pan(float x, float y, float height);
  void Zoom(float notches);

  Eigen::Vector3f eye() const;
  Eigen::Matrix4f Matrix(float aspect) const;
  /// Through a place in the picture, both from -1 to 1, y up. Of length 1.
  Eigen::Vector3f Ray(float x, float y, float aspect) const;
  float scale() const { return scale_; }  ///< Radius of what is shown [m].

 private:
  float scale_ = 10;
};

/// From light to shadow, of a ball around a point.
Eigen::Matrix4f LightMatrix(const Eigen::Vector3f& sun, const Eigen::Vector3f& middle,
                            float radius);

}  // namespace cairn::play
