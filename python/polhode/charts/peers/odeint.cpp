// Boost.Odeint on a right-hand side that is compiled apart: this file takes seconds to compile and serves every scene,
// the right-hand side of one takes a tenth of one.
#include <array>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/integrate/integrate_times.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <chrono>

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 7>;
using Function = void (*)(double t, const double* y, double* f);

namespace {

struct Late {};

double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Job {
  Function function;
  const double* times;
  long n;
  double end;   // on the clock; 0: no limit
  double* out;  // n rows of seven
  long calls = 0;
};

template <class Stepper>
void run(Stepper stepper, Job& job, State y) {
  long row = 0;
  const auto f = [&job](const State& at, State& to, double t) {
    if ((++job.calls & 4095) == 0 && job.end > 0 && clock_seconds() > job.end) throw Late();
    job.function(t, at.data(), to.data());
  };
  const auto keep = [&](const State& at, double) {
    for (double value : at) job.out[row++] = value;
  };
  const double first = 1e-3 * (job.times[job.n - 1] - job.times[0]) / static_cast<double>(job.n);
  odeint::integrate_times(stepper, f, y, job.times, job.times + job.n, first, keep);
}

}  // namespace

// Returns the calls of the right-hand side, or -1 past the limit, -2 when Odeint gives up.
extern "C" long solve(Function function, int method, const double* y0, const double* times, long n, double atol, double rtol,
                      double limit, double* out) {
  State y;
  std::copy_n(y0, 7, y.begin());
  Job job{function, times, n, limit > 0 ? clock_seconds() + limit : 0.0, out};
  try {
    if (method == 0) run(odeint::make_dense_output(atol, rtol, odeint::runge_kutta_dopri5<State>()), job, y);
    if (method == 1) run(odeint::make_controlled(atol, rtol, odeint::runge_kutta_fehlberg78<State>()), job, y);
  } catch (const Late&) {
    return -1;
  } catch (...) {
    return -2;
  }
  return job.calls;
}
