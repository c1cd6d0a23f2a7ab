/// Taylor series of (omega, quaternion) in 113-bit arithmetic; one line "w1 w2 w3 x y z w" per sample time.
/// Products of series by Cauchy's rule, order and step after Jorba & Zou (2005), Experimental Mathematics 14, 99.
/// options: order, log10 of the tolerance.
#include <algorithm>

#include "problem.hpp"

namespace {

using Series = std::vector<Real>;

Real product(const Series& a, const Series& b, int n) {
  Real sum = 0;
  for (int j = 0; j <= n; ++j) sum += a[j] * b[n - j];
  return sum;
}

Real evaluate(const Series& a, Real s) {
  Real sum = 0;
  for (std::size_t k = a.size(); k-- > 0;) sum = sum * s + a[k];
  return sum;
}

class Taylor {
 public:
  Taylor(const Problem& p, int order) : p_(p), order_(order) {
    for (auto* group : {w_.data(), g_.data(), row_x_.data(), row_y_.data(), u_.data()})
      for (int i = 0; i < 3; ++i) group[i].assign(order + 1, 0);
    for (auto* one : {&x_, &y_, &z_, &s_, &cos_, &sin_}) one->assign(order + 1, 0);
    for (int i = 0; i < 3; ++i) w_[i][0] = p.omega[i];
    x_[0] = p.attitude[0], y_[0] = p.attitude[1], z_[0] = p.attitude[2], s_[0] = p.attitude[3];
  }

  /// The coefficients of all orders from those of order 0, at time t.
  void expand(Real t) {
    expand_orbit(t);
    const Vector& I = p_.moments;
    const auto& w = w_;
    for (int n = 0; n < order_; ++n) {
      const Vector tau = torque(n);
      const Vector gyroscopic{(I[1] - I[2]) * product(w[1], w[2], n), (I[2] - I[0]) * product(w[2], w[0], n),
                              (I[0] - I[1]) * product(w[0], w[1], n)};
      // q' = q (w, 0) / 2
      const Real scale = Real(1) / (2 * (n + 1));
      const Real x = product(s_, w[0], n) + product(y_, w[2], n) - product(z_, w[1], n);
      const Real y = product(s_, w[1], n) + product(z_, w[0], n) - product(x_, w[2], n);
      const Real z = product(s_, w[2], n) + product(x_, w[1], n) - product(y_, w[0], n);
      const Real s = -product(x_, w[0], n) - product(y_, w[1], n) - product(z_, w[2], n);
      for (int i = 0; i < 3; ++i) w_[i][n + 1] = (gyroscopic[i] + tau[i]) / (I[i] * (n + 1));
      x_[n + 1] = scale * x, y_[n + 1] = scale * y, z_[n + 1] = scale * z, s_[n + 1] = scale * s;
    }
  }

  Real step(Real tolerance) const {
    const std::vector<const Series*> rates{&w_[0], &w_[1], &w_[2]}, turns{&x_, &y_, &z_, &s_};
    Real h = 0;
    for (const auto* block : {&rates, &turns})
      for (int m : {order_ - 1, order_}) {
        Real first = 0, last = 0;
        for (const Series* a : *block) first = std::max(first, fabsq((*a)[0])), last = std::max(last, fabsq((*a)[m]));
        if (first == 0 || last == 0) continue;
        const Real limit = powq(tolerance * first / last, Real(1) / m);
        if (h == 0 || limit < h) h = limit;
      }
    return h;
  }

  void print(Real s) const {
    const std::vector<const Series*> all = variables();
    Real out[7];
    for (int i = 0; i < 7; ++i) out[i] = evaluate(*all[i], s);
    print_line(out, 7);
  }

  void advance(Real h) {
    Real next[7];
    const std::vector<const Series*> all = variables();
    for (int i = 0; i < 7; ++i) next[i] = evaluate(*all[i], h);
    for (int i = 0; i < 3; ++i) w_[i][0] = next[i];
    x_[0] = next[3], y_[0] = next[4], z_[0] = next[5], s_[0] = next[6];
  }

 private:
  std::vector<const Series*> variables() const { return {&w_[0], &w_[1], &w_[2], &x_, &y_, &z_, &s_}; }

  void expand_orbit(Real t) {
    if (p_.mean_motion == 0) return;
    const Real angle = p_.mean_motion * t + p_.phase;
    cos_[0] = cosq(angle), sin_[0] = sinq(angle);
    for (int n = 0; n < order_; ++n) {
      cos_[n + 1] = -p_.mean_motion * sin_[n] / (n + 1);
      sin_[n + 1] = p_.mean_motion * cos_[n] / (n + 1);
    }
  }

  Vector torque(int n) {
    Vector tau{};
    if (n == 0) tau = p_.constant;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (p_.damping[i][j] != 0) tau[i] -= p_.damping[i][j] * w_[j][n];
    for (int i = 0; i < 3; ++i) {  // h x w
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      tau[i] += p_.rotors[j] * w_[k][n] - p_.rotors[k] * w_[j][n];
    }
    if (p_.weight != 0) {  // tau = -weight r x g, g = third row of R
      g_[0][n] = 2 * (product(x_, z_, n) - product(s_, y_, n));
      g_[1][n] = 2 * (product(y_, z_, n) + product(s_, x_, n));
      g_[2][n] = product(z_, z_, n) + product(s_, s_, n) - product(x_, x_, n) - product(y_, y_, n);
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        tau[i] -= p_.weight * (p_.arm[j] * g_[k][n] - p_.arm[k] * g_[j][n]);
      }
    }
    if (p_.mean_motion != 0) {  // u = cos(nt) (first row of R) + sin(nt) (second row)
      const Real xx = product(x_, x_, n), yy = product(y_, y_, n), zz = product(z_, z_, n), ss = product(s_, s_, n);
      const Real xy = product(x_, y_, n), xz = product(x_, z_, n), yz = product(y_, z_, n);
      const Real sx = product(s_, x_, n), sy = product(s_, y_, n), sz = product(s_, z_, n);
      row_x_[0][n] = ss + xx - yy - zz, row_x_[1][n] = 2 * (xy - sz), row_x_[2][n] = 2 * (xz + sy);
      row_y_[0][n] = 2 * (xy + sz), row_y_[1][n] = ss - xx + yy - zz, row_y_[2][n] = 2 * (yz - sx);
      for (int i = 0; i < 3; ++i) u_[i][n] = product(cos_, row_x_[i], n) + product(sin_, row_y_[i], n);
      const Real scale = 3 * p_.mean_motion * p_.mean_motion;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        tau[i] += scale * (p_.moments[k] - p_.moments[j]) * product(u_[j], u_[k], n);
      }
    }
    return tau;
  }

  const Problem& p_;
  int order_;
  std::array<Series, 3> w_, g_, row_x_, row_y_, u_;
  Series x_, y_, z_, s_, cos_, sin_;
};

}  // namespace

int main() {
  const Problem p = Problem::read(std::cin);
  Taylor series(p, static_cast<int>(p.options.at(0)));
  const Real tolerance = powq(10, p.options.at(1));
  Real t = 0;
  long steps = 0;
  for (std::size_t i = 0; i < p.times.size();) {
    series.expand(t);
    const Real h = std::min(series.step(tolerance), p.times.back() - t);
    for (; i < p.times.size() && p.times[i] <= t + h; ++i) series.print(p.times[i] - t);
    series.advance(h);
    t += h, ++steps;
  }
  std::fprintf(stderr, "%ld steps\n", steps);
}
