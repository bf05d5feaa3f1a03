// SPDX-License-Identifier: MIT
#include "accuracy/grid/grid_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "scenes/facts.h"

namespace cairn::accuracy {
namespace {

constexpr int kLightBoxes = 4;
/// Of the heavy box [m/s]: it stays above the others for as long as a run takes, without friction
/// too.
constexpr btScalar kPush = btScalar(0.05);
constexpr btScalar kLinkLength = 1, kLinkThickness = btScalar(0.2), kBallRadius = btScalar(0.5);
constexpr btScalar kSlope = btScalar(3.14159265 / 6);  // of a chain at the start, from the vertical

struct Ranges {
  std::initializer_list<double> ratios, rates, frictions;
  std::initializer_list<int> links;
};

std::vector<Cell> CellsOf(const Ranges& ranges) {
  std::vector<Cell> cells;
  for (const double ratio : ranges.ratios) {
    for (const double rate : ranges.rates) {
      for (const double friction : ranges.frictions) {
        cells.push_back({Cell::Kind::kPile, ratio, rate, friction, 0});
      }
    }
  }
  for (const int links : ranges.links) {
    for (const double ratio : ranges.ratios) {
      for (const double rate : ranges.rates) {
        cells.push_back({Cell::Kind::kChain, ratio, rate, 0, links});
      }
    }
  }
  return cells;
}

}  // namespace

std::string NameOf(const Cell& cell) {
  const std::string rest =
      fmt::format("mass ratio 1:{:g}, time step 1/{:g} s", cell.mass_ratio, cell.rate);
  return cell.kind == Cell::Kind::kPile
             ? fmt::format("pile with friction {:g}, {}", cell.friction, rest)
             : fmt::format("chain of {} links, {}", cell.links, rest);
}

std::vector<Cell> AllCells() {
  return CellsOf({.ratios = {1, 10, 100, 1000, 10000},
                  .rates = {30, 60, 120, 240},
                  .frictions = {0, 0.5, 1, 2},
                  .links = {1, 3, 10, 30, 100, 300, 1000}});
}

std::vector<Cell> QuickCells() {
  return CellsOf(
      {.ratios = {1, 100, 10000}, .rates = {30, 240}, .frictions = {0, 2}, .links = {1, 30}});
}

GridWorld::GridWorld(const Cell& cell, btConstraintSolver* solver)
    : world_(solver, btScalar(1 / cell.rate)), kind_(cell.kind) {
  cell.kind == Cell::Kind::kPile ? BuildPile(cell) : BuildChain(cell);
}

void GridWorld::BuildPile(const Cell& cell) {
  // Bullet multiplies the coefficients of two bodies
  const auto own = btScalar(std::sqrt(cell.friction));
  const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  world_.AddBox(btVector3(20, 1, 20), {.pose = bench::At(0, -1, 0), .surface = {.friction = own}});
  btRigidBody* top = nullptr;
  for (int i = 0; i <= kLightBoxes; ++i) {
    top = world_.AddBox(half, {.mass = i < kLightBoxes ? 1 : btScalar(cell.mass_ratio),
                               .pose = bench::At(0, btScalar(i) + btScalar(0.5), 0),
                               .surface = {.friction = own}});
  }
  top->setLinearVelocity(btVector3(kPush, 0, 0));
  built_at_ = bench::TopHeight(world_);
}

void GridWorld::BuildChain(const Cell& cell) {
  const btTransform frame(btQuaternion(btVector3(0, 0, 1), kSlope),
                          btVector3(0, btScalar(cell.links + 4) * kLinkLength, 0));
  const btVector3 half(kLinkThickness / 2, kLinkLength / 2, kLinkThickness / 2);
  const btVector3 top(0, kLinkLength / 2, 0), bottom(0, -kLinkLength / 2, 0);
  btRigidBody* previous = nullptr;
  const auto pin = [&](btRigidBody* body, const btVector3& pivot) {
    auto joint = previous == nullptr
                     ? std::make_unique<btPoint2PointConstraint>(*body, pivot)
                     : std::make_unique<btPoint2PointConstraint>(*body, *previous, pivot, bottom);
    world_.AddJoint(std::move(joint), bench::ConnectedBodies::kPassThrough);
    previous = body;
  };
  for (int i = 0; i < cell.links; ++i) {
    const btScalar y = -(btScalar(i) + btScalar(0.5)) * kLinkLength;
    pin(world_.AddBox(half, {.mass = 1, .pose = frame * bench::At(0, y, 0)}), top);
  }
  const btScalar y = -btScalar(cell.links) * kLinkLength - kBallRadius;
  pin(world_.AddSphere(kBallRadius,
                       {.mass = btScalar(cell.mass_ratio), .pose = frame * bench::At(0, y, 0)}),
      btVector3(0, kBallRadius, 0));
}

double GridWorld::Defect() const {
  if (kind_ == Cell::Kind::kChain) return bench::LargestJointGap(world_);
  return std::max(bench::MaxPenetration(world_), built_at_ - bench::TopHeight(world_));
}

double GridWorld::Energy() const { return bench::TotalEnergy(world_); }

double GridWorld::EnergyScale() const {
  constexpr double kGravity = 9.81;
  return bench::TotalMass(world_) * kGravity;
}

}  // namespace cairn::accuracy
