// SPDX-License-Identifier: MIT
// Bodies that fall, and the step of an engine around the helpers.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
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

/// Planks on two pins, every fourth of them with a load that is 20 times as heavy.
struct LoadedBridge {
  static constexpr int kPlanks = 16;

  SmallWorld world;
  std::function<void(Joints*)> before_solve;  ///< may change what they start from

  LoadedBridge() {
    for (int i = 0; i < kPlanks; ++i) {
      const bool loaded = i % 4 == 2;
      world.things.push_back({.mass = loaded ? 200.0 : 10.0,
                              .position = {0.5 * i, 0, 0},
                              .inertia = loaded ? 8.0 : 0.4});
    }
  }

  void Step() {
    world.Step([this](SmallWorld* w) {
      const Vector3d half(0.25, 0, 0);
      for (int i = 0; i <= kPlanks; ++i) {
        JointSide a{.anchor = Vector3d(0.5 * kPlanks - 0.25, 0, 0)}, b{.anchor = -half};
        if (i < kPlanks) a = w->things[i].Side(i, -half);
        if (i > 0) b = w->things[i - 1].Side(i - 1, half);
        w->joints.Add(BallJoint(), a, b, static_cast<std::uint64_t>(i) + 1);
      }
      if (before_solve) before_solve(&w->joints);
    });
  }
  /// The same, in something thick.
  void StepDamped() {
    Step();
    for (Thing& thing : world.things) {
      View(thing.velocity.linear) *= 0.97;
      View(thing.velocity.angular) *= 0.97;
    }
  }
  double Speed() const {
    double fastest = 0;
    for (const Thing& thing : world.things) {
      fastest = std::max(fastest, View(thing.velocity.linear).norm());
    }
    return fastest;
  }
};

}  // namespace cairn::test
