// SPDX-License-Identifier: MIT
#include "block_steps.h"

namespace cairn {
namespace {

/// Rows that a kernel relaxes in the time of one row in double precision: what a step costs is
/// counted in those.
constexpr double kKernelGain = 10;

}  // namespace

void BlockSteps::Begin(const ContactProblem& problem, const Settings& settings, BlockFrame* frame,
                       IslandMemories* memories) {
  problem_ = &problem;
  settings_ = &settings;
  frame_ = frame;
  memories_ = memories;
  packer_.reset();
  const bool asked = settings.method == Method::kPgsSm && settings.k_sm > 0;
  states_.clear();
  if (!asked) return;
  if (plan_number_ != frame->plan_number()) FindRows();
  states_.resize(islands_.size());
}

void BlockSteps::FindRows() {
  const Plan& plan = frame_->plan();
  plan_number_ = frame_->plan_number();
  islands_ = FindIslands(*problem_);
  place_.resize(problem_->rows.size());
  for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    for (int lane = 0; lane < block.lanes; ++lane) {
      int line = static_cast<int>(block.x);
      for (int row : plan.rows_of(plan.pair(b, lane))) place_[row] = line++ * simd::kLanes + lane;
    }
  }
}

BlockSteps::State& BlockSteps::StateOf(int island) {
  State& state = states_[island];
  if (state.memory == nullptr) {
    state.memory = memories_->Recall(*problem_, islands_[island].bodies);
  }
  return state;
}

bool BlockSteps::Pays(int island, BudgetMeter* meter, double sweep_units) {
  if (states_.empty() || islands_[island].bodies.empty()) return false;
  State& state = StateOf(island);
  const double rows = static_cast<double>(islands_[island].rows.size());
  if (!state.memory->Due(rows, *settings_, {meter, kKernelGain, sweep_units})) return false;
  if (!packer_) packer_.emplace(*problem_, *settings_, frame_->bodies());
  if (!state.packed) state.packed = packer_->Pack(islands_[island]);
  return state.memory->StepPays(*state.packed, *settings_, {meter, kKernelGain, sweep_units});
}

int BlockSteps::Take(int island, BudgetMeter* meter) {
  State& of = states_[island];
  IslandState state;
  Read(island, *of.packed, &state);
  meter->Begin();
  const StepResult result =
      TakeStep(*of.packed, of.memory->Step(*settings_), &of.memory->system(), &state);
  meter->Charge(WorkKind::kStep,
                kKernelGain * of.memory->Cost(*of.packed, *settings_, result.factorisations));
  if (!result.solved) return 0;
  Write(island, state);
  return result.factorisations;
}

void BlockSteps::Judge(int island, bool accepted) {
  if (accepted) {
    states_[island].memory->Accepted();
  } else {
    states_[island].memory->Restored();
  }
}

void BlockSteps::Read(int island, const PackedIsland& packed, IslandState* state) const {
  const std::vector<int>& rows = islands_[island].rows;
  state->x.resize(rows.size());
  for (size_t k = 0; k < rows.size(); ++k) {
    const int place = place_[rows[k]];
    const simd::Line& line = frame_->blocks().x[place / simd::kLanes];
    state->x[k] = static_cast<double>(line.lane[place % simd::kLanes]);
  }
  state->u.resize(packed.bodies + 1);
  RecomputeVelocities(packed, state);
}

void BlockSteps::Write(int island, const IslandState& state) const {
  const Island& of = islands_[island];
  for (size_t k = 0; k < of.rows.size(); ++k) {
    const int place = place_[of.rows[k]];
    simd::Line& line = frame_->blocks().x[place / simd::kLanes];
    line.lane[place % simd::kLanes] = static_cast<float>(state.x[k]);
  }
  for (size_t i = 0; i < of.bodies.size(); ++i) {
    const int slot = frame_->plan().slot_of_body()[of.bodies[i]];
    float* const u = frame_->blocks().bodies[slot].u;
    for (int k = 0; k < 3; ++k) {
      u[k] = static_cast<float>(state.u[i + 1][k]);
      u[4 + k] = static_cast<float>(state.u[i + 1][3 + k]);
    }
  }
}

}  // namespace cairn
