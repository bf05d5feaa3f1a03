// SPDX-License-Identifier: MIT
#include "tests/fuzz/contact_game.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "cairn/detail/eigen.h"
#include "problem/contact_expansion.h"
#include "reference/pack.h"

namespace cairn::test {
namespace {

constexpr int kMostFrames = 6;

template <class T>
bool SameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  const size_t bytes = a.size() * sizeof(T);
  return a.size() == b.size() && (bytes == 0 || std::memcmp(a.data(), b.data(), bytes) == 0);
}

/// Looks at one frame, before and after.
class Judge {
 public:
  /// @p decades: over which numbers are spread. Floats tell no more than some from each other.
  Judge(const GameWorld& before, const Settings& settings, int decades)
      : before_(before), settings_(settings), comparable_(decades <= kComparable) {}

  /// The promise that was broken.
  std::string Check(GameWorld* after, const Report& report) const;

 private:
  bool Untouched(const GameWorld& after) const;
  bool Finite(const GameWorld& after, const Report& report) const;
  std::string OwnBounds(const GameWorld& after) const;
  bool FrictionBounds(const GameWorld& after) const;
  std::string Work(const Report& report) const;
  /// Whether directions and bounces do not hang on a last digit, and residuals mean one thing.
  bool IsSteady() const;
  std::string Residual(GameWorld* after, const Report& report) const;
  /// What rounding of energies is relative to [sqrt(J)].
  double Scale(const GameWorld& after, const std::vector<double>& x) const;
  double LargestImpulse(const GameWorld& world) const;

  static constexpr int kComparable = 12;

  const GameWorld& before_;
  const Settings& settings_;
  bool comparable_;
};

bool Judge::Untouched(const GameWorld& after) const {
  return SameBytes(before_.row_impulses, after.row_impulses) &&
         SameBytes(before_.point_impulses, after.point_impulses) &&
         SameBytes(before_.twist_impulses, after.twist_impulses) &&
         SameBytes(before_.joint_impulses, after.joint_impulses) &&
         SameBytes(before_.velocities, after.velocities);
}

bool Judge::Finite(const GameWorld& after, const Report& report) const {
  double zero = 0 * (report.residual_max + report.residual_angular + report.residual_energy);
  for (double x : after.row_impulses) zero += 0 * x;
  for (float x : after.joint_impulses) zero += 0 * x;
  for (const ContactImpulse& x : after.point_impulses) {
    zero += 0 * (0 * x.normal + 0 * x.tangential[0] + 0 * x.tangential[1] + 0 * x.heading);
    for (float direction : x.direction) zero += 0 * direction;
  }
  for (const Manifold& manifold : after.manifolds) {
    for (int p = 0; p < manifold.points && manifold.twists; ++p) {
      const TwistImpulse& x = after.twist_impulses[manifold.first_point + p];
      zero += 0 * x.spinning + 0 * x.rolling[0] + 0 * x.rolling[1];
    }
  }
  for (const Velocity& v : after.velocities) {
    for (int k = 0; k < 3; ++k) zero += 0 * v.linear[k] + 0 * v.angular[k];
  }
  return zero == 0;
}

std::string Judge::OwnBounds(const GameWorld& after) const {
  for (size_t i = 0; i < after.rows.size(); ++i) {
    const Row& row = after.rows[i];
    const bool inside = after.row_impulses[i] >= row.lo && after.row_impulses[i] <= row.hi;
    if (!inside) return "a row is outside its bounds";
  }
  for (const Joint& joint : after.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      const JointRow& row = after.joint_rows[joint.first_row + i];
      const float x = after.joint_impulses[joint.first_row + i];
      if (joint.is_bounded(i) && !(x >= row.lo && x <= row.hi)) {
        return "a joint is outside its bounds";
      }
    }
  }
  for (const Manifold& manifold : after.manifolds) {
    for (int p = manifold.first_point; p < manifold.first_point + manifold.points; ++p) {
      if (!(after.point_impulses[p].normal >= 0)) return "a contact pulls";
      if (!manifold.twists) continue;
      const ContactTwist& law = after.twists[p];
      const TwistImpulse& x = after.twist_impulses[p];
      const bool inside = std::abs(x.spinning) <= law.most_spinning &&
                          std::abs(x.rolling[0]) <= law.most_rolling &&
                          std::abs(x.rolling[1]) <= law.most_rolling;
      if (!inside) return "resistance to turning is above its most";
    }
  }
  return "";
}

