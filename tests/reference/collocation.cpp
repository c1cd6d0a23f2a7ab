/// Gauss-Legendre collocation of (omega, rotation matrix) in 113-bit arithmetic: the second opinion on taylor.cpp,
/// with another method, another form of the attitude and a plain right-hand side. One line "w R" (3 + 9) per sample.
/// The damping, which may be stiff, is solved with the stages; all the rest is iterated to a fixed point.
/// Hairer & Wanner, Solving Ordinary Differential Equations II, IV.5 and IV.8.
/// options: stages s, largest step, first step (0: none smaller), nodes c (s), coefficients A (s x s).
#include <algorithm>

#include "problem.hpp"

namespace {

constexpr int kSize = 12;  // omega and the rows of R
using State = std::array<Real, kSize>;

State derivative(const Problem& p, Real t, const State& y) {
  const Vector& I = p.moments;
  const Vector w{y[0], y[1], y[2]};
  const Real* R = &y[3];
  Vector tau = p.constant, u{};
  if (p.mean_motion != 0) {
    const Real c = cosq(p.mean_motion * t + p.phase), s = sinq(p.mean_motion * t + p.phase);
    for (int i = 0; i < 3; ++i) u[i] = c * R[i] + s * R[3 + i];
  }
  State f;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (int m = 0; m < 3; ++m) tau[i] -= p.damping[i][m] * w[m];
    tau[i] -= p.weight * (p.arm[j] * R[6 + k] - p.arm[k] * R[6 + j]);
    tau[i] += 3 * p.mean_motion * p.mean_motion * (u[j] * I[k] * u[k] - u[k] * I[j] * u[j]);
    const Real Lj = I[j] * w[j] + p.rotors[j], Lk = I[k] * w[k] + p.rotors[k];  // of body and rotors
    f[i] = (tau[i] - (w[j] * Lk - w[k] * Lj)) / I[i];
    for (int row = 0; row < 3; ++row)  // R' = R [w]x
      f[3 + 3 * row + i] = R[3 * row + j] * w[k] - R[3 * row + k] * w[j];
  }
  return f;
}

class Collocation {
 public:
  explicit Collocation(const Problem& p) : p_(p), s_(static_cast<int>(p.options.at(0))) {
    const auto begin = p.options.begin() + 3;
    c_.assign(begin, begin + s_);
    a_.assign(begin + s_, begin + s_ + s_ * s_);
    for (const Vector& row : p.damping)
      for (Real x : row) damped_ = damped_ || x != 0;
    if (static_cast<int>(p.options.size()) != 3 + s_ + s_ * s_) std::exit((std::fputs("wrong tableau\n", stderr), 1));
    y_ = {p.omega[0], p.omega[1], p.omega[2]};
    const auto& [x, y, z, w] = p.attitude;
    const Real R[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                       2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                       2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)};
    std::copy(R, R + 9, y_.begin() + 3);
  }

  void print() const { print_line(y_.data(), kSize); }

  void step(Real t, Real h) {
    std::vector<State> increment(s_, State{}), f(s_);
    for (int i = 0; i < s_; ++i) f[i] = derivative(p_, t, y_);
    if (damped_) factor(h);
    Real change = 1, before = 2;
    int rounds = 0;
    for (; rounds < 200 && (change > 1e-20Q || change < before / 2); ++rounds) {
      before = change, change = 0;
      std::vector<State> residual(s_, State{});
      for (int i = 0; i < s_; ++i)
        for (int j = 0; j < s_; ++j)
          for (int m = 0; m < kSize; ++m) residual[i][m] += h * a_[i * s_ + j] * f[j][m];
      for (int i = 0; i < s_; ++i)
        for (int m = 0; m < kSize; ++m) residual[i][m] -= increment[i][m];
      if (damped_) correct_rates(residual);
      for (int i = 0; i < s_; ++i) {
        State stage;
        for (int m = 0; m < kSize; ++m) {
          increment[i][m] += residual[i][m];
          change = std::max(change, fabsq(residual[i][m]));
          stage[m] = y_[m] + increment[i][m];
        }
        f[i] = derivative(p_, t + c_[i] * h, stage);
      }
    }
    if (rounds == 200) std::exit((std::fputs("no fixed point: smaller steps, please\n", stderr), 1));
    extrapolate(increment);
  }

 private:
  /// The value at the end of the step: the stages' polynomial through (0, 0) and (c_i, increment_i) at 1.
  void extrapolate(const std::vector<State>& increment) {
    for (int i = 0; i < s_; ++i) {
      Real weight = 1 / c_[i];
      for (int j = 0; j < s_; ++j)
        if (j != i) weight *= (1 - c_[j]) / (c_[i] - c_[j]);
      for (int m = 0; m < kSize; ++m) y_[m] += weight * increment[i][m];
    }
  }

  /// E + h A (x) I^-1 C of the 3 s stage rates, triangular factors with row exchanges.
  void factor(Real h) {
    if (h == factored_) return;
    factored_ = h;
    const int n = 3 * s_;
    lu_.assign(n * n, 0);
    order_.resize(n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        lu_[i * n + j] = Real(i == j) + h * a_[i / 3 * s_ + j / 3] * p_.damping[i % 3][j % 3] / p_.moments[i % 3];
    for (int k = 0; k < n; ++k) {
      int best = k;
      for (int i = k; i < n; ++i)
        if (fabsq(lu_[i * n + k]) > fabsq(lu_[best * n + k])) best = i;
      order_[k] = best;
      for (int j = 0; j < n; ++j) std::swap(lu_[k * n + j], lu_[best * n + j]);
      for (int i = k + 1; i < n; ++i) {
        lu_[i * n + k] /= lu_[k * n + k];
        for (int j = k + 1; j < n; ++j) lu_[i * n + j] -= lu_[i * n + k] * lu_[k * n + j];
      }
    }
  }

  void correct_rates(std::vector<State>& residual) const {
    const int n = 3 * s_;
    std::vector<Real> x(n);
    for (int i = 0; i < n; ++i) x[i] = residual[i / 3][i % 3];
    for (int k = 0; k < n; ++k) std::swap(x[k], x[order_[k]]);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j) x[i] -= lu_[i * n + j] * x[j];
    for (int i = n; i-- > 0;) {
      for (int j = i + 1; j < n; ++j) x[i] -= lu_[i * n + j] * x[j];
      x[i] /= lu_[i * n + i];
    }
    for (int i = 0; i < n; ++i) residual[i / 3][i % 3] = x[i];
  }

  const Problem& p_;
  int s_;
  bool damped_ = false;
  State y_;
  std::vector<Real> c_, a_, lu_;
  std::vector<int> order_;
  Real factored_ = 0;
};

}  // namespace

int main() {
  const Problem p = Problem::read(std::cin);
  Collocation method(p);
  const Real largest = p.options.at(1);
  Real growing = p.options.at(2) == 0 ? largest : p.options.at(2);
  Real t = 0;
  long steps = 0;
  for (const Real sample : p.times) {
    while (t < sample) {
      const Real allowed = std::min(growing, largest);
      const Real h = (sample - t) / ceilq((sample - t) / allowed * (1 - 1e-12Q));
      method.step(t, h);
      t = sample - t > h * 1.5Q ? t + h : sample;
      ++steps;
      if (p.options.at(2) != 0 && steps % 40 == 0 && growing < largest) growing *= 2;  // past a boundary layer
    }
    method.print();
  }
  std::fprintf(stderr, "%ld steps\n", steps);
}
