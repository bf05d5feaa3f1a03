// SPDX-License-Identifier: MIT
// How long the factorisation of a subspace step takes in a frame of each scene: our factor in
// double and float, Eigen's simplicial one in the same order of bodies, and CHOLMOD's supernodal
// one in its own, where it is installed. One thread. Time of the process, by phase: blocks into
// the solver's memory (fill), factorise, solve. What comes before, from rows to the matrix
// (assemble), with every row: ours by as much as it takes longer with the factorisation than the
// factorisation alone, each once in turn; Eigen's by triplets, and into a pattern that is known.
//
//     cairn_cholesky --benchmark_enable_random_interleaving=true --benchmark_repetitions=9
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "cholesky/front_cholesky.h"
#include "micro/cholesky/assembly.h"
#include "micro/cholesky/body_matrix.h"
#include "micro/cholesky/eigen_cholesky.h"
#include "micro/cholesky/multiply_add_peak.h"
#include "simd/target.h"
#include "support/machine/stopwatch.h"
#if CAIRN_HAS_CHOLMOD
#include "micro/cholesky/cholmod_factor.h"
#endif

namespace cairn::micro {
namespace {

constexpr const char* kScenes[] = {"wall",         "pyramid", "pyramid:44", "pyramid3d",
                                   "pyramid3d:14", "rubble",  "ragdolls",   "castle",
                                   "chain",        "bridge",  "tower",      "islands"};

/// One solver with one matrix. Each solve() begins with the same right-hand side: one that was
/// solved for again and again would end in denormal numbers, which take many times as long.
struct Solver {
  std::function<void()> fill, factorise, solve;
};

template <class T>
void FillFronts(const BodyMatrix& matrix, FrontCholesky<T>* factor) {
  using Block = Eigen::Map<Eigen::Matrix<T, 6, 6>>;
  for (int i = 0; i < matrix.bodies; ++i) {
    Block(factor->diagonal(i)) = matrix.diagonals[i].template cast<T>();
  }
  for (int pair = 0; pair < static_cast<int>(matrix.pairs.size()); ++pair) {
    Block(factor->upper(pair)) = matrix.uppers[pair].template cast<T>();
  }
}

template <class T>
Solver MakeFronts(const BodyMatrix& matrix) {
  const auto factor = std::make_shared<FrontCholesky<T>>(simd::BestTarget());
  factor->Analyse(matrix.bodies, 6, matrix.pairs);
  const auto x = std::make_shared<std::vector<T>>(6 * matrix.bodies, T(1));
  return {[=, &matrix] { FillFronts(matrix, factor.get()); },
          [=] {
            if (!factor->Factorise()) std::abort();
          },
          [=] {
            std::fill(x->begin(), x->end(), T(1));
            factor->Solve(*x);
          }};
}

/// The upper triangle, in an order of bodies, with where each block begins in its columns.
class SparseMatrix {
 public:
  SparseMatrix(const BodyMatrix& matrix, std::span<const int> position)
      : matrix_(matrix), position_(position.begin(), position.end()) {
    std::vector<Eigen::Triplet<double>> entries;
    ForEntries([&](int row, int column, double) { entries.emplace_back(row, column, 1.0); });
    sparse_.resize(6 * matrix.bodies, 6 * matrix.bodies);
    sparse_.setFromTriplets(entries.begin(), entries.end());
    ForEntries([&](int row, int column, double) {
      place_.push_back(&sparse_.coeffRef(row, column) - sparse_.valuePtr());
    });
  }

  void Fill() {
    const auto* place = place_.data();
    double* const values = sparse_.valuePtr();
    ForEntries([&](int, int, double value) { values[*place++] = value; });
  }
  const Eigen::SparseMatrix<double>& sparse() const { return sparse_; }

 private:
  template <class Function>
  void ForEntries(const Function& function) const {
    for (int i = 0; i < matrix_.bodies; ++i) {
      const int at = 6 * position_[i];
      for (int c = 0; c < 6; ++c) {
        for (int r = 0; r <= c; ++r) function(at + r, at + c, matrix_.diagonals[i](r, c));
      }
    }
    for (size_t pair = 0; pair < matrix_.pairs.size(); ++pair) {
      const int i = 6 * position_[matrix_.pairs[pair].first];
      const int j = 6 * position_[matrix_.pairs[pair].second];
      const Block6& block = matrix_.uppers[pair];
      for (int c = 0; c < 6; ++c) {
        for (int r = 0; r < 6; ++r) {
          if (i < j) {
            function(i + r, j + c, block(r, c));
          } else {
            function(j + r, i + c, block(c, r));
          }
        }
      }
    }
  }

