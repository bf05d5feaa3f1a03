// SPDX-License-Identifier: MIT
#include "run/imported_scene.h"

#include <BulletWorldImporter/btBulletWorldImporter.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "support/failure.h"

namespace cairn::cli {
namespace {

/// Enough of the file's name to know it by; the importer takes no constant buffer.
struct SavedWorld {
  std::string name;
  std::vector<char> bytes;
};

/// The importer makes what is in the file; it must not change the settings of the world.
class Importer : public btBulletWorldImporter {
 public:
  explicit Importer(btDynamicsWorld* world) : btBulletWorldImporter(world) {}

  void setDynamicsWorldInfo(const btVector3& gravity, const btContactSolverInfo&) override {
    m_dynamicsWorld->setGravity(gravity);
  }
};

class ImportedScene : public bench::Scene {
 public:
  ImportedScene(const bench::SceneInfo& info, std::shared_ptr<const SavedWorld> saved)
      : Scene(info), saved_(std::move(saved)) {}

 protected:
  void AddBodies(bench::World* world, int) override {
    const auto importer = std::make_shared<Importer>(world->bullet());
    std::vector<char> bytes = saved_->bytes;  // parsing writes into it
    importer->loadFileFromMemory(bytes.data(), static_cast<int>(bytes.size()));
    world->Adopt([importer] { importer->deleteAllData(); });
  }

 private:
  std::shared_ptr<const SavedWorld> saved_;
};

std::shared_ptr<SavedWorld> Read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Failure(kBadInput, fmt::format("cannot read '{}'", path));
  auto saved = std::make_shared<SavedWorld>();
  saved->name = std::filesystem::path(path).filename().string();
  saved->bytes.assign(std::istreambuf_iterator<char>(file), {});
  // the parser of Bullet prints and goes on with a file that is none
  const std::string magic(saved->bytes.data(), std::min<size_t>(saved->bytes.size(), 6));
  if (magic != "BULLET") {
    throw Failure(kBadInput, fmt::format("'{}' is not a file of Bullet's serializer", path));
  }
  return saved;
}

/// What the file gives, to be told before a run.
void CheckBodies(const SceneChoice& choice, const std::string& path) {
  btSequentialImpulseConstraintSolver solver;
  bench::World world(&solver);
  const std::unique_ptr<bench::Scene> scene = choice.make();
  scene->Build(&world, {});
  if (world.dynamic_bodies().empty()) {
    throw Failure(kBadInput, fmt::format("'{}' has no rigid body with mass (multi-bodies are not "
                                         "read)",
                                         path));
  }
}

}  // namespace

SceneChoice ImportScene(const std::string& path, std::uint64_t seed) {
  const std::shared_ptr<SavedWorld> saved = Read(path);
  SceneChoice choice{.info = nullptr, .make = {}, .size = 1, .seed = seed};
  // the name lives as long as the information does
  choice.info = std::shared_ptr<const bench::SceneInfo>(
      new bench::SceneInfo{.name = saved->name,
                           .description = "A world that Bullet saved",
                           .size_means = "",
                           .default_size = 1,
                           .min_size = 1,
                           .max_size = 1,
                           .motion = bench::SceneInfo::Motion::kKeepsMoving,
                           .known_facts = nullptr,
                           .make = nullptr},
      [saved](const bench::SceneInfo* info) { delete info; });
  choice.make = [info = choice.info, saved] {
    return std::make_unique<ImportedScene>(*info, saved);
  };
  CheckBodies(choice, path);
  return choice;
}

}  // namespace cairn::cli
