// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "cairn/detail/memory.h"
#include "cycle/cycle_frame.h"
#include "step/block_step.h"
#include "step/merit.h"

namespace cairn {

/// Subspace steps on islands whose state is in blocks: those of a group together, as their rows
/// share lanes. In single precision on islands whose rows all have bounds, as those of contacts;
/// rows without want a proximal term that floats cannot hold.
class BlockSteps {
 public:
  /// A new frame.
  void Begin(const CycleFrame& frame);

  /// Steps may be taken at all.
  bool asked() const { return asked_; }
  /// Whether no step failed on the island of late.
  bool Due(int island);
  /// What a step with one factorisation is thought to cost on some islands of a group, in
  /// relaxations of rows by kernels, before their graph is looked at; 0 if it is known.
  double Guess(int group, std::span<const int> islands);
  /// What the analysis of a graph costs, and a step's share of it: it serves those on later frames,
  /// too. Zeros if none is needed.
  struct AnalysisPrice {
    double whole = 0, of_step = 0;
  };
  AnalysisPrice PriceOfAnalysis(int group, std::span<const int> islands);
  void Analyse(int group, std::span<const int> islands);
  /// What a step with so many factorisations costs. @pre no analysis is needed
  double Price(int group, std::span<const int> islands, int factorisations);
  /// The island is left alone for a while: steps are too dear there.
  void Postpone(int island) { MemoryOf(island)->Postpone(); }
  /// What steps and sweeps were seen to gain on the island.
  StepOdds& odds(int island) { return MemoryOf(island)->odds(); }
  bool stepped_of_late(int island) { return MemoryOf(island)->stepped_of_late(); }
  /// What a step with so many factorisations costs on one island, as if it had lanes of its own,
  /// and what reading, packing, so many sweeps, and writing do. The first is a guess from the last
  /// frames while the graph is not known. Where it is above @p most either way, nobody looks: to
  /// find the graph of a large island again takes a while.
  double PriceAlone(int group, int island, int factorisations, double most);
  /// Each step there condenses joints, which is a factorisation more; see pays_for_condensing().
  bool CondensesJoints(int island) { return MemoryOf(island)->pays_for_condensing(); }
  double RestAlone(int island, int sweeps) const;
  /// The same if each row took as long as one of sixteen lanes: what it is to a large island, and
  /// no less for a small one, whose steps matter as much.
  double RestInWholeLines(int island, int sweeps) const;
  /// What sequential impulses row by row cost there, all in all.
  double ScalarAlone(int island, int iterations) const;
  /// Sweeps that fit, with all else, into the time that sequential impulses row by row take for so
  /// many, less a margin; at least those, and at most twice as many.
  int SweepsOfEffort(int island, int iterations) const;
  bool HasJoints(int island) const { return frame_->plan().islands()[island].joints; }
  StepOdds::Size SizeOf(int island) const {
    const int bodies = frame_->plan().islands()[island].bodies;
    if (HasJoints(island) || bodies > StepOdds::kFewBodies) return StepOdds::Size::kMany;
    return bodies > StepOdds::kFewestBodies ? StepOdds::Size::kFew : StepOdds::Size::kFewest;
  }
  /// Body::strain from which on nothing but raised inertia keeps the integrator stable.
  static constexpr double kUnstable = 4;
  /// From which on joints pull a lot. From half of it on dolls would be a fifth dearer.
  static constexpr double kStrained = 1;
  /// The largest Body::strain on an island, while steps are weighed; else 0.
  double strain(int island) const { return strains_.empty() ? 0 : strains_[island]; }
  /// Likewise, whether a joint there holds a body and one that is a hundred times lighter.
  bool IsLoaded(int island) const { return !loaded_.empty() && loaded_[island] != 0; }
  /// There sweeps leave joints that part before they pull: steps are taken whatever they cost in
  /// terms of row by row.
  bool IsStrained(int island) const { return strain(island) > kStrained || IsLoaded(island); }
  /// And there whatever they gain, too: raised inertia needs a tension that is right in each frame,
  /// and sweeps lose it within few; where a load wakes up, they let it fall before steps are known
  /// to pay.
  bool IsNeeded(int island) {
    return strain(island) > kUnstable || (IsStrained(island) && odds(island).is_young());
  }
  /// How many factorisations the next step on an island may make.
  void Limit(int island, int factorisations) { limits_[island] = factorisations; }
  /// Takes a step on some islands of a group.
  void Take(int group, std::span<const int> islands);
  /// The time was up before it was done; nothing changed.
  bool given_up(int island) const { return given_up_[island] != 0; }
  /// What came of the last one; where it did not succeed, nothing changed.
  const StepResult& result(int island) const { return islands_[island].result; }
  /// Finds mass() and before() of every island.
  void FindBefore();
  double mass(int island) const { return masses_[island]; }  ///< of its bodies [kg]
  /// The larger of those without impulses and with those of then.
  const IslandMotion& before(int island) const { return before_[island]; }
  /// Finds after() of every island.
  void FindAfter();
  const IslandMotion& after(int island) const { return after_[island]; }
  /// Of the spins of its bodies with this share of their impulses [J].
  double SpinEnergy(int island, double share) const;
  /// How fast the fastest body that no impulse moves, and that touches or holds the island, moves
  /// along [m/s]: it passes on its speed, too.
  double SpeedOfUnmoved(int island) const;
  /// What was charged for it: its share of the group's, by rows.
  double work(int island) const { return work_[island]; }
  /// See IslandMemory::overshoots(). Contacts with one direction of friction do not.
  bool Overshoots(int island) {
    return HasBodies(island) && (HasJoints(island) || one_direction_[island] == 0) &&
           MemoryOf(island)->overshoots();
  }
  /// The Solve() ends so on the island. @pre sweeps are accelerated
  void EndSolve(int island, bool stepped, bool finished) {
    if (HasBodies(island)) MemoryOf(island)->EndSolve(stepped, finished);
  }
  /// A guard undid something on the island.
  void Guarded(int island) { MemoryOf(island)->Guarded(); }
  /// What became of the step.
  void Judge(int island, bool accepted);

