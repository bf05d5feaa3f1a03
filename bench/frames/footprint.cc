// SPDX-License-Identifier: MIT
#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frames/experiments.h"
#include "frames/stepped.h"
#include "frames/symbols.h"
#include "measure/substep.h"
#include "run/scene_run.h"
#include "support/machine/run_context.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

using bench::Substep;

constexpr std::uint64_t kLine = 64, kPage = 4096;

using Make = std::function<std::unique_ptr<btConstraintSolver>()>;

/// Solves the substeps of a world that it also drives, up to the one looked at: around(last, solve)
/// calls solve().
template <class Around>
void SolveSubsteps(const SceneChoice& choice, const WindowOptions& options,
                   btConstraintSolver* solver, const Around& around) {
  btContactSolverInfo its_info;  // stays where it is: Cairn knows a world again by it
  bench::JointImpulses joints;
  btSequentialImpulseConstraintSolver driver;
  cli::SceneRun run(choice, &driver);
  const int last = choice.FirstFrame(options.frame);
  // some frames before, in which the solver learns what it would know
  constexpr int kLearning = 20;
  run.Skip(std::max(0, last - kLearning));
  while (run.frame() <= last) {
    const bool is_last = run.frame() == last;
    run.StepAfter([&](Substep* substep, const btContactSolverInfo& info) {
      its_info = info;
      substep->Restore();
      joints.Put(*substep);
      around(is_last, [&] { substep->SolveWith(solver, its_info, nullptr); });
      joints.Keep(*substep);
    });
  }
}

/// Steps the last substep singly.
StepCounts CountsOf(const SceneChoice& choice, const WindowOptions& options, const Make& make) {
  return CountSteps([&](const Marks& marks) {
    SolveSubsteps(choice, options, make().get(), [&](bool last, const auto& solve) {
      if (last) marks.Begin();
      solve();
      if (last) marks.End();
    });
  });
}

/// Bytes of the heap that are in use.
std::int64_t HeapInUse() {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  const auto heap = mallinfo2();
  return static_cast<std::int64_t>(heap.uordblks + heap.hblkhd);
#else
  return 0;
#endif
}

/// Bytes that a solver holds after these substeps; 0 where nobody can tell. What the process keeps
/// from the first solver on is not counted.
std::int64_t MemoryOf(const SceneChoice& choice, const WindowOptions& options, const Make& make) {
  std::int64_t held = 0;
  for (int turn = 0; turn < 2; ++turn) {
    held = -HeapInUse();
    const std::unique_ptr<btConstraintSolver> solver = make();
    held += HeapInUse();
    SolveSubsteps(choice, options, solver.get(), [&](bool, const auto& solve) {
      held -= HeapInUse();
      solve();
      held += HeapInUse();
    });
  }
  return held;
}

struct Footprint {
  std::uint64_t instructions = 0;
  std::vector<std::uint64_t> lines;  ///< Addresses, in order.
  size_t pages = 0;
};

std::vector<std::uint64_t> Distinct(const StepCounts& counts, std::uint64_t size) {
  std::vector<std::uint64_t> places;
  for (const auto& [address, times] : counts) places.push_back(address / size * size);
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

Footprint FootprintOf(const StepCounts& counts) {
  Footprint footprint;
  for (const auto& [address, times] : counts) footprint.instructions += times;
  footprint.lines = Distinct(counts, kLine);
  footprint.pages = Distinct(counts, kPage).size();
  return footprint;
}

/// "Bodies::Read", of "Bodies::Read(Group const&) [clone .localalias]".
std::string WithoutArguments(const std::string& name) {
  constexpr std::string_view kNoName = "(anonymous namespace)";
  int depth = 0;  // of template arguments
  for (size_t i = 0; i < name.size(); ++i) {
    if (name.compare(i, kNoName.size(), kNoName) == 0) {
      i += kNoName.size() - 1;
    } else if (name[i] == '<') {
      ++depth;
    } else if (name[i] == '>') {
      --depth;
    } else if (name[i] == '(' && depth == 0 && i > 0) {
      return name.substr(0, i);
    }
  }
  return name;
}

/// Functions of the most lines first.
void PrintFunctions(const StepCounts& counts, int most) {
  struct Function {
    std::set<std::uint64_t> lines;
    std::uint64_t instructions = 0;
  };
  const Symbols symbols;
  std::map<std::string, Function> functions;
  for (const auto& [address, times] : counts) {
    Function& function = functions[WithoutArguments(symbols.NameAt(address))];
    function.lines.insert(address / kLine);
    function.instructions += times;
  }
  std::vector<std::pair<std::string, Function>> sorted(functions.begin(), functions.end());
  std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) {
    return a.second.lines.size() > b.second.lines.size();
  });
  fmt::print("{} functions\n\nlines  instructions  function\n", sorted.size());
  for (size_t i = 0; i < std::min(sorted.size(), static_cast<size_t>(most)); ++i) {
    const auto& [name, function] = sorted[i];
    fmt::print("{:5}  {:12}  {}\n", function.lines.size(), function.instructions, name);
  }
  fmt::print("\n");
}

}  // namespace

void PrintFootprints(const WindowOptions& options, int functions, const std::string& command) {
  fmt::print(
      "{}",
      cli::Origin("Footprint: the code that a substep runs through, and the memory of a solver",
                  cli::DescribeContext(command)));
  fmt::print(
      "- the substep of one frame, from prepareSolve() to the end of allSolved(), stepped one "
      "instruction at a time;\n  solvers beside the one that drives the world, which have solved "
      "the substeps before\n"
      "- lines of 64 bytes and pages of 4 KiB that hold the first byte of an instruction that "
      "ran\n- KiB held: memory of the solver after that substep and up to twenty before it; \"-\" "
      "where the C library does not tell\n\n");
  const std::vector<std::pair<const char*, Make>> solvers = {
      {"bullet", [] { return std::make_unique<btSequentialImpulseConstraintSolver>(); }},
      {"cairn-pgs",
       [] {
         Settings settings;
         settings.k_sm = 0;
         return std::make_unique<bullet::ConstraintSolver>(settings);
       }},
      {"cairn", [] { return std::make_unique<bullet::ConstraintSolver>(); }},
  };
  cli::TextTable table = cli::TableOf(
      {"world", "solver", "instructions", "distinct", "lines", "KiB", "pages", "KiB held"});
  for (const SceneChoice& scene : options.scenes) {
    for (const auto& [name, make] : solvers) {
      const StepCounts counts = CountsOf(scene, options, make);
      const Footprint footprint = FootprintOf(counts);
      const std::int64_t held = MemoryOf(scene, options, make);
      table.rows.push_back(
          {NameOf(scene), name, fmt::format("{}", footprint.instructions),
           fmt::format("{}", counts.size()), fmt::format("{}", footprint.lines.size()),
           fmt::format("{:.0f}", static_cast<double>(footprint.lines.size()) / 16),
           fmt::format("{}", footprint.pages),
           held > 0 ? fmt::format("{:.1f}", static_cast<double>(held) / 1024) : "-"});
      if (functions > 0) {
        fmt::print("{}, {}: ", NameOf(scene), name);
        PrintFunctions(counts, functions);
      }
    }
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
