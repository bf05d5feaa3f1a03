// SPDX-License-Identifier: MIT
#include "block_problems.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "cairn/detail/eigen.h"
#include "problem/islands.h"

namespace cairn::test {

Scene Together(const std::vector<Scene>& scenes) {
  Scene all;
  for (const Scene& scene : scenes) {
    const int bodies = static_cast<int>(all.bodies.size());
    const int rows = static_cast<int>(all.rows.size());
    all.bodies.insert(all.bodies.end(), scene.bodies.begin(), scene.bodies.end());
    all.positions.insert(all.positions.end(), scene.positions.begin(), scene.positions.end());
    for (Row row : scene.rows) {
      if (row.body_a != kWorld) row.body_a += bodies;
      if (row.body_b != kWorld) row.body_b += bodies;
      if (row.parent != kNoRow) row.parent += rows;
      all.rows.push_back(row);
    }
  }
  return all;
}

Scene NormalsFirst(const Scene& scene) {
  Scene sorted{.bodies = scene.bodies, .positions = scene.positions, .rows = {}};
  std::vector<int> place(scene.rows.size());
  for (const bool friction : {false, true}) {
    for (size_t i = 0; i < scene.rows.size(); ++i) {
      Row row = scene.rows[i];
      if ((row.parent != kNoRow) != friction) continue;
      place[i] = static_cast<int>(sorted.rows.size());
      if (friction) row.parent = place[row.parent];
      sorted.rows.push_back(row);
    }
  }
  return sorted;
}

namespace {

void AddBrick(const Vector3d& sides, const Vector3d& position, Scene* scene) {
  scene->bodies.push_back(Box(1, sides));
  scene->bodies.back().impulse.z() = -kGravityStep;
  scene->positions.push_back(position);
}

/// Four contact points of a face from x0 to x1, a above b.
void AddFace(int a, int b, double x0, double x1, Scene* scene) {
  const double z = scene->positions[a].z() - 0.5, y = scene->positions[a].y();
  for (const auto& [px, py] :
       {std::pair(x0, y - 0.5), {x0, y + 0.5}, {x1, y - 0.5}, {x1, y + 0.5}}) {
    const Vector3d point(px, py, z);
    AddContact(scene, PointRow(*scene, a, b, point, Vector3d::UnitZ()), point, 0.5);
  }
}

}  // namespace

Scene Wall(int width, int height) {
  Scene scene;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = 2 * column + row % 2;
      const int brick = static_cast<int>(scene.bodies.size());
      AddBrick({2, 1, 1}, {x, 0, row + 0.5}, &scene);
      if (row == 0) {
        AddFace(brick, kWorld, x - 1, x + 1, &scene);
        continue;
      }
      // the two below it, of which one is missing at an end of the wall
      for (int side = 0; side < 2; ++side) {
        const int below = column - 1 + row % 2 + side;
        if (below < 0 || below >= width) continue;
        AddFace(brick, (row - 1) * width + below, x - 1 + side, x + side, &scene);
      }
    }
  }
  return scene;
}

Scene Plate(int boxes) {
  Scene scene;
  AddBrick({2.0 * boxes, 1, 1}, {boxes - 1.0, 0, 0.5}, &scene);
  AddFace(0, kWorld, -1, 2 * boxes - 1, &scene);
  for (int i = 0; i < boxes; ++i) {
    AddBrick({1, 1, 1}, {2.0 * i, 0, 1.5}, &scene);
    AddFace(i + 1, 0, 2 * i - 0.5, 2 * i + 0.5, &scene);
  }
  return scene;
}

Scene Heap(const PileOptions& options, std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  for (int i = 0; i < options.bodies; ++i) {
    const double mass = random.Uniform(0.5, 4);
    scene.bodies.push_back(Box(mass, Vector3d::Constant(1) + random.Vector(0.5)));
    scene.bodies.back().velocity = {.linear = random.Vector(1), .angular = random.Vector(1)};
    scene.bodies.back().impulse.z() = -mass * kGravityStep;
    scene.positions.push_back(random.Vector(3));
  }
  for (int i = 0; i < options.contacts + options.pins; ++i) {
    const int a = random.Index(options.bodies);
    int b = (a + 1 + random.Index(options.bodies - 1)) % options.bodies;
    if (random.Uniform(0, 1) < options.world_share) b = kWorld;
    const Vector3d point = scene.positions[a] + random.Vector(0.5);
    if (i < options.pins) {
      AddPin(&scene, a, b, point);
      continue;
    }
    Row normal = LinearRow(a, b, random.Direction());
    normal.angular_a = random.Vector(0.5).cross(View(normal.linear_a));
    if (b != kWorld) normal.angular_b = random.Vector(0.5).cross(View(normal.linear_b));
    normal.target = random.Uniform(-0.1, 0.1);
    AddContact(&scene, normal, point, random.Uniform(0, 1));
  }
  return scene;
}

