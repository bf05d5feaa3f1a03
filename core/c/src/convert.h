// SPDX-License-Identifier: MIT
// Between the structs of C and those of C++.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "cairn/cairn.h"
#include "cairn/cairn_doubles.h"
#include "cairn/detail/memory.h"
#include "cairn/solver.h"

namespace cairn::c {

/// Threads of a C program.
class CJobs final : public Executor {
 public:
  explicit CJobs(const CairnJobs& jobs) : jobs_(jobs) {}
  void Submit(void (*work)(void*), void* what) override { jobs_.submit(work, what, jobs_.context); }

  const CairnJobs& jobs() const { return jobs_; }

 private:
  CairnJobs jobs_;
};

/// Memory of settings, or operator new.
detail::Heap::Owner HeapOf(const CairnMemory& memory);

/// Without the job system.
Settings ToSettings(const CairnSettings& settings);
CairnStatus ToStatus(Status status);
CairnReport ToReport(const Report& report);
CairnIsland ToIsland(const IslandReport& island);
/// @param from  CairnBody or CairnBodyD
template <class BodyOfC>
void CopyBodies(std::span<const BodyOfC> from, Array<Body>* to);
/// @param to  as many CairnVelocity or CairnVelocityD
template <class VelocityOfC>
void CopyVelocities(std::span<const Velocity> from, VelocityOfC* to);

/// A problem whose counts and pointers fit one another, over the memory of the caller.
struct View {
  ContactProblem problem;
  Impulses impulses;
};
/// A count that is below 0, or an array that is null though it has one above.
struct Misfit {
  const char* array = nullptr;    ///< none where the count itself is wrong
  const char* counted = nullptr;  ///< name of the count, none if all is well
  std::int32_t count = 0;
};
std::string Describe(const Misfit& misfit);

/// cairnOk, or what is wrong with counts and pointers: the first such to @p misfit.
/// @param bodies      of the problem, CairnBody or CairnBodyD, copied to @p copies
/// @param velocities  where those of bodies are to go
template <class BodyOfC>
CairnStatus Look(const CairnProblem& problem, const BodyOfC* bodies, const CairnSolution& solution,
                 const void* velocities, Array<Body>* copies, View* view, Misfit* misfit);

/// What snprintf does with "%s".
std::size_t PutText(std::string_view text, char* to, std::size_t size);

/// Runs function, which returns a CairnStatus; exceptions become one.
template <class Function>
CairnStatus Guarded(const Function& function) noexcept {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return cairnOutOfMemory;
  } catch (...) {
    return cairnFailed;
  }
}

/// The text that function puts into a string, or a sentence for the CairnStatus that it returns.
template <class Function>
std::size_t Say(char* to, std::size_t size, const Function& function) noexcept {
  std::string said;
  const CairnStatus status = Guarded([&] { return function(&said); });
  return PutText(status == cairnOk ? std::string_view(said) : cairnDescribe(status), to, size);
}

/// What ValidateStrictly() finds, a line each.
void AppendFindings(const ContactProblem& problem, const Impulses& impulses, std::string* text);

}  // namespace cairn::c
