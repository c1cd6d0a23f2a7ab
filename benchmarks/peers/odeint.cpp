// Boost.Odeint's runge_kutta_dopri5 with dense output on the same scenes, as a shared library for benchmarks/rk45.py.
// The right-hand sides are written as a C++ user would: principal moments, quaternion, no virtual call.
#include <array>
#include <boost/numeric/odeint.hpp>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 7>;

namespace {

enum Kind { free_body, heavy, gradient, damped, thruster };

template <Kind kind>
struct Body {
  double I[3], p[4];

  void operator()(const State& y, State& f, double t) const {
    const double *w = y.data(), *q = y.data() + 3;
    double tau[3] = {0, 0, 0};
    if constexpr (kind == heavy) {
      const double g[3] = {2 * (q[0] * q[2] - q[3] * q[1]), 2 * (q[1] * q[2] + q[3] * q[0]),
                           q[2] * q[2] + q[3] * q[3] - q[0] * q[0] - q[1] * q[1]};
      const double m[3] = {p[0] * p[1], p[0] * p[2], p[0] * p[3]};
      tau[0] = -(m[1] * g[2] - m[2] * g[1]), tau[1] = -(m[2] * g[0] - m[0] * g[2]),
      tau[2] = -(m[0] * g[1] - m[1] * g[0]);
    } else if constexpr (kind == gradient) {
      const double n = p[0], c = std::cos(n * t), s = std::sin(n * t);
      const double u[3] = {
          c * (1 - 2 * (q[1] * q[1] + q[2] * q[2])) + s * 2 * (q[0] * q[1] + q[3] * q[2]),
          c * 2 * (q[0] * q[1] - q[3] * q[2]) + s * (1 - 2 * (q[0] * q[0] + q[2] * q[2])),
          c * 2 * (q[0] * q[2] + q[3] * q[1]) + s * 2 * (q[1] * q[2] - q[3] * q[0])};
      const double k = 3 * n * n;
      tau[0] = k * (I[2] - I[1]) * u[1] * u[2], tau[1] = k * (I[0] - I[2]) * u[2] * u[0],
      tau[2] = k * (I[1] - I[0]) * u[0] * u[1];
    } else if constexpr (kind == damped) {
      for (int i = 0; i < 3; ++i) tau[i] = -p[i] * w[i];
    } else if constexpr (kind == thruster) {
      for (int i = 0; i < 3; ++i) tau[i] = p[i];
    }
    f[0] = ((I[1] - I[2]) * w[1] * w[2] + tau[0]) / I[0];
    f[1] = ((I[2] - I[0]) * w[2] * w[0] + tau[1]) / I[1];
    f[2] = ((I[0] - I[1]) * w[0] * w[1] + tau[2]) / I[2];
    f[3] = 0.5 * (q[3] * w[0] + q[1] * w[2] - q[2] * w[1]);
    f[4] = 0.5 * (q[3] * w[1] + q[2] * w[0] - q[0] * w[2]);
    f[5] = 0.5 * (q[3] * w[2] + q[0] * w[1] - q[1] * w[0]);
    f[6] = -0.5 * (q[0] * w[0] + q[1] * w[1] + q[2] * w[2]);
  }
};

template <Kind kind>
void solve(const double* I, const double* p, const double* y0, const double* times, long n, double rtol, double* out) {
  Body<kind> body{{I[0], I[1], I[2]}, {p[0], p[1], p[2], p[3]}};
  State y;
  std::copy_n(y0, 7, y.begin());
  long row = 0;
  auto stepper = odeint::make_dense_output(0.0, rtol, odeint::runge_kutta_dopri5<State>());
  odeint::integrate_times(stepper, body, y, times, times + n, 1e-3 * (times[n - 1] - times[0]) / n,
                          [&](const State& s, double) {
                            const double norm = std::sqrt(s[3] * s[3] + s[4] * s[4] + s[5] * s[5] + s[6] * s[6]);
                            double* o = out + 7 * row++;
                            for (int i = 0; i < 3; ++i) o[i] = s[static_cast<std::size_t>(i)];
                            for (int i = 3; i < 7; ++i) o[i] = s[static_cast<std::size_t>(i)] / norm;
                          });
}

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

// out: n rows of omega (3) and attitude (4); returns the thread's CPU seconds.
extern "C" double run_odeint(int kind, const double* I, const double* p, const double* y0, const double* times, long n,
                             double rtol, double* out) {
  const double begin = cpu_seconds();
  switch (kind) {
    case free_body: solve<free_body>(I, p, y0, times, n, rtol, out); break;
    case heavy: solve<heavy>(I, p, y0, times, n, rtol, out); break;
    case gradient: solve<gradient>(I, p, y0, times, n, rtol, out); break;
    case damped: solve<damped>(I, p, y0, times, n, rtol, out); break;
    default: solve<thruster>(I, p, y0, times, n, rtol, out); break;
  }
  return cpu_seconds() - begin;
}
