#pragma once

#include "polhode/torque/law.hpp"

namespace polhode::torques {

template <class T>
struct DampingNumbers {
  Mat<T> matrix;
  static auto list(auto& of) { return std::tie(of.matrix); }
};

/// Linear damping: tau_B = -C w_B with any constant matrix C.
class Damping : public Law<Damping, DampingNumbers> {
 public:
  static constexpr TorqueParameter parameters[] = {
      {"matrix", TorqueParameter::Kind::matrix, "N m s",
       "C in body axes; three numbers stand for a diagonal matrix"},
  };
  static constexpr TorqueRecord about{"Damping", "damping", "Linear damping: tau_B = -C w_B.",
                                      "Hughes 1986, Spacecraft Attitude Dynamics, sec. 5.2", parameters};

  using Law::Law;
  /// @param matrix  C, body axes [N m s]
  explicit Damping(const Matrix3d& matrix) : Law(DampingNumbers<double>{formula::make_matrix<double>(matrix)}) {}

  static auto compute(const auto& in, const auto& p) { return -(p.matrix * in.omega); }

  Matrix3d matrix() const { return to_eigen(numbers().matrix); }

  TorqueTraits traits() const { return {.uses_rates = true, .vanishes = matrix().isZero(0.0)}; }
  formula::KnownTorque known() const { return {.kind = formula::KnownTorque::Kind::damping, .matrix = matrix()}; }
};

}  // namespace polhode::torques