double Judge::LargestImpulse(const GameWorld& world) const {
  double largest = 0;
  for (double x : world.row_impulses) largest = std::max(largest, std::abs(x));
  for (const ContactImpulse& x : world.point_impulses) {
    largest = std::max<double>(largest, std::abs(x.normal));
  }
  return largest;
}

bool Judge::FrictionBounds(const GameWorld& after) const {
  if (!comparable_ || settings_.tuning.lifted_friction == detail::LiftedFriction::kHold)
    return true;
  // sweeps change impulses by differences, in floats, which end at 1e-45
  const double rounding = 1e-6 * std::max({LargestImpulse(before_), LargestImpulse(after), 1e-34});
  const auto inside = [rounding](double x, double friction, double normal) {
    const double most = friction * std::max(0.0, normal);
    return std::abs(x) <= 1.00001 * most + (1 + friction) * rounding;
  };
  for (size_t i = 0; i < after.rows.size(); ++i) {
    const Row& row = after.rows[i];
    if (row.parent == kNoRow || row.host.max_sweeps < settings_.max_sweeps) continue;
    const double normal = after.row_impulses[row.parent];
    if (!inside(after.row_impulses[i], row.friction, normal)) return false;
  }
  for (const Manifold& manifold : after.manifolds) {
    for (int p = manifold.first_point; p < manifold.first_point + manifold.points; ++p) {
      const ContactImpulse& x = after.point_impulses[p];
      for (int k = 0; k < manifold.tangents; ++k) {
        if (!inside(x.tangential[k], after.points[p].friction, x.normal)) return false;
      }
    }
  }
  return true;
}

std::string Judge::Work(const Report& report) const {
  if (settings_.budget.kind() != Budget::Kind::kWork) return "";
  // the sweeps that are made in any case, a block of rows, and a residual
  const double rows = static_cast<double>(AllRows(before_.problem()));
  const double most = static_cast<double>(settings_.budget.work()) +
                      rows * (2 * settings_.tuning.min_sweeps + 3) + 64;
  if (static_cast<double>(report.work) <= most) return "";
  return "work of " + std::to_string(report.work) + " on a budget of " +
         std::to_string(settings_.budget.work()) + " for " + std::to_string(rows) + " rows";
}

bool Judge::IsSteady() const {
  if (before_.law.bounce_speed > 0) return false;
  // friction that is held outside its bounds between bodies that nothing moves: blocks count it
  if (settings_.tuning.lifted_friction == detail::LiftedFriction::kHold) return false;
  // likewise friction that only turns, and may be swept less often than what bounds it
  const bool ends_early =
      std::any_of(before_.rows.begin(), before_.rows.end(), [&](const Row& row) {
        return row.parent != kNoRow && row.host.max_sweeps < settings_.max_sweeps &&
               View(row.linear_a).isZero() && View(row.linear_b).isZero();
      });
  if (ends_early) return false;
  return std::all_of(before_.manifolds.begin(), before_.manifolds.end(),
                     [&](const Manifold& m) { return m.tangents == 0 && !m.twists; });
}

