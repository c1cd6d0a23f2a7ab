#pragma once

#include <cmath>

namespace polhode::radau {

/// Radau IIA of order 5: Hairer & Wanner 1996, Solving ODEs II, sec. IV.5 and IV.8. These are its nodes, and the
/// weights of the embedded formula of order 3 (8.19).
inline constexpr double root6 = 2.4494897427831780982;
inline constexpr double node[3] = {(4 - root6) / 10, (4 + root6) / 10, 1.0};
inline constexpr double error[3] = {(-13 - 7 * root6) / 3, (-13 + 7 * root6) / 3, -1.0 / 3};

/// The inverse of the Runge-Kutta matrix has one real eigenvalue and a complex pair. T makes it block diagonal (8.5),
/// (8.6).
inline constexpr double mu_real = 3.6378342527444957322;
inline constexpr double mu_re = 2.6810828736277521339, mu_im = -3.0504301992474105694;
inline constexpr double T[3][3] = {{0.09443876248897524149, -0.14125529502095420843, 0.03002919410514742449},
                                   {0.25021312296533331793, 0.20412935229379993199, -0.38294211275726193779},
                                   {1.0, 1.0, 0.0}};
inline constexpr double T_inverse[3][3] = {{4.17871859155190428, 0.32768282076106237, 0.52337644549944951},
                                           {-4.17871859155190428, -0.32768282076106237, 0.47662355450055044},
                                           {0.50287263494578682, -2.57192694985560522, 0.59603920482822492}};

struct Complex {
  double re, im;
};
inline Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
inline Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
inline Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }

/// (mu - h J)^-1 by cofactors; `Number` is double or Complex.
template <class Number>
void invert(const Number (&m)[3][3], Number (&out)[3][3], Number (*reciprocal)(Number)) {
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      out[j][i] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
  }
  const Number d = reciprocal(m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0]);
  for (auto& row : out)
    for (Number& x : row) x = x * d;
}

/// The two linear systems of a Newton step, three equations each, real and complex: (mu - h J) x = b.
class Systems {
 public:
  void prepare(const double (&J)[3][3], double h) {
    double real[3][3];
    Complex complex[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double hJ = h * J[i][j];
        real[i][j] = (i == j ? mu_real : 0.0) - hJ;
        complex[i][j] = {(i == j ? mu_re : 0.0) - hJ, i == j ? mu_im : 0.0};
      }
    }
    invert<double>(real, real_, [](double x) { return 1.0 / x; });
    invert<Complex>(complex, complex_, [](Complex z) {
      const double n = z.re * z.re + z.im * z.im;
      return Complex{z.re / n, -z.im / n};
    });
  }

  void solve_real(const double* b, double* x) const {
    for (int i = 0; i < 3; ++i) x[i] = real_[i][0] * b[0] + real_[i][1] * b[1] + real_[i][2] * b[2];
  }
  void solve_complex(const Complex* b, Complex* x) const {
    for (int i = 0; i < 3; ++i) x[i] = complex_[i][0] * b[0] + complex_[i][1] * b[1] + complex_[i][2] * b[2];
  }

  /// The largest possible sizes of the solution for right-hand sides of these sizes.
  void spread(const double* size, double* x) const {
    for (int i = 0; i < 3; ++i) {
      x[i] = std::abs(real_[i][0]) * size[0] + std::abs(real_[i][1]) * size[1] + std::abs(real_[i][2]) * size[2];
    }
  }

 private:
  double real_[3][3];
  Complex complex_[3][3];
};

}  // namespace polhode::radau
