#include "polhode/torque/damping.hpp"

#include "checks.hpp"
#include "polhode/formula/trace.hpp"

namespace polhode::torques {

Damping::Damping(const Matrix3d& matrix) : matrix_(matrix) { require_finite("Damping.matrix", matrix_.data(), 9); }

const TorqueRecord& Damping::record() {
  using Kind = TorqueParameter::Kind;
  static constexpr TorqueParameter parameters[] = {
      {"matrix", Kind::matrix, "N m s", "C in body axes; three numbers stand for a diagonal matrix"},
  };
  static constexpr TorqueRecord record{"Damping", "damping", "Linear damping: tau_B = -C w_B.",
                                       "Hughes 1986, Spacecraft Attitude Dynamics, sec. 5.2", parameters};
  return record;
}

Damping Damping::from_values(std::span<const TorqueValue> values) { return Damping(std::get<Matrix3d>(values[0])); }

formula::Program Damping::law(const Matrix3d&) const {
  formula::Input matrix{"matrix", {}};
  for (int i = 0; i < 9; ++i) matrix.values.push_back(matrix_(i / 3, i % 3));
  return formula::trace([&](const auto& in) {
    const auto C = in.template p<9>("matrix");
    formula::Vec<formula::Expr, 3> tau;
    for (std::size_t i = 0; i < 9; ++i) tau[i / 3] = tau[i / 3] - C[i] * in.omega[i % 3];
    return tau;
  }, {matrix});
}

}  // namespace polhode::torques
