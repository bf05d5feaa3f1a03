// SPDX-License-Identifier: MIT
#include "cairn/lcp/solver.h"

#include <exception>
#include <utility>

#include "lcp_solver.h"

namespace cairn::lcp {
namespace {

/// Wall clock since it was made.
class StopWatch {
 public:
  std::chrono::nanoseconds elapsed() const { return Clock::now() - begin_; }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point begin_ = Clock::now();
};

}  // namespace

struct Solver::Impl {
  /// Throws away what an exception has left half done: a solver is new after one.
  class Attempt {
   public:
    explicit Attempt(Impl* impl) : impl_(impl) {
      if (impl->lcp == nullptr) impl->lcp = std::make_unique<LcpSolver>();
    }
    ~Attempt() {
      if (std::uncaught_exceptions() > exceptions_) impl_->lcp.reset();
    }
    Attempt(const Attempt&) = delete;
    Attempt& operator=(const Attempt&) = delete;

   private:
    Impl* impl_;
    int exceptions_ = std::uncaught_exceptions();
  };

  Settings settings;
  Observer observer;
  std::unique_ptr<LcpSolver> lcp;  ///< what was learnt; the next Attempt makes it anew
};

Solver::Solver(const Settings& settings) : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

Settings& Solver::settings() { return impl_->settings; }
const Settings& Solver::settings() const { return impl_->settings; }

void Solver::Reset() { impl_->lcp.reset(); }

void Solver::Observe(Observer observer) { impl_->observer = std::move(observer); }

Report Solver::Solve(const BoxedLcp& problem, Eigen::VectorXd* x) {
  const StopWatch watch;
  const Settings settings = impl_->settings;  // an observer may change them
  Report report;
  report.bad_setting = FindBadSetting(settings);
  if (report.bad_setting.name != nullptr) {
    report.status = Status::kBadSettings;
  } else {
    const Impl::Attempt attempt(impl_.get());
    report = impl_->lcp->Solve(problem, settings, impl_->observer, x);
  }
  report.elapsed = watch.elapsed();
  return report;
}

Report Solver::Solve(const MixedLcp& problem, Eigen::VectorXd* u, Eigen::VectorXd* v) {
  const StopWatch watch;
  Report report = Validate(problem);
  const bool fit = u->size() == problem.a.size() && v->size() == problem.b.size();
  if (report.ok() && !fit) report.status = Status::kWrongSize;
  if (report.ok()) {
    Eigen::VectorXd x(u->size() + v->size());
    x << *u, *v;
    report = Solve(ToBoxed(problem), &x);
    *u = x.head(u->size());
    *v = x.tail(v->size());
  }
  report.elapsed = watch.elapsed();
  return report;
}

}  // namespace cairn::lcp
