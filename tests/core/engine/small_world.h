// SPDX-License-Identifier: MIT
// Bodies that fall, and the step of an engine around the helpers.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/joints.h"
#include "cairn/solver.h"

namespace cairn::test {

using Eigen::Vector3d;

/// A ball or box of a small engine: semi-implicit steps, inertia as that of a ball.
struct Thing {
  double mass = 1;  ///< 0: moved by its velocity alone
  Vector3d position = Vector3d::Zero();
  double inertia = 0.4;
  Velocity velocity = {};
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();

  JointSide Side(int body, const Vector3d& anchor) const {
    return {.body = body,
            .centre = position,
            .anchor = position + turn * anchor,
            .axes = turn.toRotationMatrix()};
  }
};

struct SmallWorld {
  std::vector<Thing> things;
  double h = 1 / 60.0;
  double gravity = 9.81;
  Contacts contacts;
  Joints joints;
  Solver solver{{.tolerance = 1e-5}};
  Report report;

  /// One step; @p fill adds contacts and joints.
  void Step(const std::function<void(SmallWorld*)>& fill) {
    std::vector<Body> bodies;
    for (const Thing& thing : things) {
      Body& body = bodies.emplace_back();
      body.velocity = thing.velocity;
      body.id = bodies.size();
      if (thing.mass == 0) continue;
      body.inv_mass = 1 / thing.mass;
      body.inv_inertia = Eigen::Matrix3d::Identity() / thing.inertia;
      body.impulse = Vector3d(0, -gravity * h * thing.mass, 0);
    }
    const StepInput step{bodies, h, solver.settings().substeps};
    contacts.Begin(step);
    joints.Begin(step);
    fill(this);
    std::vector<Velocity> velocities(bodies.size());
    report =
        solver.Solve(ProblemOf(step, contacts, joints), StartOf(&contacts, &joints), velocities);
    ASSERT_TRUE(report.ok()) << Describe(report);
    const std::span<const Velocity> means = solver.mean_velocities();
    for (size_t i = 0; i < things.size(); ++i) {
      Move(means.empty() ? velocities[i] : means[i], &things[i]);
      things[i].velocity = velocities[i];
    }
  }

 private:
  void Move(const Velocity& velocity, Thing* thing) const {
    thing->position += h * View(velocity.linear);
    const double angle = h * View(velocity.angular).norm();
    if (angle == 0) return;
    thing->turn = Eigen::AngleAxisd(angle, View(velocity.angular).normalized()) * thing->turn;
    thing->turn.normalize();
  }
};

}  // namespace cairn::test
