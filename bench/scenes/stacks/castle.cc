// SPDX-License-Identifier: MIT
#include "scenes/scene.h"
#include "scenes/stacks/masonry.h"

// Seen from above. Towers T are rings of bricks, walls are one brick thick; three balls come from
// outside, through a wall each.
//
//              third
//                v
//          T---wall---T
//          |          |
//        wall        wall  < second      x to the right, z downwards
//          |          |
//          T---wall---T
//                ^
//              first
namespace cairn::bench {
namespace {

constexpr Brick kBrick = {.length = 1,
                          .height = btScalar(0.5),
                          .depth = btScalar(0.5),
                          .mass = 40,
                          .surface = {.friction = btScalar(0.6)}};

constexpr int kWallBricks = 10;  // in a course
constexpr int kMerlons = 5;      // on each wall: every second brick
constexpr int kCoursesPerStorey = 4;
constexpr int kTowerBricks = 8;  // in a course, two on each side of the ring
constexpr int kTowerMerlons = 4;
constexpr btScalar kTowerHalfSide = btScalar(1.25);  // [m]
constexpr btScalar kWallToTower = btScalar(0.01);    // [m]

constexpr btScalar kBallRadius = btScalar(0.5);       // [m]
constexpr btScalar kBallMass = 400;                   // [kg]
constexpr btScalar kBallSpeed = 25;                   // [m/s]
constexpr btScalar kBallSpinDamping = btScalar(0.9);  // per second: it must stop rolling
constexpr btScalar kBallDistance = 12;                // from the wall [m]

// With an accurate solver the balls bring down about 3 % of the bricks.
constexpr double kMayFall = 0.1;

/// The shots: a frame, and the wall that is hit as right angles from the first.
struct Shot {
  int frame, wall;
};
constexpr Shot kShots[] = {{60, 0}, {90, 1}, {120, 2}};

int WallCourses(int storeys) { return kCoursesPerStorey * storeys; }
/// Towers are a storey higher than walls.
int TowerCourses(int storeys) { return kCoursesPerStorey * (storeys + 1); }

btScalar MiddleOfWall() {
  return WallLength(kBrick, kWallBricks) / 2 + kTowerHalfSide + kWallToTower;
}

/// One of a course's bricks of a tower. Each side of the ring starts where the one before ends, and
/// every second course runs the other way round, so that joints lie above bricks.
btRigidBody* AddTowerBrick(World* world, const Site& tower, int course, int index) {
  const Site side = tower.Turned(index / 2);
  const btScalar along = (btScalar(index % 2) + btScalar(0.5)) * kBrick.length - kTowerHalfSide;
  const btScalar y = (btScalar(course) + btScalar(0.5)) * kBrick.height;
  return AddBrick(world, kBrick,
                  side.At(course % 2 == 0 ? along : -along, y, kBrick.depth / 2 - kTowerHalfSide));
}

KnownFacts CastleFacts(int storeys) {
  const int walls = 4 * (BricksInWall(kWallBricks, WallCourses(storeys)) + kMerlons);
  const int towers = 4 * (kTowerBricks * TowerCourses(storeys) + kTowerMerlons);
  const int whole_bricks = 4 * (kWallBricks * WallCourses(storeys) + kMerlons) + towers;
  return {.bodies = walls + towers,
          .top_height_m = (TowerCourses(storeys) + 0.5) * kBrick.height,
          .mass_kg = double(kBrick.mass) * whole_bricks};
}

class Castle : public Scene {
 public:
  using Scene::Scene;

  void BeforeStep(World* world, int frame) override {
    for (const Shot& shot : kShots) {
      if (shot.frame == frame) Shoot(world, shot.wall);
    }
  }

 protected:
  void AddBodies(World* world, int size) override {
    storeys_ = size;
    world->AddGround(60);
    for (int i = 0; i < 4; ++i) {
      const Site side = Site().Turned(i);
      AddBattlementedWall(world, side.Moved(0, 0, MiddleOfWall()));
      AddTower(world, side.Moved(MiddleOfWall(), 0, MiddleOfWall()));
    }
    for (const btRigidBody* brick : world->dynamic_bodies()) Watch(brick, kBrick.height / 2);
  }

  double MayFall() const override { return kMayFall; }

 private:
  void AddBattlementedWall(World* world, const Site& site) {
    const int courses = WallCourses(storeys_);
    AddWall(world, kBrick, site, kWallBricks, courses);
    const btScalar left = -WallLength(kBrick, kWallBricks) / 2;
    const btScalar y = (btScalar(courses) + btScalar(0.5)) * kBrick.height;
    for (int i = 0; i < kMerlons; ++i) {
      const btScalar x = left + (btScalar(2 * i) + btScalar(0.5)) * kBrick.length;
      AddBrick(world, kBrick, site.At(x, y, 0));
    }
  }

  void AddTower(World* world, const Site& site) {
    const int courses = TowerCourses(storeys_);
    for (int course = 0; course < courses; ++course) {
      for (int i = 0; i < kTowerBricks; ++i) {
        AddTowerBrick(world, site, course, i);
      }
    }
    for (int i = 0; i < kTowerMerlons; ++i) AddTowerBrick(world, site, courses, 2 * i);
  }

  /// Straight at the middle of a wall, aimed a little high for the drop on the way.
  void Shoot(World* world, int wall) {
    const Site side = Site().Turned(wall);
    const btScalar height = btScalar(WallCourses(storeys_)) * kBrick.height / 2;
    btRigidBody* ball = world->AddSphere(
        kBallRadius,
        {.mass = kBallMass, .pose = side.At(0, height + 1, MiddleOfWall() + kBallDistance)});
    ball->setDamping(0, kBallSpinDamping);
    ball->setLinearVelocity(side.frame.getBasis() * btVector3(0, 0, -kBallSpeed));
  }

  int storeys_ = 0;
};

}  // namespace

SceneInfo CastleScene() {
  return {.name = "castle",
          .description = "Four brick walls and corner towers; three heavy balls are shot at it",
          .size_means = "storeys of the walls",
          .default_size = 3,
          .min_size = 1,
          .max_size = 8,
          .motion = SceneInfo::Motion::kComesToRest,
          .known_facts = CastleFacts,
          .make = MakeThat<Castle>};
}

}  // namespace cairn::bench