Scene WithEveryLaw(Scene scene, std::uint64_t seed) {
  Random random(seed);
  const int rows = static_cast<int>(scene.rows.size());
  for (int i = 0; i < rows; ++i) {
    Row& row = scene.rows[i];
    if (random.Index(4) == 0) row.compliance = random.Uniform(0.01, 0.5);
    if (random.Index(6) == 0) row.relaxation = random.Uniform(0.5, 1.3);
    if (random.Index(8) == 0) row.host.max_sweeps = random.Index(6);
    if (row.parent == kNoRow && row.lo == -kInfinity && random.Index(3) == 0) {
      row.lo = -0.05;
      row.hi = 0.1;
    }
    if (row.parent != kNoRow || row.lo != 0 || random.Index(3) != 0) continue;
    Row rolling = AngularRow(row.body_a, row.body_b, random.Direction());
    rolling.parent = i;
    rolling.friction = 0.1;
    if (random.Index(2) == 0) {
      rolling.lo = -0.02;
      rolling.hi = 0.03;
    }
    scene.rows.push_back(rolling);
  }
  return scene;
}

double DeniedByLocks(const Body& body, const Vector3& linear) {
  double denied = 0;
  for (int k = 0; k < 3; ++k) {
    if (body.linear_factor[k] == 0) denied += body.inv_mass * linear[k] * linear[k];
  }
  return denied;
}

MovableBodies MovableOf(const Scene& scene) {
  MovableBodies movable;
  for (const Body& body : scene.bodies) movable.push_back(MobilityOf(body));
  return movable;
}

std::vector<RowKind> KindsOf(const Scene& scene, double omega) {
  std::vector<RowKind> laws(scene.rows.size());
  for (size_t i = 0; i < laws.size(); ++i) {
    EXPECT_TRUE(ReadKind(scene.problem(), static_cast<int>(i), 0, omega, &laws[i])) << i;
  }
  return laws;
}

void MakePlan(const Scene& scene, double omega, Plan* plan) {
  Crew alone(1);
  EXPECT_TRUE(plan->Make(scene.problem(), KindsOf(scene, omega), MovableOf(scene), &alone));
}

Settings Coloured(int sweeps) {
  Settings settings = PlainSweeps(sweeps);
  settings.path = Path::kFast;
  return settings;
}

Settings ColouredSteps(int sweeps) {
  Settings settings = AlwaysSteps(sweeps);
  settings.path = Path::kFast;
  return settings;
}

bool Game::Lives(int row) const {
  // joints always; contacts three frames of four or so, several frames in a row
  if (whole_.rows[row].parent != kNoRow) return Lives(whole_.rows[row].parent);
  if (whole_.rows[row].lo != 0) return true;
  const std::uint64_t age = static_cast<std::uint64_t>(frame_ + row % 5) / 5;
  const std::uint64_t mixed = (static_cast<std::uint64_t>(row) + 1) * 0x9e3779b97f4a7c15u + age;
  return (mixed * 0xc2b2ae3d27d4eb4fu >> 40) % 4 != 0;
}

Frame Game::Next() {
  Frame frame{
      .scene = {.bodies = whole_.bodies, .positions = {}, .rows = {}}, .start = {}, .rows = {}};
  std::vector<int> place(whole_.rows.size(), kNoRow);
  for (int i = 0; i < static_cast<int>(whole_.rows.size()); ++i) {
    if (!Lives(i)) continue;
    Row row = whole_.rows[i];
    if (row.parent != kNoRow) row.parent = place[row.parent];
    place[i] = static_cast<int>(frame.rows.size());
    frame.scene.rows.push_back(row);
    frame.start.push_back(impulses_[i]);
    frame.rows.push_back(i);
  }
  ++frame_;
  return frame;
}

void Game::Take(const Frame& frame, const Solution& solution) {
  std::fill(impulses_.begin(), impulses_.end(), 0.0);
  for (size_t i = 0; i < frame.rows.size(); ++i) impulses_[frame.rows[i]] = solution.x[i];
  for (size_t i = 0; i < solution.v.size(); ++i) {
    whole_.bodies[i].velocity.linear = 0.75 * View(solution.v[i].linear);
    whole_.bodies[i].velocity.angular = 0.75 * View(solution.v[i].angular);
  }
}

std::vector<Solution> Play(const Settings& settings, const Scene& whole, int frames) {
  Game game(whole);
  Solver solver(settings);
  std::vector<Solution> solutions;
  for (int i = 0; i < frames; ++i) {
    const Frame frame = game.Next();
    solutions.push_back(Solve(&solver, frame.scene, frame.start));
    EXPECT_TRUE(solutions.back().report.ok()) << Describe(solutions.back().report.status);
    game.Take(frame, solutions.back());
  }
  return solutions;
}

std::uint64_t HashOf(std::span<const Solution> solutions) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte) {
      hash = (hash ^ (bits >> (8 * byte) & 0xff)) * 0x100000001b3u;
    }
  };
  for (const Solution& solution : solutions) {
    for (double x : solution.x) add(x);
    for (const Velocity& v : solution.v) {
      for (int k = 0; k < 3; ++k) add(v.linear[k]);
      for (int k = 0; k < 3; ++k) add(v.angular[k]);
    }
  }
  return hash;
}

testing::AssertionResult SameBits(std::span<const Solution> a, std::span<const Solution> b) {
  if (a.size() != b.size()) return testing::AssertionFailure() << "numbers of frames differ";
  for (size_t i = 0; i < a.size(); ++i) {
    testing::AssertionResult same = SameBits(a[i], b[i]);
    if (!same) return same << ", frame " << i;
  }
  return testing::AssertionSuccess();
}

}  // namespace cairn::test
