// SPDX-License-Identifier: MIT
#include "frames/stepped.h"

#include <stdexcept>

#if defined(__linux__) && defined(__x86_64__)
#include <sys/ptrace.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#endif

namespace cairn::frames {

#if defined(__linux__) && defined(__x86_64__)

void Marks::Begin() const { std::raise(SIGUSR1); }
void Marks::End() const { std::raise(SIGUSR1); }

namespace {

class Child {
 public:
  explicit Child(const std::function<void(const Marks&)>& program) {
    std::fflush(stdout);
    id_ = fork();
    if (id_ < 0) throw std::runtime_error("footprint: no second process");
    if (id_ != 0) {
      Wait();
      return;
    }
    int result = 1;
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0) {
      std::raise(SIGSTOP);  // the parent waits for it
      try {
        program({});
        result = 0;
      } catch (const std::exception& error) {
        std::fprintf(stderr, "footprint: %s\n", error.what());
      }
    }
    _exit(result);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (ended_) return;
    kill(id_, SIGKILL);
    waitpid(id_, &status_, 0);
  }

  /// Until the next mark. @return false at the end of the program
  bool RunToMark() {
    if (ended_) return false;
    Resume(PTRACE_CONT);
    if (ended_) return false;
    if (WSTOPSIG(status_) == SIGUSR1) return true;
    throw std::runtime_error("footprint: the program was stopped by a signal");
  }
  /// @return false at a mark
  bool Step() {
    Resume(PTRACE_SINGLESTEP);
    if (ended_) throw std::runtime_error("footprint: the program ended between its marks");
    return WSTOPSIG(status_) != SIGUSR1;
  }
  /// Of the instruction that is next.
  std::uint64_t Address() const {
    user_regs_struct registers;
    ptrace(PTRACE_GETREGS, id_, nullptr, &registers);
    return registers.rip;
  }

  bool ended_well() const { return ended_ && WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }

 private:
  void Resume(__ptrace_request how) {
    if (ptrace(how, id_, nullptr, nullptr) != 0) {
      throw std::runtime_error("footprint: this system does not let a process step another");
    }
    Wait();
  }
  void Wait() {
    waitpid(id_, &status_, 0);
    ended_ = WIFEXITED(status_) || WIFSIGNALED(status_);
  }

  pid_t id_ = 0;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace

StepCounts CountSteps(const std::function<void(const Marks&)>& program) {
  StepCounts counts;
  Child child(program);
  bool between = false;
  while (child.RunToMark()) {
    between = !between;
    if (!between) continue;
    do {
      ++counts[child.Address()];
    } while (child.Step());
    between = false;
  }
  if (!child.ended_well()) throw std::runtime_error("footprint: the program did not end well");
  return counts;
}

#else

void Marks::Begin() const {}
void Marks::End() const {}

StepCounts CountSteps(const std::function<void(const Marks&)>&) {
  throw std::runtime_error("footprint: only on Linux, x86-64");
}

#endif

}  // namespace cairn::frames
