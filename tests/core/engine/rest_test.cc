// SPDX-License-Identifier: MIT
// Towers of boxes, made by the helpers: they come to rest, and stay. CAIRN_REST_SEEDS asks for more
// tall towers than these, and for a minute.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/joints.h"
#include "cairn/solver.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

constexpr double kTimeStep = 1 / 60.0;

struct Box {
  double mass;
  Vector3d position;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Velocity velocity = {};
};

/// Boxes of 1 m, each above the last; a corner that is over the box below touches its upper face.
class Tower {
 public:
  Tower(const std::vector<double>& masses, std::uint32_t seed, const Settings& settings)
      : random_(seed), solver_(settings) {
    for (const double mass : masses) {
      const double height = 0.5 + static_cast<double>(boxes_.size());
      boxes_.push_back({.mass = mass, .position = {Offset(), height, Offset()}});
    }
  }

  void Run(double seconds) {
    for (int i = 0; i < seconds / kTimeStep; ++i) Step();
  }
  double speed() const {
    double fastest = 0;
    for (const Box& box : boxes_) {
      fastest =
          std::max({fastest, View(box.velocity.linear).norm(), View(box.velocity.angular).norm()});
    }
    return fastest;
  }
  /// The most in a second from now on.
  double TopSpeed() {
    double fastest = 0;
    for (int frame = 0; frame < 60; ++frame) {
      Step();
      fastest = std::max(fastest, speed());
    }
    return fastest;
  }
  /// Steps that left it quiet.
  int quiet() const { return quiet_; }
  double height() const { return boxes_.back().position.y() + 0.5; }

 private:
  /// Up to 2 cm, the same with every library.
  double Offset() { return 0.04 * (static_cast<double>(random_()) / 4294967296.0 - 0.5); }

  void AddContact(int i) {
    const Box ground{.mass = 0, .position = {0, -0.5, 0}};
    const Box& box = boxes_[i];
    const Box& below = i > 0 ? boxes_[i - 1] : ground;
    const Vector3d up = below.turn * Vector3d::UnitY();
    std::vector<TouchPoint> points;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const Vector3d corner(k & 1 ? 0.5 : -0.5, -0.5, k & 2 ? 0.5 : -0.5);
      const Vector3d at = box.position + box.turn * corner;
      points.push_back({at, 0.5 - up.dot(at - below.position), k});
    }
    contacts_.Add({.body_a = i,
                   .body_b = i > 0 ? i - 1 : kWorld,
                   .centre_a = box.position,
                   .centre_b = below.position,
                   .normal = up,
                   .id = static_cast<std::uint64_t>(i + 1)},
                  points);
  }

  void Step() {
    std::vector<Body> bodies;
    for (const Box& box : boxes_) {
      bodies.push_back({.inv_mass = 1 / box.mass,
                        .inv_inertia = Eigen::Matrix3d::Identity() * (6 / box.mass),
                        .velocity = box.velocity,
                        .impulse = {0, -9.81 * kTimeStep * box.mass, 0},
                        .id = bodies.size() + 1});
    }
    const StepInput step{bodies, kTimeStep};
    contacts_.Begin(step);
    joints_.Begin(step);
    for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) AddContact(i);
    std::vector<Velocity> velocities(bodies.size());
    const Report report = solver_.Solve(ProblemOf(step, contacts_, joints_),
                                        StartOf(&contacts_, &joints_), velocities);
    ASSERT_TRUE(report.ok()) << Describe(report);
    quiet_ = report.islands[0].quiet;
    const std::span<const Velocity> means = solver_.mean_velocities();
    for (size_t i = 0; i < boxes_.size(); ++i) {
      Move(means.empty() ? velocities[i] : means[i], &boxes_[i]);
      boxes_[i].velocity = velocities[i];
    }
  }

  static void Move(const Velocity& velocity, Box* box) {
    box->position += kTimeStep * View(velocity.linear);
    const double angle = kTimeStep * View(velocity.angular).norm();
    if (angle == 0) return;
    box->turn = Eigen::AngleAxisd(angle, View(velocity.angular).normalized()) * box->turn;
    box->turn.normalize();
  }

  std::mt19937 random_;
  std::vector<Box> boxes_;
  Contacts contacts_;
  Joints joints_;
  Solver solver_;
  int quiet_ = 0;
};

