// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "micro/row_scene.h"
#include "simd/pairs/pair_sweep.h"

namespace cairn::micro {

/// Rows as the kernels read them, and what the kernels write.
class PairScene {
 public:
  explicit PairScene(const RowScene& scene);
  // blocks point into layouts
  PairScene(const PairScene&) = delete;
  PairScene& operator=(const PairScene&) = delete;

  /// All at rest again.
  void Reset();
  simd::PairWork Work();

  int rows() const { return rows_; }
  /// Lines of rows and impulses and bodies, each once a visit.
  std::size_t bytes_per_sweep() const;
  /// What a sweep touches in all.
  std::size_t working_set() const;

  /// In the order of RowScene::rows.
  std::vector<float> Impulses() const;
  /// The natural residual of the last pass that measured, in the energy norm [J].
  double MeasuredEnergy() const;
  /// No number is infinite, none or too small for a normal float.
  bool IsSound() const;

 private:
  void AddBlock(const RowScene& scene, int first_pair);

  std::vector<std::vector<simd::RowShape>> layouts_;
  std::vector<simd::PairBlock> blocks_;
  std::vector<simd::LaneRun> runs_;  ///< each a block
  std::vector<simd::Line> data_, x_;
  std::vector<simd::BodyLane> bodies_;
  std::vector<simd::BlockError> errors_;
  int rows_;
};

}  // namespace cairn::micro
