// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenes/world.h"

namespace cairn::accuracy {

/// One small world of the grid.
struct Cell {
  enum class Kind {
    kPile,   ///< Four boxes of 1 kg and 1 m below a heavy one that is pushed to the side a little.
    kChain,  ///< Links of 1 kg and 1 m with a heavy ball at the end, which swing.
  };
  Kind kind = Kind::kPile;
  double mass_ratio = 1;  ///< Heaviest body to all others.
  double rate = 60;       ///< Steps in a second.
  double friction = 0.5;  ///< Of piles, between two bodies.
  int links = 0;          ///< Of chains.
};

/// "pile of mass ratio 1:100, friction 0.5, time step 1/60 s"
std::string NameOf(const Cell& cell);

/// Every cell: mass ratios 1:1 to 1:10,000, time steps 1/30 s to 1/240 s, friction 0 to 2, chains
/// of 1 to 1000 links.
std::vector<Cell> AllCells();
/// A few of them from the ends of each range, chains of 30 links at most.
std::vector<Cell> QuickCells();

/// The bodies and joints of a cell in a Bullet world.
class GridWorld {
 public:
  /// @param solver  is not owned
  GridWorld(const Cell& cell, btConstraintSolver* solver);

  void Step() { world_.Step(); }
  bench::World& world() { return world_; }

  /// What an accurate solver keeps small [m]: penetration and height lost of a pile, gaps of a
  /// chain.
  double Defect() const;
  double Energy() const;  ///< TotalEnergy() [J].
  /// What energies are compared with: lifting all bodies by 1 m [J].
  double EnergyScale() const;

 private:
  void BuildPile(const Cell& cell);
  void BuildChain(const Cell& cell);

  bench::World world_;
  double built_at_ = 0;  ///< Height of the top of a pile [m].
  Cell::Kind kind_;
};

}  // namespace cairn::accuracy
