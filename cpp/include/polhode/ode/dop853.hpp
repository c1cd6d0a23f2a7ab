#pragma once

#include "polhode/ode/method_record.hpp"
#include "polhode/ode/runge_kutta.hpp"
#include "polhode/ode/tableaus/dormand_prince853.hpp"

namespace polhode::ode {

/// The embedded pair of Dormand and Prince of order 8, for torques that have no other form at accuracies of 1e-6 and
/// below.
struct Dop853 {
  static constexpr MethodRecord record{
      .name = "dop853",
      .order = 8,
      .dense_order = 7,
      .adaptive = true,
      .keeps = "nothing",
      .doc = "Explicit Runge-Kutta pair of orders 8(5,3) with twelve stages, for any torque at tight accuracies.",
      .source = "Hairer, Norsett & Wanner 1993, Solving ODEs I, sec. II.5 and II.6",
      .forecast = {.error_per_turn = 0.25,
                   .margin = 10.0,
                   .floor_per_turn = 1e-15,
                   .steps_per_radian = 0.17,
                   .power = 0.122,
                   .step_seconds = 4.5e-7,
                   .sample_seconds = 4.5e-8,
                   .calls_per_step = 13,
                   .stability = 6.0},
  };

  template <class P>
  using Stepper = RungeKuttaStepper<tableaus::DormandPrince853, P>;
};

}  // namespace polhode::ode
