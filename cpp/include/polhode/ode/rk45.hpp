#pragma once

#include "polhode/ode/method_record.hpp"
#include "polhode/ode/runge_kutta.hpp"
#include "polhode/ode/tableaus/dormand_prince54.hpp"

namespace polhode::ode {

/// The embedded pair of Dormand and Prince of orders 5 and 4, the field's workhorse.
struct Rk45 {
  static constexpr MethodRecord record{
      .name = "rk45",
      .order = 5,
      .dense_order = 4,
      .adaptive = true,
      .keeps = "nothing",
      .doc =
          "Explicit Runge-Kutta pair of orders 5(4) with seven stages, the last reused, for any torque at loose "
          "accuracies.",
      .source = "Dormand & Prince 1980, J. Comput. Appl. Math. 6, 19",
      .forecast = {.error_per_turn = 0.5,
                   .margin = 4.0,
                   .floor_per_turn = 1e-15,
                   .steps_per_radian = 0.2,
                   .power = 0.198,
                   .step_seconds = 1.7e-7,
                   .sample_seconds = 2.4e-8,
                   .calls_per_step = 6,
                   .stability = 3.3},
  };

  template <class P>
  using Stepper = RungeKuttaStepper<tableaus::DormandPrince54, P>;
};

}  // namespace polhode::ode
