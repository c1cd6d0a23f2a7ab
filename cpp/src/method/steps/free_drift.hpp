#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "method/series/lanes/levels.hpp"
#include "method/series/separatrix.hpp"
#include "polhode/math/detail/double_double.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/series.hpp"

namespace polhode {

/// The motion of a free triaxial body over a short time, exact to rounding, by its Taylor series. The state has the
/// rates in plain or separatrix variables (series/separatrix.hpp), with their rounding errors.
class FreeDrift {
 public:
  static constexpr int numbers = 10;   ///< of a state: rate variables, their rounding errors, those of the quaternion

  /// @param I  principal moments, ascending  @param w  rates at the start
  FreeDrift(const Vector3d& I, const Vector3d& w) : separatrix_(I) {
    using math::DD;
    DD product[3] = {separatrix_.rate(), -separatrix_.rate(), separatrix_.middle()};
    if (separatrix_.suits(w)) {
      terms_.variables = RateVariables::separatrix;
      terms_.to_rates[0] = separatrix_.half_over_k().hi, terms_.to_rates[2] = 0.5;
    } else {
      for (int i = 0; i < 3; ++i) product[i] = math::two_diff(I[(i + 1) % 3], I[(i + 2) % 3]) / DD(I[i]);
    }
    for (int i = 0; i < 3; ++i) terms_.product[i] = product[i].hi, terms_.product_low[i] = product[i].lo;
    const double lower = I[1] - I[0], upper = I[2] - I[1], both = I[2] - I[0];
    square_[0] = lower / I[2] * (both / I[1]), square_[1] = lower / I[2] * (upper / I[0]),
    square_[2] = upper / I[0] * (both / I[1]);
    kernel_ = find_series_kernel(terms_, true);
  }

  void start(const double* w, double* state) const {
    std::fill_n(state, numbers, 0.0);
    if (terms_.variables == RateVariables::separatrix) {
      separatrix_.from_rates(w, state, state + 3);
    } else {
      std::copy_n(w, 3, state);
    }
  }

  /// Adds `a` to the rates.
  void kick(const double* a, double* state) const {
    double r[3];
    if (terms_.variables == RateVariables::separatrix) {
      separatrix_.from_vector(a, r);
    } else {
      std::copy_n(a, 3, r);
    }
    for (int i = 0; i < 3; ++i) add(r[i] + state[3 + i], state[i], state[3 + i]);
  }

  void to_rates(const double* state, double* w) const {
    if (terms_.variables == RateVariables::separatrix) {
      separatrix_.to_rates(state, w);
    } else {
      std::copy_n(state, 3, w);
    }
  }

  /// Returns false, without a change, if the time is too long for a few series.
  bool advance(double h, double* state, double* q) const {
    double w[3];
    to_rates(state, w);
    // The poles of Jacobi's functions are at least K'/rate away, with K' > pi/2. The quaternion also rotates by |w| h /
    // 2.
    const double first = square_[0] * w[0] * w[0], third = square_[2] * w[2] * w[2];
    const double rate = std::sqrt(square_[1] * w[1] * w[1] + std::max(first, third));
    const double radii = std::abs(h) * rate * (2 / std::numbers::pi);
    const double angle = 0.5 * std::abs(h) * std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double parts = std::max(1.0, std::ceil(std::max(radii / enough.radii[most], angle / enough.angle[most])));
    if (!(parts <= most_parts)) return false;
    int order = least;
    while (radii > parts * enough.radii[order] || angle > parts * enough.angle[order]) order += 2;
    for (int i = 0; i < static_cast<int>(parts); ++i) expand(h / parts, order, state, q);
    return true;
  }

 private:
  static constexpr int least = 4, most = 24;
  static constexpr double most_parts = 8.0;

  /// For a remainder of 2^-64, by order n: the part of the radius of convergence, and x with x^n / n! = 2^-64.
  struct Enough {
    double radii[most + 1], angle[most + 1];
    Enough() {
      double factorial = 1.0;
      for (int n = 1; n <= most; ++n) {
        factorial *= n;
        radii[n] = math::fast_exp2(-64.0 / n), angle[n] = math::fast_pow(0x1p-64 * factorial, 1.0 / n);
      }
    }
  };
  static inline const Enough enough;

  static void add(double change, double& value, double& carry) {
    const math::DD sum = math::two_sum(value, change);
    value = sum.hi, carry = sum.lo;
  }

  void expand(double h, int order, double* state, double* q) const {
    alignas(64) double y[8] = {state[0], state[1], state[2], 0.0, q[0], q[1], q[2], q[3]};
    const double rest[8] = {state[3], state[4], state[5], 0.0, state[6], state[7], state[8], state[9]};
    alignas(64) double rows[ode::series_width * (most + 1)], change[8];
    kernel_(terms_, {y, nullptr, 1.0}, order, rows);
    constexpr double zero[8] = {};
    ode::evaluate_series(rows, order, ode::series_width, zero, rest, &h, 1, change);
    for (int i = 0; i < 3; ++i) add(change[i], state[i], state[3 + i]);
    double norm = 0.0, cross = 0.0;
    for (int i = 0; i < 4; ++i) {
      add(change[4 + i], q[i], state[6 + i]);
      norm += q[i] * q[i], cross += q[i] * state[6 + i];
    }
    const double residual = 0.5 * (1.0 - norm) - cross;   // restores |q| = 1
    for (int i = 0; i < 4; ++i) add(state[6 + i] + residual * q[i], q[i], state[6 + i]);
  }

  Separatrix separatrix_;
  SeriesTerms terms_;
  SeriesKernel kernel_;
  double square_[3];
};

}  // namespace polhode
