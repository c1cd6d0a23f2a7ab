#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "polhode/formula/tape.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode::formula {

/// Exponents of w_1, w_2, w_3, x, y, z, w, cos a, sin a, with those of w and sin a at most 1.
using Monomial = std::array<std::uint8_t, 9>;
inline constexpr std::size_t cosine_place = 7, sine_place = 8;

/// A coefficient, and the sizes of what was summed in it: where they cancel, it is zero but for rounding.
struct Coefficient {
  math::DD value;
  double size = 0.0;

  bool is_zero() const { return std::abs(value.hi) <= 0x1p-49 * size; }
};

/// A polynomial in the rates, the attitude, and one wave of the time, modulo |q| = 1 and cos^2 + sin^2 = 1.
class Polynomial {
 public:
  static constexpr int most_degree = 4;   ///< in the rates, in the attitude, and in the wave
  static constexpr std::size_t most_terms = 1000;

  Polynomial() = default;
  explicit Polynomial(double constant) { add(Monomial{}, {constant, std::abs(constant)}); }
  static Polynomial variable(std::size_t place);

  void add(const Polynomial& other, double factor);
  /// Nothing beyond the limits.
  static std::optional<Polynomial> multiply(const Polynomial& a, const Polynomial& b);

  bool is_zero() const;
  double coefficient(const Monomial& monomial) const;   ///< 0 where it is zero but for rounding
  const std::map<Monomial, Coefficient>& terms() const { return terms_; }

 private:
  void add(const Monomial& monomial, const Coefficient& coefficient);
  void add_reduced(Monomial monomial, const Coefficient& coefficient);

  std::map<Monomial, Coefficient> terms_;
};

/// The first three outputs: polynomials, and the terms that are none.
struct TorquePolynomials {
  std::array<Polynomial, 3> tau;
  std::optional<Wave> wave;
  Program rest;   ///< the other terms, and the further outputs
};
TorquePolynomials expand_torque(const Program& torque);

/// Adds polynomials to the first three outputs.
Program add_polynomials(Program torque, const std::array<Polynomial, 3>& tau, const std::optional<Wave>& wave);

}  // namespace polhode::formula
