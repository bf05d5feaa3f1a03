// SPDX-License-Identifier: MIT
#include "step/block_step.h"

#include <algorithm>
#include <cmath>

#include "simd/flush_denormals.h"

namespace cairn {
namespace {

using simd::kLanes;

/// How close to a bound counts as at the bound, relative to the mean impulse of the island. Floats
/// know impulses no better.
constexpr double kActiveTolerance = 1e-6;

/// Where an island is in a step.
enum Phase : char {
  kOpen,       ///< its set is predicted, or rows were removed from it: to be solved
  kRefined,    ///< solved, and its set held
  kTakenBack,  ///< the last solve is
  kDone,
};

}  // namespace

template <class T>
int BlockStep<T>::Take(const Plan& plan, int group, int refinements, BlockSystem<T>* system,
                       Crew* crew, BlockData* blocks, std::span<IslandStep> islands,
                       Deadline* deadline) {
  const simd::FlushDenormals flush;
  plan_ = &plan;
  group_ = &plan.groups()[group];
  blocks_ = blocks;
  system_ = system;
  islands_ = islands;
  deadline_ = deadline;
  const int made = Find(refinements, crew);
  if (deadline_ != nullptr && deadline_->passed()) {
    // what was left undone on the way is of no use
    ForIslands([this](int island) { islands_[island].result = {}; });
  } else {
    deadline_ = nullptr;  // from here on it is done to the end
    Write();
  }
  return made;
}

template <class T>
int BlockStep<T>::Find(int refinements, Crew* crew) {
  Read();
  Predict();

  // those from whose sets rows had to be removed, again; others are done when they are refined
  int made = 0;
  for (; CloseAfter(made), Any(kOpen) && !Passes(deadline_); ++made) {
    WorkOn(kOpen);
    ForBlocks(kernels_.find_weights);
    const bool factorised =
        system_->Factorise(*plan_, *group_, *blocks_, weights_, &of_blocks_, crew, deadline_);
    ForIslands([&](int island) {
      if (phases_[island] != kOpen) return;
      ++islands_[island].result.factorisations;
      islands_[island].result.solved = factorised;
      phases_[island] = factorised ? kRefined : kDone;
    });
    if (!factorised) break;
    if (made > 0) CopyTaken(start_, &x_);
    Refine();
    Remove();
    RefineWhileSetHolds(refinements);
  }
  if (Passes(deadline_)) return made;
  if (bounded_) ForBlocks(kernels_.project);
  FindJointSpeeds(&StepResult::solved_joint_speed);
  if (CondenseJoints(crew)) ++made;
  return made;
}

template <class T>
void BlockStep<T>::Predict() {
  bounded_ = free_ = false;
  for (const auto& block : plan_->blocks().subspan(group_->first_block, group_->blocks)) {
    for (const simd::RowShape& row : std::span(block.rows, block.row_count)) {
      (row.bound == simd::RowBound::kFree ? free_ : bounded_) = true;
    }
  }
  if (!bounded_) {
    // no row can leave the set
    std::fill(sides_.begin(), sides_.end(), simd::SideLine{});
    return;
  }
  start_ = x_;
  ReadVelocities();
  FindRelativeVelocities();
  ForBlocks(kernels_.predict);
}

template <class T>
void BlockStep<T>::ReadVelocities() {
  for (int slot = group_->first_slot; slot < group_->first_slot + group_->slots; ++slot) {
    const int node = system_->node_of_slot(slot);
    if (node < 0) continue;
    const float* const u = blocks_->bodies[slot].u;
    for (int k = 0; k < 3; ++k) {
      u_[6 * node + k] = static_cast<T>(u[k]);
      u_[6 * node + 3 + k] = static_cast<T>(u[4 + k]);
    }
  }
}

template <class T>
template <class Function>
void BlockStep<T>::ForIslands(const Function& function) {
  for (int i : plan_->islands_in(*group_)) {
    function(i);
  }
}

template <class T>
bool BlockStep<T>::Any(char phase) {
  bool any = false;
  ForIslands([&](int island) { any = any || phases_[island] == phase; });
  return any;
}

template <class T>
void BlockStep<T>::CloseAfter(int factorisations) {
  ForIslands([&](int island) {
    const bool most = factorisations >= islands_[island].factorisations;
    if (phases_[island] == kOpen && most) phases_[island] = kDone;
  });
}

template <class T>
void BlockStep<T>::WorkOn(char phase) {
  for (int b = 0; b < group_->blocks; ++b) {
    const simd::PairBlock& block = plan_->blocks()[group_->first_block + b];
    for (int l = 0; l < block.lanes; ++l) {
      const int island = plan_->island_of(group_->first_block + b, l);
      lanes_[b].taken.lane[l] = phases_[island] == phase ? 1 : 0;
    }
  }
}

template <class T>
template <class Lines>
void BlockStep<T>::CopyTaken(const Lines& from, Lines* to) {
  ForBlocks([&](const simd::PairActiveSet<T>& set) {
    const auto first = static_cast<size_t>(set.x - x_.data());
    for (int i = 0; i < set.block.row_count; ++i) {
      for (int l = 0; l < kLanes; ++l) {
        auto& number = (*to)[first + i].lane[l];
        number = set.lanes.taken.lane[l] != 0 ? from[first + i].lane[l] : number;
      }
    }
  });
}

template <class T>
template <class Function>
void BlockStep<T>::ForBlocks(const Function& function) {
  for (int b = 0; b < group_->blocks && !Passes(deadline_, b); ++b) function(ActiveSetOf(b));
}

template <class T>
simd::PairActiveSet<T> BlockStep<T>::ActiveSetOf(int b) {
  const simd::PairBlock& block = plan_->blocks()[group_->first_block + b];
  const size_t x = block.x - static_cast<size_t>(group_->first_x);
  return {.block = block,
          .lines = blocks_->data.data() + block.data,
          .lanes = lanes_[b],
          .x = x_.data() + x,
          .w = w_.data() + x,
          .weights = weights_.data() + x,
          .product = product_.data() + x,
          .sides = sides_.data() + x};
}

template <class T>
void BlockStep<T>::Read() {
  const auto lines = static_cast<size_t>(group_->x_lines);
  for (auto* of_rows : {&x_, &w_, &weights_, &product_}) of_rows->resize(lines);
  sides_.resize(lines);
  u_.resize(6 * static_cast<size_t>(system_->nodes()));
  du_.resize(u_.size());
  wanted_.resize(u_.size());
  for (size_t i = 0; i < lines; ++i) {
    const simd::Line& x = blocks_->x[static_cast<size_t>(group_->first_x) + i];
    for (int l = 0; l < kLanes; ++l) x_[i].lane[l] = static_cast<T>(x.lane[l]);
  }
  phases_.assign(islands_.size(), kDone);
  ForIslands([&](int island) {
    if (islands_[island].taken) phases_[island] = kOpen;
    islands_[island].result = {};
  });

  FindTolerances();
  lanes_.resize(group_->blocks);
  for (int b = 0; b < group_->blocks; ++b) {
    simd::LaneSettings<T>& lanes = lanes_[b];
    const simd::PairBlock& block = plan_->blocks()[group_->first_block + b];
    for (int l = 0; l < kLanes; ++l) {
      const int island = l < block.lanes ? plan_->island_of(group_->first_block + b, l) : -1;
      const bool taken = island >= 0 && islands_[island].taken;
      lanes.taken.lane[l] = 0;
      lanes.proximal.lane[l] = taken ? static_cast<T>(islands_[island].proximal) : 1;
      lanes.proximal_joints.lane[l] = taken ? static_cast<T>(islands_[island].proximal_joints) : 1;
      lanes.tolerance.lane[l] =
          taken ? static_cast<T>(kActiveTolerance * sums_[island] / counts_[island]) : 0;
    }
  }
}

template <class T>
void BlockStep<T>::FindTolerances() {
  sums_.assign(islands_.size(), 0);
  counts_.assign(islands_.size(), 0);
  for (const simd::LaneRun& run : plan_->runs_of(*group_)) {
    const simd::PairBlock& block = plan_->blocks()[run.block];
    double of_lanes[kLanes] = {};
    for (const simd::Line& x : std::span(blocks_->x).subspan(block.x, block.row_count)) {
      for (int l = 0; l < kLanes; ++l) of_lanes[l] += std::abs(static_cast<double>(x.lane[l]));
    }
    for (int l = run.first; l < run.first + run.lanes; ++l) {
      const int island = plan_->island_of(run.block, l);
      sums_[island] += of_lanes[l];
      counts_[island] += block.row_count;
    }
  }
}

template <class T>
void BlockStep<T>::MultiplyTransposed(const Array<LineT>& y, Array<T>* v) {
  std::fill(v->begin(), v->end(), T{0});
  const auto runs = plan_->runs_of(*group_);
  const RunResults results(*group_, simd::kPairLines, &of_blocks_);
  for (size_t r = 0; r < runs.size() && !Passes(deadline_, static_cast<int>(r)); ++r) {
    const simd::LaneRun& run = runs[r];
    LineT* const of_pair = results.Of(run);
    const simd::PairBlock& block = plan_->blocks()[run.block];
    if (run.first == 0) {
      products_.multiply_transposed(block, blocks_->data.data() + block.data,
                                    y.data() + (block.x - static_cast<size_t>(group_->first_x)),
                                    of_pair);
    }
    const auto add = [&](int slot, int lane, const LineT* lines) {
      const auto [node, share] = system_->SeenAt(*plan_, slot);
      for (int k = 0; k < 6 && node >= 0; ++k) (*v)[6 * node + k] += share * lines[k].lane[lane];
    };
    for (int l = run.first; l < run.first + run.lanes; ++l) {
      add(block.a[l], l, of_pair);
      if (block.form != simd::PairForm::kSingle) add(block.b[l], l, of_pair + 6);
    }
  }
}

template <class T>
void BlockStep<T>::Multiply(const Array<T>& v, Array<LineT>* y) {
  LineT of_pair[simd::kPairLines] = {};
  for (int b = 0; b < group_->blocks && !Passes(deadline_, b); ++b) {
    const simd::PairActiveSet<T> set = ActiveSetOf(b);
    const simd::PairBlock& block = set.block;
    const auto get = [&](int slot, int lane, LineT* lines) {
      const auto [node, share] = system_->SeenAt(*plan_, slot);
      for (int k = 0; k < 6; ++k) lines[k].lane[lane] = node < 0 ? T{0} : share * v[6 * node + k];
    };
    for (int l = 0; l < block.lanes; ++l) {
      get(block.a[l], l, of_pair);
      if (block.form != simd::PairForm::kSingle) get(block.b[l], l, of_pair + 6);
    }
    products_.multiply(block, set.lines, of_pair,
                       y->data() + (block.x - static_cast<size_t>(group_->first_x)));
  }
}

template <class T>
void BlockStep<T>::FindRelativeVelocities() {
  Multiply(u_, &w_);
  ForBlocks(kernels_.find_relative_velocities);
}

/// One solve for the free rows:  H du = G_F' W r,  x_F += W (r - G_F du)  with  r = -w_F.
template <class T>
void BlockStep<T>::Refine() {
  if (bounded_) ForBlocks(kernels_.fix);
  MultiplyTransposed(x_, &u_);
  FindRelativeVelocities();
  ForBlocks(kernels_.weigh);
  MultiplyTransposed(product_, &du_);
  system_->Solve(du_, deadline_);
  Multiply(du_, &product_);
  ForBlocks(kernels_.advance);
}

/// Solves again with the same factor while the predicted set holds: each time the error of a mode
/// with eigenvalue l (relative to d) shrinks by eps / (eps + l), and redundant rows drift apart by
/// what they contradict each other. The solve after which a row leaves its bounds is taken back.
template <class T>
void BlockStep<T>::RefineWhileSetHolds(int refinements) {
  for (int k = 1; k < refinements && Any(kRefined) && !Passes(deadline_); ++k) {
    WorkOn(kRefined);
    ForBlocks(kernels_.find_weights);
    before_ = x_;
    sides_before_ = sides_;
    Refine();
    // removing makes those islands open; here that means taking it back
    const Array<char>& phases = phases_before_ = phases_;
    Remove();
    ForIslands([&](int island) {
      if (phases_[island] != phases[island]) phases_[island] = kTakenBack;
    });
    WorkOn(kTakenBack);
    CopyTaken(before_, &x_);
    CopyTaken(sides_before_, &sides_);
    ForIslands([&](int island) {
      if (phases_[island] == kTakenBack) phases_[island] = kDone;
    });
  }
  ForIslands([&](int island) {
    if (phases_[island] == kRefined) phases_[island] = kDone;
  });
}

template <class T>
void BlockStep<T>::Remove() {
  if (!bounded_) return;
  for (int b = 0; b < group_->blocks; ++b) {
    const std::uint32_t removed = kernels_.remove_violated(ActiveSetOf(b));
    for (int l = 0; l < kLanes && removed != 0; ++l) {
      if ((removed >> l & 1) == 0) continue;
      phases_[plan_->island_of(group_->first_block + b, l)] = kOpen;
    }
  }
}

template <class T>
void BlockStep<T>::MultiplyWeighted(Array<T>* out) {
  ForBlocks(kernels_.copy_weighted);
  MultiplyTransposed(product_, out);
}

/// Solves  (G_J G_J' + eps D) dx_J = G_J (v - G_J' x_J)  some times, from x_J = 0. Its right-hand
/// side lies in the range of G_J, so that nothing comes of what joints contradict each other.
template <class T>
void BlockStep<T>::FindSmallest() {
  MultiplyWeighted(&wanted_);
  ForBlocks(kernels_.clear_weighted);
  for (int k = 0; k < kCondensingSolves && !Passes(deadline_); ++k) {
    MultiplyWeighted(&u_);
    for (size_t i = 0; i < u_.size(); ++i) u_[i] = wanted_[i] - u_[i];
    Multiply(u_, &w_);
    for (size_t i = 0; i < x_.size(); ++i) {
      for (int l = 0; l < kLanes; ++l) {
        product_[i].lane[l] = weights_[i].lane[l] != 0 ? weights_[i].lane[l] * w_[i].lane[l] : T{0};
      }
    }
    MultiplyTransposed(product_, &du_);
    system_->Solve(du_, deadline_);
    Multiply(du_, &product_);
    for (size_t i = 0; i < x_.size(); ++i) {
      for (int l = 0; l < kLanes; ++l) {
        if (weights_[i].lane[l] == 0) continue;
        x_[i].lane[l] += weights_[i].lane[l] * (w_[i].lane[l] - product_[i].lane[l]);
      }
    }
  }
}

template <class T>
bool BlockStep<T>::CondenseJoints(Crew* crew) {
  bool any = false;
  ForIslands([&](int island) {
    const bool wanted = islands_[island].condense_joints && islands_[island].result.solved;
    phases_[island] = wanted ? kOpen : kDone;
    any = any || wanted;
  });
  if (any) {
    WorkOn(kOpen);
    ForBlocks(kernels_.find_joint_weights);
    before_ = x_;
    if (system_->Factorise(*plan_, *group_, *blocks_, weights_, &of_blocks_, crew, deadline_)) {
      FindSmallest();
    }
  }
  FindJointSpeeds(&StepResult::joint_speed);
  if (!any) return false;
  ForIslands([&](int island) {
    StepResult& result = islands_[island].result;
    if (phases_[island] != kOpen || result.joint_speed <= kCondensed * result.solved_joint_speed) {
      return;
    }
    phases_[island] = kTakenBack;
    result.joint_speed = result.solved_joint_speed;
  });
  WorkOn(kTakenBack);
  CopyTaken(before_, &x_);
  return true;
}

template <class T>
void BlockStep<T>::FindJointSpeeds(double StepResult::*of) {
  if (!free_) return;
  for (int b = 0; b < group_->blocks; ++b) {
    const simd::PairBlock& block = plan_->blocks()[group_->first_block + b];
    const LineT speeds = kernels_.find_joint_speeds(ActiveSetOf(b));
    for (int l = 0; l < block.lanes; ++l) {
      double& speed = islands_[plan_->island_of(group_->first_block + b, l)].result.*of;
      speed = std::max(speed, static_cast<double>(speeds.lane[l]));
    }
  }
}

template <class T>
void BlockStep<T>::Write() {
  // u from the impulses as floats have them
  for (LineT& x : x_) {
    for (int l = 0; l < kLanes; ++l) x.lane[l] = static_cast<T>(static_cast<float>(x.lane[l]));
  }
  MultiplyTransposed(x_, &u_);

  for (int b = 0; b < group_->blocks; ++b) {
    const simd::PairActiveSet<T> set = ActiveSetOf(b);
    const simd::PairBlock& block = set.block;
    const auto write = [&](int seen) {
      const int slot = plan_->own_slot(seen);
      const int node = system_->node_of_slot(slot);
      if (node < 0) return;
      float* const u = blocks_->bodies[slot].u;
      for (int k = 0; k < 3; ++k) {
        u[k] = static_cast<float>(u_[6 * node + k]);
        u[4 + k] = static_cast<float>(u_[6 * node + 3 + k]);
      }
    };
    for (int l = 0; l < block.lanes; ++l) {
      if (!islands_[plan_->island_of(group_->first_block + b, l)].result.solved) continue;
      for (int i = 0; i < block.row_count; ++i) {
        blocks_->x[block.x + i].lane[l] = static_cast<float>(set.x[i].lane[l]);
      }
      write(block.a[l]);
      if (block.form != simd::PairForm::kSingle) write(block.b[l]);
    }
  }
}

template class BlockStep<float>;
template class BlockStep<double>;

}  // namespace cairn
