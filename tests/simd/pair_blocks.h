// SPDX-License-Identifier: MIT
// Scenes of pair blocks for the tests of the vector kernels.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "simd/pairs/pair_sweep.h"

namespace cairn::simd::test {

struct BlockSpec {
  PairForm form = PairForm::kContact;
  std::vector<RowShape> rows;
  int lanes = kLanes;      ///< in use
  bool like_next = false;  ///< @pre the next has the same form and rows, and is not like its next
};

/// What a scene is made of.
struct SceneSpec {
  std::vector<BlockSpec> blocks;
  int bodies = 40;    ///< that can move, at least 2 kLanes, 4 where two blocks are alike
  float unused = 0;   ///< in unused lanes, in lines of no block, and in bodies that no lane names
  unsigned seed = 1;  ///< RandomScene()
};

/// The lines of one row; null where the row has none.
struct RowView {
  Line* g;
  Line* target = nullptr;
  Line* step = nullptr;
  Line* compliance = nullptr;
  Line* relaxation = nullptr;
  Line* bounds = nullptr;
  Line* coupling = nullptr;
};

/// Owns what a PairWork points to. Copies are independent.
struct PairScene {
  std::vector<std::vector<RowShape>> shapes;  ///< for each block
  std::vector<PairBlock> blocks;
  std::vector<LaneRun> runs;  ///< blocks as they are, or cut by CutRuns()
  std::vector<Line> data, x;
  std::vector<BodyLane> bodies;  ///< and what there is of copies behind them
  std::vector<BodyCopy> copies;  ///< see ShareBodies()
  std::vector<Line> d_ratios;
  std::vector<BlockError> errors;
  int sweep = 0;
  bool hold_lifted = false;

  /// Fills in the couplings of all blocks.
  void Couple(const PairKernels& kernels);
  /// With the couplings that the reference finds.
  void Run(PairKernels::Kernel kernel);

  /// c_a and c_b. @pre the block is of form kContact
  Line* PairOf(int block) { return data.data() + blocks[block].data; }
  RowView View(int block, int row);
  float& X(int block, int row, int lane) { return x[blocks[block].x + row].lane[lane]; }
  BodyLane& BodyA(int block, int lane) { return bodies[blocks[block].a[lane]]; }
  BodyLane& BodyB(int block, int lane) { return bodies[blocks[block].b[lane]]; }
};

/// All numbers are zero, and lane l has the bodies 2 l + 1 and 2 l + 2.
PairScene ZeroScene(const SceneSpec& spec);

/// Other bodies in every block, moving in all directions; impulses of any size, of which some are
/// zero, and bounds that they break. Steps suit the rows: sweeps converge as a rule. The same
/// numbers with every standard library.
PairScene RandomScene(const SceneSpec& spec);

/// Cuts blocks into runs, in an order of its own, and lets lanes of different runs share bodies.
/// @pre it is a RandomScene() and no blocks are alike
void CutRuns(unsigned seed, PairScene* scene);

/// Lets lanes of some runs see copies of bodies that they share.
void ShareBodies(unsigned seed, PairScene* scene);

/// Contact points of a pair: a row that pushes for each, then the friction of each.
struct ManifoldSpec {
  int points = 4;
  int friction_rows = 2;  ///< of a point
  int rolling_rows = 0;   ///< of a point: angular, bounded as friction is
  bool relaxed = false;
};
std::vector<RowShape> Manifold(const ManifoldSpec& spec);

/// The same numbers with every standard library: call it once in an expression.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  float Uniform(float lo, float hi) {
    return lo + static_cast<float>(engine_() >> 8) * 0x1p-24f * (hi - lo);
  }
  /// Of a size in [0.2, 1), so that a row of such numbers has a step that is not huge.
  float Signed() {
    const float size = Uniform(0.2f, 1);
    return Index(2) ? size : -size;
  }
  int Index(int size) { return static_cast<int>(engine_() % static_cast<unsigned>(size)); }

 private:
  std::mt19937 engine_;
};

/// 1 to @p most rows of all kinds; what bounds friction comes first.
std::vector<RowShape> RandomRows(int most, Random* random);
/// Blocks of all forms and sizes.
SceneSpec RandomSpec(unsigned seed);

/// Impulses and errors in lanes that are used, and all bodies, to the bit.
testing::AssertionResult SameBits(const PairScene& a, const PairScene& b);

/// Whether no impulse in use and no body is infinite or NaN.
testing::AssertionResult IsFinite(const PairScene& scene);

}  // namespace cairn::simd::test