  const BodyMatrix& matrix_;
  std::vector<int> position_;
  Eigen::SparseMatrix<double> sparse_;
  std::vector<std::ptrdiff_t> place_;
};

std::shared_ptr<SparseMatrix> MakeSparse(const BodyMatrix& matrix) {
  FactorPattern pattern;
  pattern.Analyse(matrix.bodies, 6, matrix.pairs);
  const auto sparse = std::make_shared<SparseMatrix>(matrix, pattern.position());
  sparse->Fill();
  return sparse;
}

Solver MakeEigen(const BodyMatrix& matrix) {
  const auto sparse = MakeSparse(matrix);
  const auto factor = std::make_shared<EigenCholesky>();
  factor->Analyse(sparse->sparse());
  const auto x = std::make_shared<Eigen::VectorXd>(Eigen::VectorXd::Ones(6 * matrix.bodies));
  return {[=] { sparse->Fill(); },
          [=] {
            if (!factor->Factorise(sparse->sparse())) std::abort();
          },
          [=] {
            x->setOnes();
            factor->Solve(x.get());
          }};
}

#if CAIRN_HAS_CHOLMOD
Solver MakeCholmod(const BodyMatrix& matrix) {
  const auto sparse = MakeSparse(matrix);
  const auto factor = std::make_shared<CholmodFactor>(&sparse->sparse());
  const auto x = std::make_shared<std::vector<double>>(6 * matrix.bodies, 1.0);
  return {[=] { sparse->Fill(); },
          [=] {
            if (!factor->Factorise()) std::abort();
          },
          [=] {
            std::fill(x->begin(), x->end(), 1.0);
            factor->Solve(x.get());
          }};
}
#endif

struct Kind {
  const char* name;
  Solver (*make)(const BodyMatrix& matrix);
  bool is_float;
};
constexpr Kind kKinds[] = {
    {"cairn_double", MakeFronts<double>, false},
    {"cairn_float", MakeFronts<float>, true},
    {"eigen", MakeEigen, false},
#if CAIRN_HAS_CHOLMOD
    {"cholmod", MakeCholmod, false},
#endif
};

void CountFlops(double flops, double peak, benchmark::State* state) {
  const double all = flops * static_cast<double>(state->iterations());
  state->counters["flop/s"] = benchmark::Counter(all, benchmark::Counter::kIsRate);
  state->counters["of_peak"] = benchmark::Counter(all / peak, benchmark::Counter::kIsRate);
}

void RegisterPhase(const std::string& name, const std::shared_ptr<Solver>& solver,
                   std::function<void()> Solver::*phase, double flops, double peak) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    solver->fill();
    solver->factorise();
    const std::function<void()>& run = (*solver).*phase;
    for (auto _ : state) run();
    if (flops > 0) CountFlops(flops, peak, &state);
  })->Unit(benchmark::kMicrosecond);
}

/// Seconds of work.
template <class Function>
double Time(const Function& work) {
  const cli::Stopwatch stopwatch(cli::SolverClock::kWall);
  work();
  return 1e-3 * stopwatch.Read();
}

template <class T>
void RegisterOurAssembly(const std::string& name, const BodyMatrix& matrix, double peak) {
  const auto ours = std::make_shared<BlockAssembly<T>>(matrix);
  const auto alone = std::make_shared<Solver>(MakeFronts<T>(matrix));
  benchmark::RegisterBenchmark((name + "/assemble").c_str(),
                               [=, &matrix](benchmark::State& state) {
                                 const auto both = [&] {
                                   if (!ours->AssembleAndFactorise()) std::abort();
                                 };
                                 alone->fill();
                                 both();
                                 for (auto _ : state) {
                                   const double with = Time(both), without = Time(alone->factorise);
                                   state.SetIterationTime(with - without);
                                 }
                                 CountFlops(AssemblyFlops(matrix), peak, &state);
                               })
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime();
}

void RegisterEigenAssembly(const std::string& name, const BodyMatrix& matrix, double peak) {
  FactorPattern pattern;
  pattern.Analyse(matrix.bodies, 6, matrix.pairs);
  const auto eigen = std::make_shared<EigenAssembly>(matrix, pattern.position());
  const Eigen::SparseMatrix<double> expected = eigen->sparse();
  eigen->IntoPattern();
  if (!eigen->sparse().isApprox(expected)) std::abort();
  const auto add = [&](const char* phase, void (EigenAssembly::*run)()) {
    benchmark::RegisterBenchmark((name + phase).c_str(), [=, &matrix](benchmark::State& state) {
      for (auto _ : state) ((*eigen).*run)();
      CountFlops(AssemblyFlops(matrix), peak, &state);
    })->Unit(benchmark::kMicrosecond);
  };
  add("/assemble_triplets", &EigenAssembly::FromTriplets);
  add("/assemble", &EigenAssembly::IntoPattern);
}

void RegisterScene(const std::string& scene, const BodyMatrix& matrix, const Peak& peak) {
  FactorPattern pattern;
  pattern.Analyse(matrix.bodies, 6, matrix.pairs);
  benchmark::RegisterBenchmark((scene + "/analyse").c_str(), [&matrix](benchmark::State& state) {
    FactorPattern again;
    for (auto _ : state) again.Analyse(matrix.bodies, 6, matrix.pairs);
  })->Unit(benchmark::kMicrosecond);
  RegisterOurAssembly<double>(scene + "/cairn_double", matrix, peak.double_flops);
  RegisterOurAssembly<float>(scene + "/cairn_float", matrix, peak.float_flops);
  RegisterEigenAssembly(scene + "/eigen", matrix, peak.double_flops);
  for (const Kind& kind : kKinds) {
    const auto solver = std::make_shared<Solver>(kind.make(matrix));
    const std::string name = scene + "/" + kind.name;
    RegisterPhase(name + "/fill", solver, &Solver::fill, 0, 0);
    RegisterPhase(name + "/factorise", solver, &Solver::factorise, pattern.flops(),
                  kind.is_float ? peak.float_flops : peak.double_flops);
    RegisterPhase(name + "/solve", solver, &Solver::solve, 0, 0);
  }
}

}  // namespace
}  // namespace cairn::micro

int main(int argc, char** argv) {
  using namespace cairn;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;

  const micro::Peak peak = micro::MeasurePeak();
  benchmark::AddCustomContext("simd", std::string(simd::TargetName(simd::BestTarget())));
  benchmark::AddCustomContext("peak_double_flop_per_s", std::to_string(peak.double_flops));
  benchmark::AddCustomContext("peak_float_flop_per_s", std::to_string(peak.float_flops));
  std::vector<micro::BodyMatrix> matrices;
  for (const char* scene : micro::kScenes) matrices.push_back(micro::MakeBodyMatrix(scene));
  for (size_t i = 0; i < matrices.size(); ++i) {
    micro::RegisterScene(micro::kScenes[i], matrices[i], peak);
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
