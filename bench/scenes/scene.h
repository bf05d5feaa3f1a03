// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "scenes/world.h"

namespace cairn::bench {

class Scene;

struct SceneOptions {
  int size = 0;  ///< In the scene's own unit; 0: its default.
  /// 0: as designed. Otherwise every dynamic body is displaced by up to 1e-4 m, the same way each
  /// time for the same seed.
  std::uint64_t seed = 0;
  /// Of friction at a contact, 1 or 2; random worlds draw their own.
  int friction_directions = 2;
};

/// What is true of a scene right after it was built with seed 0.
struct KnownFacts {
  int bodies = 0;  ///< Dynamic bodies.
  int joints = 0;
  double top_height_m = 0;  ///< Of the highest centre of mass.
  double mass_kg = 0;       ///< Of the dynamic bodies.
};

/// What has become of a scene. NaN where a fact does not apply to it.
struct SceneFacts {
  /// Standing unless watched bodies sank by more than they may: any of them, or in the castle,
  /// which is shot at, more than a tenth. Not applicable to scenes in which nothing is to stand.
  enum class Verdict { kStanding, kFallen, kNotApplicable };

  /// How much lower than built the watched bodies are, on average: tops of stacks, top course of
  /// the wall, middle of the bridge, every brick of the castle. How much longer than built the
  /// chain is. NaN for piles that are dropped.
  double height_lost_m;
  double joint_gap_m;        ///< LargestJointGap(); NaN without joints.
  double penetration_m;      ///< MaxPenetration().
  double speed_at_rest_m_s;  ///< LargestSpeed(); NaN for scenes that never come to rest.
  Verdict verdict = Verdict::kNotApplicable;
};

/// A scene as the list shows it.
struct SceneInfo {
  enum class Motion { kComesToRest, kKeepsMoving };

  std::string_view name, description;
  std::string_view size_means;  ///< For example "boxes in the base row".
  int default_size, min_size, max_size;
  Motion motion;
  KnownFacts (*known_facts)(int size);
  std::unique_ptr<Scene> (*make)(const SceneInfo& info);
};

/// One scene in one world:
///
///     const std::unique_ptr<Scene> scene = Make(*FindScene("castle"));
///     scene->Build(&world, {});
///     for (int frame = 0; frame < 600; ++frame) {
///       scene->BeforeStep(&world, frame);
///       world.Step();
///     }
///     const SceneFacts facts = scene->Measure(world);
class Scene {
 public:
  explicit Scene(const SceneInfo& info) : info_(info) {}
  virtual ~Scene() = default;

  const SceneInfo& info() const { return info_; }

  /// Adds the bodies and joints. Once per scene.
  /// @pre `world` is empty and outlives the scene.
  /// @throws std::out_of_range if the size is neither 0 nor within [min_size, max_size].
  void Build(World* world, const SceneOptions& options);

  /// Whatever happens from outside in a frame, counted from 0: to be called before each step.
  virtual void BeforeStep(World* world, int frame);

  SceneFacts Measure(const World& world) const;

 protected:
  virtual void AddBodies(World* world, int size) = 0;

  /// Counts a body in height_lost_m, and as fallen once it is lower than built by `may_sink` [m].
  void Watch(const btRigidBody* body, btScalar may_sink);

  /// The share of watched bodies that may fall while the scene still counts as standing, in [0, 1].
  virtual double MayFall() const { return 0; }

  /// height_lost_m [m].
  virtual double HeightLost(const World& world) const;

 private:
  struct Watched {
    const btRigidBody* body;
    double built_at, may_sink;  ///< [m]

    double Height() const { return body->getCenterOfMassPosition().y(); }
    double Sunk() const { return built_at - Height(); }
  };

  SceneInfo info_;
  std::vector<Watched> watched_;
};

/// All scenes.
std::span<const SceneInfo> Scenes();

/// The scene of that name, or nullptr.
const SceneInfo* FindScene(std::string_view name);

std::unique_ptr<Scene> Make(const SceneInfo& info);

/// For SceneInfo::make.
template <class ThatScene>
std::unique_ptr<Scene> MakeThat(const SceneInfo& info) {
  return std::make_unique<ThatScene>(info);
}

}  // namespace cairn::bench
