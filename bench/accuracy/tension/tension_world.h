// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "scenes/world.h"

namespace cairn::accuracy {

/// What holds the links of a chain together.
enum class Link { kPin, kHinge, kConeTwist, kSixDof };
inline constexpr std::array kLinks = {Link::kPin, Link::kHinge, Link::kConeTwist, Link::kSixDof};
std::string_view NameOf(Link link);

/// Where a chain is.
enum class Stage {
  kPlane,  ///< On a pin, starts level and swings down in a plane.
  kSpace,  ///< On a pin, starts level and circles about the vertical.
  kFree,   ///< A load at each end, spins without gravity, held by nothing.
};
inline constexpr std::array kStages = {Stage::kPlane, Stage::kSpace, Stage::kFree};
std::string_view NameOf(Stage stage);

/// A chain of links of 1 kg and 1 m with a heavy ball at its end, held by its centre: one link
/// swings as a compound pendulum.
struct TensionCell {
  Stage stage = Stage::kPlane;
  Link link = Link::kPin;
  bool limits = false;  ///< Joints between links turn by kMostAngle at most; not pins.
  int links = 10;
  double load = 1;   ///< Mass of a ball [kg].
  double rate = 60;  ///< Steps in a second.

  static constexpr double kMostAngle = 0.4;  ///< [rad]
};

/// "plane, hinge, limits, 60 Hz": what cells of one table have in common.
std::string GroupOf(const TensionCell& cell);
/// The same with links and load.
std::string NameOf(const TensionCell& cell);

/// The bodies and joints of a cell in a Bullet world.
class TensionWorld {
 public:
  /// @param solver  is not owned
  TensionWorld(const TensionCell& cell, btConstraintSolver* solver);

  void Step() { world_.Step(); }
  bench::World& world() { return world_; }

  double Gap() const;      ///< Largest of a joint [m].
  double Energy() const;   ///< TotalEnergy() [J].
  btVector3 Load() const;  ///< Where the ball at the end is, seen from the pin [m].
  /// Angular momentum that nothing changes: about the vertical through the pin; about the centre of
  /// mass where nothing holds the chain [kg m^2/s].
  std::array<double, 3> Spin() const;
  /// What energies are compared with: that of falling from level to straight down, or that at the
  /// start where there is no gravity [J].
  double energy_scale() const { return energy_scale_; }
  double length() const { return length_; }  ///< From the pin to the ball [m].

 private:
  btRigidBody* AddBall(btScalar x);
  void Join(btRigidBody* a, btRigidBody* b, int place);
  /// Lets it turn about y, or about z where nothing holds it.
  void Spin(const btVector3& about, const btVector3& spin);

  TensionCell cell_;
  bench::World world_;
  btRigidBody* ball_ = nullptr;
  double energy_scale_ = 0, length_ = 0;
};

}  // namespace cairn::accuracy