double Judge::Scale(const GameWorld& after, const std::vector<double>& x) const {
  GameWorld start = before_;
  const ContactExpansion expansion(before_.problem(), start.impulses());
  const ContactProblem rows = expansion.problem();
  const Packer packer(rows, settings_);
  double fastest = 0;
  for (size_t i = 0; i < rows.bodies.size(); ++i) {
    WhitenedBody body;
    Whiten(rows.bodies[i], &body);
    fastest = std::max({fastest, View(body.free.linear).norm(), View(body.free.angular).norm(),
                        View(after.velocities[i].linear).norm(),
                        View(after.velocities[i].angular).norm()});
  }
  for (const ContactMotion& motion : before_.motions) {
    for (const float* from : {motion.free_velocity, motion.free_spin}) {
      for (int k = 0; k < 3; ++k) fastest = std::max<double>(fastest, std::abs(from[k]));
    }
  }
  const std::vector<double> begin = AllImpulses(before_.problem(), start.impulses());
  double scale = 0;
  for (const Island& island : FindIslands(rows)) {
    const PackedIsland packed = packer.Pack(island);
    for (size_t k = 0; k < island.rows.size(); ++k) {
      const double d = packed.rows[k].diagonal;
      if (d <= 0) continue;
      const Row& row = rows.rows[island.rows[k]];
      const double j = View(row.linear_a).norm() + View(row.angular_a).norm() +
                       View(row.linear_b).norm() + View(row.angular_b).norm();
      const int index = island.rows[k];
      const double impulse = std::max(std::abs(x[index]), std::abs(begin[index]));
      scale += std::sqrt(d) * impulse + (j * fastest + std::abs(row.target)) / std::sqrt(d);
    }
  }
  return scale;
}

std::string Judge::Residual(GameWorld* after, const Report& report) const {
  if (!comparable_ || !IsSteady()) return "";
  const std::vector<double> x = AllImpulses(after->problem(), after->impulses());
  const Report measured = Measure(after->problem(), x);
  if (!measured.ok()) return "the result cannot be measured";
  const double rounding = (PathOf(settings_) == Path::kFast ? 1e-4 : 1e-6) * Scale(*after, x);
  const double difference = std::abs(report.residual_energy - measured.residual_energy);
  if (!(difference > rounding)) return "";
  std::ostringstream text;
  text << "the residual is " << report.residual_energy << ", to Measure() it is "
       << measured.residual_energy << ", where rounding makes " << rounding;
  return text.str();
}

std::string Judge::Check(GameWorld* after, const Report& report) const {
  if (!report.ok()) return Untouched(*after) ? "" : "refused, and outputs touched";
  if (!Finite(*after, report)) return "ok, and not finite";
  if (std::string broken = OwnBounds(*after); !broken.empty()) return broken;
  if (!FrictionBounds(*after)) return "friction is outside its bounds";
  if (std::string broken = Work(report); !broken.empty()) return broken;
  return Residual(after, report);
}

}  // namespace

GameResult PlayGame(std::span<const std::uint8_t> bytes, const Play& play) {
  Choices choices(bytes);
  GameMaker maker(&choices);
  Settings settings = maker.MakeSettings();
  settings.threads = play.threads;
  Solver solver(settings);
  GameWorld world;
  GameResult result;
  Hash hash;
  for (int frame = 0; frame < kMostFrames && !(frame > 0 && choices.empty()); ++frame) {
    maker.NextFrame(&world);
    const GameWorld before = world;
    Report report;
    solver.Solve(world.problem(), world.impulses(), world.velocities, &report);
    result.broken = Judge(before, settings, maker.decades()).Check(&world, report);
    hash.Add(report.status);
    hash.Add(report.residual_max);
    hash.Add(report.residual_energy);
    hash.Add(report.sweeps);
    hash.AddAll(world.row_impulses);
    hash.AddAll(world.point_impulses);
    hash.AddAll(world.twist_impulses);
    hash.AddAll(world.joint_impulses);
    hash.AddAll(world.velocities);
    result.hash = hash.value();
    if (!result.broken.empty()) {
      result.broken += " in frame " + std::to_string(frame);
      break;
    }
  }
  return result;
}

std::string PlayContactGame(std::span<const std::uint8_t> bytes) {
  return PlayEverywhere(&PlayGame, bytes);
}

}  // namespace cairn::test
