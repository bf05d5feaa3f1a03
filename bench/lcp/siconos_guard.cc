// SPDX-License-Identifier: MIT
#include "lcp/siconos_guard.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <csetjmp>
#include <csignal>
#include <cstdio>

namespace cairn::cli {
namespace {

sigjmp_buf way_out;

void Leave(int /*signal*/) { siglongjmp(way_out, 1); }

/// Sends stdout and stderr to /dev/null while it lives. No switch of Siconos keeps PSOR and
/// Newton's method from printing.
class Silence {
 public:
  Silence() {
    std::fflush(nullptr);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    for (int file : {0, 1}) {
      kept_[file] = dup(file + 1);
      dup2(nowhere, file + 1);
    }
    close(nowhere);
  }
  ~Silence() {
    std::fflush(nullptr);
    for (int file : {0, 1}) {
      dup2(kept_[file], file + 1);
      close(kept_[file]);
    }
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_[2] = {-1, -1};
};

void SetBlasThreads(int threads) {
  using Set = void (*)(int);
  if (void* set = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) {
    reinterpret_cast<Set>(set)(threads);
  }
}

/// Kept apart from everything with a destructor, which a jump would leave out.
bool CallAndReturn(const std::function<void()>& call) {
  if (sigsetjmp(way_out, 1) != 0) return false;
  call();
  return true;
}

}  // namespace

std::string RunGuarded(const GuardedCall& guarded) {
  SetBlasThreads(guarded.threads);
  const Silence silence;
  struct sigaction leave = {}, before = {};
  leave.sa_handler = &Leave;
  sigaction(SIGABRT, &leave, &before);
  const bool returned = CallAndReturn(guarded.call);
  sigaction(SIGABRT, &before, nullptr);
  return returned ? "" : "it called abort()";
}

}  // namespace cairn::cli