// At the default of 1e-4 towers creep by up to 2.6 mm/s.
constexpr Settings kRest = {.tolerance = 2e-5};

TEST(Rest, TenBoxesStandStillAfterFiveSeconds) {
  double fastest = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    Tower tower(std::vector<double>(10, 10.0), seed, kRest);
    tower.Run(5);
    EXPECT_LE(tower.TopSpeed(), 1e-3) << "seed " << seed;
    EXPECT_GE(tower.quiet(), 60) << "seed " << seed;
    EXPECT_NEAR(tower.height(), 10, 0.06) << "seed " << seed;  // a slop of 5 mm each
    fastest = std::max(fastest, tower.TopSpeed());
  }
  std::printf("ten boxes: top speed %.2g m/s\n", fastest);
}

// They creep by up to 2.6 mm/s, and sleep ends that.
TEST(Rest, TenBoxesAreQuietAtTheDefaultTolerance) {
  double fastest = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    Tower tower(std::vector<double>(10, 10.0), seed, Settings{});
    tower.Run(5);
    EXPECT_LE(tower.TopSpeed(), 4e-3) << "seed " << seed;
    EXPECT_GE(tower.quiet(), 60) << "seed " << seed;
    fastest = std::max(fastest, tower.TopSpeed());
  }
  std::printf("ten boxes: top speed %.2g m/s\n", fastest);
}

/// How many towers of each kind, and for how long [s]; for a minute if the environment asks for
/// their number.
struct Towers {
  std::uint32_t seeds;
  double seconds = 60;

  Towers OrAsAsked() const {
    const char* const asked = std::getenv("CAIRN_REST_SEEDS");
    return asked == nullptr ? *this : Towers{static_cast<std::uint32_t>(std::stoi(asked))};
  }
};

/// Boxes of 1 kg: thirty, and sixteen under one of 100 kg. @p fastest: in the last second [m/s]
void ExpectRest(const Settings& settings, const Towers& towers, double fastest) {
  std::vector<double> top_heavy(16, 1.0);
  top_heavy.push_back(100);
  for (const std::vector<double>& masses : {std::vector<double>(30, 1.0), top_heavy}) {
    std::vector<double> speeds;
    for (std::uint32_t seed = 1; seed <= towers.seeds; ++seed) {
      SCOPED_TRACE(std::to_string(masses.size()) + " boxes, seed " + std::to_string(seed));
      Tower tower(masses, seed, settings);
      tower.Run(towers.seconds - 1);
      speeds.push_back(tower.TopSpeed());
      EXPECT_LE(speeds.back(), fastest);
      EXPECT_GE(tower.quiet(), 50 * towers.seconds);
      // a slop of 5 mm each, of which little is used
      EXPECT_NEAR(tower.height(), static_cast<double>(masses.size()), 0.01);
    }
    std::sort(speeds.begin(), speeds.end());
    std::printf("%zu boxes: top speed %.2g, median %.2g m/s\n", masses.size(), speeds.back(),
                speeds[speeds.size() / 2]);
  }
}

// 20 seeds, 60 s: at most 2.7e-2 m/s.
TEST(Rest, TallAndTopHeavyTowersStandAtTheDefaultTolerance) {
  ExpectRest(Settings{}, Towers{.seeds = 3, .seconds = 15}.OrAsAsked(), 4e-2);
}

// 20 seeds, 60 s: at most 5.1e-3 m/s.
TEST(Rest, TallAndTopHeavyTowersStand) {
  ExpectRest(kRest, Towers{.seeds = 1, .seconds = 15}.OrAsAsked(), 1e-2);
}

// 20 seeds: at most 3.0e-3 m/s, in a seventh of the time.
TEST(Rest, SubstepsLeaveTallTowersSlower) {
  Settings settings = kRest;
  settings.substeps = 2;
  ExpectRest(settings, Towers{.seeds = 3}.OrAsAsked(), 5e-3);
}

}  // namespace
}  // namespace cairn
