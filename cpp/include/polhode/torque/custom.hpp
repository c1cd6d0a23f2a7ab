#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// A user's own torque: a compiled function with a C signature, or any C++ callable.
class Custom {
 public:
  /// omega: w_B, 3 numbers; attitude: unit q_WB, 4 numbers (x, y, z, w); torque: tau_B, 3 numbers to be written.
  using Function = void (*)(double t, const double* omega, const double* attitude, double* torque, void* data);
  /// The potential energy [J], for the energy's drift.
  using Potential = double (*)(double t, const double* attitude, void* data);

  /// The inputs that the function uses. A false claim makes plans wrong, so claim nothing when in doubt.
  struct Claims {
    bool uses_time = true;
    bool uses_attitude = true;
    bool uses_rates = true;
  };

  /// @param owner  kept alive as long as this torque, for functions whose data has an owner
  Custom(Function function, void* data, const Claims& claims, Potential potential = nullptr,
         std::shared_ptr<const void> owner = nullptr);
  explicit Custom(Function function, void* data = nullptr) : Custom(function, data, Claims{}) {}

  /// From a callable `void(double t, const double* omega, const double* attitude, double* torque)`.
  template <class Callable>
    requires(std::is_invocable_v<Callable&, double, const double*, const double*, double*>)
  static Custom from(Callable callable, const Claims& claims) {
    auto owner = std::make_shared<Callable>(std::move(callable));
    const Function call = [](double t, const double* omega, const double* attitude, double* torque, void* data) {
      (*static_cast<Callable*>(data))(t, omega, attitude, torque);
    };
    void* data = owner.get();
    return Custom(call, data, claims, nullptr, std::move(owner));
  }

  static const TorqueRecord& record();
  /// The class that the user made: Custom, or Formula while a formula is integrated.
  std::string_view name() const { return name_; }

  /// The same torque, which may jump or kink at these times [s]. solve() divides the span there.
  /// @throws InvalidInput for a time that is not finite
  Custom with_breaks(std::vector<double> times) const;
  const std::vector<double>& breaks() const { return breaks_; }   ///< sorted, separate

  /// The same torque without breaks, for a span between two of them. At the ends the function gets times slightly
  /// within, so that it need not know on which side of a jump a step ends.
  Custom between(double begin, double end) const;

  TorqueTraits traits() const {
    return {.uses_time = claims_.uses_time,
            .uses_attitude = claims_.uses_attitude,
            .uses_rates = claims_.uses_rates,
            .has_potential = potential_ != nullptr};
  }

  /// A result that is not finite is passed on and ends the run. Exceptions of the function propagate.
  void add(const TorqueInput& in, double* tau_B) const {
    double unit[4], torque[3] = {NAN, NAN, NAN};
    normalise(in.attitude, unit);
    function_(std::clamp(in.t, begin_, end_), in.omega, unit, torque, data_);
    // Read one by one, as they were written: a wider load would stall until the stores are done.
    const volatile double* written = torque;
    for (int i = 0; i < 3; ++i) tau_B[i] += written[i];
  }
  double compute_potential(const TorqueInput& in) const;

  const std::shared_ptr<const void>& owner() const { return owner_; }

 private:
  /// q / |q|. The stages of a step are nearly unit, and a square root with a division would cost more than the call.
  static void normalise(const double* q, double* unit) {
    const double d = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0;
    const double s = std::abs(d) < 1e-5 ? 1.0 - d * (0.5 - 0.375 * d) : 1.0 / std::sqrt(1.0 + d);
    for (int i = 0; i < 4; ++i) unit[i] = s * q[i];
  }

  friend class Formula;

  std::string_view name_ = "Custom";
  Function function_;
  void* data_;
  Claims claims_;
  Potential potential_;
  std::shared_ptr<const void> owner_;
  std::vector<double> breaks_ = {};
  double begin_ = -std::numeric_limits<double>::infinity(), end_ = std::numeric_limits<double>::infinity();
};

}  // namespace polhode::torques