 private:
  struct Precisions {
    bool some_double, all_double;
  };
  Precisions PrecisionsOf(std::span<const int> islands) const;
  IslandMemory* MemoryOf(int island);
  /// One of rows that push nothing has none, and no name.
  bool HasBodies(int island) const { return frame_->plan().islands()[island].first_body >= 0; }
  void ReadPlan();
  /// Finds strains_ and loaded_.
  void FindPull();
  void FindLoaded();
  void ReadIslands();
  void CountLines();
  void CountStepLines();
  /// With so much of what impulses change velocities by.
  void FindMotions(double share, Array<IslandMotion>* motions) const;
  template <class T>
  BlockSystem<T>& SystemOf(int group);
  /// function(system) for each that the islands need.
  template <class Function>
  void ForSystems(int group, std::span<const int> islands, const Function& function);
  struct SystemSize {
    double lines, flops, nonzeros, nodes;
  };
  template <class T>
  double PriceOf(const SystemSize& size, int factorisations) const;
  /// A graph that was not looked at yet.
  struct Unknown {
    double lines, rows, bodies;
  };
  /// What a step there is thought to cost, by the last factor of the island.
  template <class T>
  double GuessOf(const Unknown& graph, const FactorSize& last, int factorisations) const;
  template <class T>
  double PriceOf(int group, int factorisations);
  template <class T>
  double PriceAloneOf(int group, int island, int factorisations, double most);
  template <class T>
  void TakeAs(int group, std::span<const int> islands, BlockStep<T>* step);

  const ContactProblem* problem_ = nullptr;
  const Settings* settings_ = nullptr;
  BlockFrame* frame_ = nullptr;
  IslandMemories* memories_ = nullptr;
  BudgetMeter* meter_ = nullptr;
  Crew* crew_ = nullptr;
  bool asked_ = false;

  int plan_number_ = -1;         ///< of what follows
  Array<int> limits_;            ///< by island: factorisations
  Array<double> set_up_;         ///< by island: what comes before and after sweeps
  Array<double> scalar_set_up_;  ///< the same row by row
  Array<double> sweeps_;         ///< by island: one of them, as if it had lanes of its own
  /// Likewise: rows that a sweep relaxes one after the other, lines that a step passes over.
  Array<int> sweep_lines_, step_lines_;
  /// Lanes that would be in one run, while lines are counted.
  struct Alike {
    int colour = -1;
    const simd::RowShape* shape = nullptr;
    int rows = 0, lanes = 0;
  };
  Array<Alike> alike_;  ///< by island
  /// Lanes of an island with the same rows, and the place of its shape before, -1 for none.
  struct LanesOfShape {
    const simd::RowShape* shape = nullptr;
    int lanes = 0, before = -1;
  };
  Array<LanesOfShape> lanes_of_shapes_;
  Array<int> latest_shape_;    ///< by island: its place in there
  Array<double> strains_;      ///< by island, none if no body is strained
  Array<char> loaded_;         ///< by island, none if none is
  Array<std::uint64_t> keys_;  ///< by island
  Array<char> one_direction_;  ///< by island: its contacts have one of friction
  Array<IslandMemory*> memory_of_island_;
  Array<IslandStep> islands_, islands_now_;
  Array<double> work_;    ///< by island
  Array<double> masses_;  ///< likewise
  Array<IslandMotion> before_, after_;
  Array<char> given_up_;  ///< likewise
  std::unique_ptr<BlockStep<float>> float_step_;
  std::unique_ptr<BlockStep<double>> double_step_;
};

}  // namespace cairn
