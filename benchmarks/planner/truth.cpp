// Truth for random scenes: Taylor series of (omega, quaternion) in the x87's 64-bit mantissa, order 24, tolerance
// 2e-20, as a shared library for benchmarks/planner/truth.py. Independent of the library: it includes nothing of it.
// Products of series by Cauchy's rule; the step after Jorba & Zou 2005, Experimental Mathematics 14, 99.
#include <cmath>
#include <cstring>
#include <initializer_list>

namespace {

using Real = long double;
constexpr int order = 24;
constexpr Real tolerance = 2e-20L;

struct Problem {
  double I[3], w[3], q[4];
  double constant[3];        // body axes
  double moment[3];          // weight times arm
  double mean_motion;
  double damping[9];
};

struct Series {
  Real c[order + 1];
};

Real product(const Series& a, const Series& b, int n) {
  Real sum = 0;
  for (int j = 0; j <= n; ++j) sum += a.c[j] * b.c[n - j];
  return sum;
}

class Taylor {
 public:
  explicit Taylor(const Problem& p) : p_(p) {
    for (int i = 0; i < 3; ++i) y_[i].c[0] = p.w[i];
    for (int i = 0; i < 4; ++i) y_[3 + i].c[0] = p.q[i];
  }

  void expand(Real t) {
    const bool heavy = p_.moment[0] != 0 || p_.moment[1] != 0 || p_.moment[2] != 0;
    const bool orbits = p_.mean_motion != 0;
    const Real n_ = p_.mean_motion;
    if (orbits) cos_.c[0] = std::cos(n_ * t), sin_.c[0] = std::sin(n_ * t);
    const Series *w = y_, &x = y_[3], &y = y_[4], &z = y_[5], &s = y_[6];
    for (int n = 0; n < order; ++n) {
      Real tau[3];
      for (int i = 0; i < 3; ++i) {
        tau[i] = n == 0 ? Real(p_.constant[i]) : Real(0);
        for (int j = 0; j < 3; ++j) tau[i] -= p_.damping[3 * i + j] * w[j].c[n];
      }
      if (heavy || orbits) {
        // Rows of R: unit by |q|^2 = 1, which the exact equations keep and the steps restore.
        const Real xx = product(x, x, n), yy = product(y, y, n), zz = product(z, z, n), ss = product(s, s, n);
        const Real xy = product(x, y, n), xz = product(x, z, n), yz = product(y, z, n);
        const Real sx = product(s, x, n), sy = product(s, y, n), sz = product(s, z, n);
        if (heavy) {
          const Real g[3] = {2 * (xz - sy), 2 * (yz + sx), ss - xx - yy + zz};
          tau[0] -= p_.moment[1] * g[2] - p_.moment[2] * g[1];
          tau[1] -= p_.moment[2] * g[0] - p_.moment[0] * g[2];
          tau[2] -= p_.moment[0] * g[1] - p_.moment[1] * g[0];
        }
        if (orbits) {
          row_[0].c[n] = ss + xx - yy - zz, row_[1].c[n] = 2 * (xy - sz), row_[2].c[n] = 2 * (xz + sy);
          row_[3].c[n] = 2 * (xy + sz), row_[4].c[n] = ss - xx + yy - zz, row_[5].c[n] = 2 * (yz - sx);
          for (int i = 0; i < 3; ++i) u_[i].c[n] = product(cos_, row_[i], n) + product(sin_, row_[3 + i], n);
          const Real k = 3 * n_ * n_;
          for (int i = 0; i < 3; ++i) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            tau[i] += k * (Real(p_.I[b]) - p_.I[a]) * product(u_[a], u_[b], n);
          }
          cos_.c[n + 1] = -n_ * sin_.c[n] / (n + 1), sin_.c[n + 1] = n_ * cos_.c[n] / (n + 1);
        }
      }
      for (int i = 0; i < 3; ++i) {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        y_[i].c[n + 1] = ((Real(p_.I[a]) - p_.I[b]) * product(w[a], w[b], n) + tau[i]) / (Real(p_.I[i]) * (n + 1));
      }
      const Real half = Real(1) / (2 * (n + 1));
      y_[3].c[n + 1] = half * (product(s, w[0], n) + product(y, w[2], n) - product(z, w[1], n));
      y_[4].c[n + 1] = half * (product(s, w[1], n) + product(z, w[0], n) - product(x, w[2], n));
      y_[5].c[n + 1] = half * (product(s, w[2], n) + product(x, w[1], n) - product(y, w[0], n));
      y_[6].c[n + 1] = half * (-product(x, w[0], n) - product(y, w[1], n) - product(z, w[2], n));
    }
  }

  Real step() const {
    Real h = 0;
    for (const int block : {0, 1}) {
      for (const int m : {order - 1, order}) {
        Real first = 0, last = 0;
        for (int i = block ? 3 : 0; i < (block ? 7 : 3); ++i) {
          first = std::fmax(first, std::fabs(y_[i].c[0]));
          last = std::fmax(last, std::fabs(y_[i].c[m]));
        }
        if (first == 0 || last == 0) continue;
        // Rounded down to 8 bits, because the last bits of pow differ between processors.
        int exponent = 0;
        const Real root = std::frexp(std::pow(tolerance * first / last, Real(1) / m), &exponent);
        const Real limit = std::ldexp(std::floor(256 * root), exponent - 8);
        if (h == 0 || limit < h) h = limit;
      }
    }
    return h;
  }

  void evaluate(Real h, Real* out) const {
    for (int i = 0; i < 7; ++i) {
      Real sum = 0;
      for (int k = order; k >= 0; --k) sum = sum * h + y_[i].c[k];
      out[i] = sum;
    }
    Real norm = 0;
    for (int i = 3; i < 7; ++i) norm += out[i] * out[i];
    norm = std::sqrt(norm);
    for (int i = 3; i < 7; ++i) out[i] /= norm;
  }

  void advance(Real h) {
    Real next[7];
    evaluate(h, next);
    for (int i = 0; i < 7; ++i) y_[i].c[0] = next[i];
  }

 private:
  Problem p_;
  Series y_[7] = {}, row_[6] = {}, u_[3] = {}, cos_ = {}, sin_ = {};
};

}  // namespace

/// 26 numbers: I, w, q, constant torque, weight times arm, mean motion, damping. `times` ascending from 0. Rows of 7.
/// Returns the turns (the integral of |w| / 2 pi), or -1 when `most_steps` did not do.
extern "C" double polhode_truth(const double* problem, long n, const double* times, double* out, long most_steps) {
  Problem p;
  static_assert(sizeof(Problem) == 26 * sizeof(double));
  std::memcpy(&p, problem, sizeof p);
  Taylor series(p);
  Real t = 0, turned = 0;
  long done = 0;
  for (long i = 0; i < n; ++done) {
    if (done > most_steps) return -1;
    series.expand(t);
    Real h = series.step();
    const Real rest = Real(times[n - 1]) - t;
    if (h == 0 || h > rest) h = rest;
    for (; i < n && times[i] <= t + h; ++i) {
      Real y[7];
      series.evaluate(times[i] - t, y);
      for (int k = 0; k < 7; ++k) out[7 * i + k] = static_cast<double>(y[k]);
    }
    Real a[7], b[7];
    series.evaluate(0, a);
    series.evaluate(h, b);
    turned +=
        h * (std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) + std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])) /
        2;
    series.advance(h);
    t += h;
  }
  return static_cast<double>(turned / 6.283185307179586L);
}
