#pragma once

#include <cmath>

#include "method/integrate.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/method/euler_problem.hpp"
#include "polhode/method/lagrangian_problem.hpp"

namespace polhode {

template <class Method, class P>
Trajectory integrate_problem(const Scene& scene, const P& problem, const RunOptions& options) {
  double y0[P::dimension];
  P::pack(scene.start(), y0);
  return integrate(scene, options, y0, by_rows<P::dimension>(&P::unpack), [&](const double* y, double t_end) {
    return std::make_unique<typename Method::template Stepper<P>>(problem, scene.t0(), y, t_end, options.tolerances);
  });
}

/// Euler's equations are compiled separately without a torque, with gravity, and with gravity's gradient. These are
/// common and cheap to evaluate. All other torques share one type, which costs little time in a run and saves four
/// fifths of the compilation.
template <class Method>
Trajectory integrate_euler(const Scene& scene, const RunOptions& options) {
  const bool with_attitude = scene.want().attitude || scene.torque_sum().uses_attitude || !options.events.empty();
  const InertiaTensor& inertia = scene.inertia_B();
  const auto run = [&]<bool diagonal, bool attitude>(const auto& torque) {
    const EulerProblem<std::remove_cvref_t<decltype(torque)>, diagonal, attitude> problem(inertia, torque);
    Trajectory trajectory = integrate_problem<Method>(scene, problem, options);
    trajectory.model = "euler", trajectory.state = attitude ? "omega, attitude" : "omega";
    return trajectory;
  };
  const auto& torques = scene.torques();
  const SeveralTorques all = scene.all_torques();
  const bool rotors = !scene.rotor_momentum().isZero(0.0);
  if (!inertia.is_diagonal())
    return with_attitude ? run.template operator()<false, true>(all) : run.template operator()<false, false>(all);
  if (!all.any()) {
    return with_attitude ? run.template operator()<true, true>(NoTorque{})
                         : run.template operator()<true, false>(NoTorque{});
  }
  if (torques.size() == 1 && with_attitude && !rotors) {
    if (const auto* gravity = std::get_if<torques::Gravity>(&torques.front()))
      return run.template operator()<true, true>(*gravity);
    if (const auto* gradient = std::get_if<torques::GravityGradient>(&torques.front()))
      return run.template operator()<true, true>(*gradient);
  }
  return with_attitude ? run.template operator()<true, true>(all) : run.template operator()<true, false>(all);
}

template <class Method>
Trajectory integrate_lagrangian(const Scene& scene, const RunOptions& options) {
  constexpr const char* cause =
      "Lagrange's equations in z-x-z angles divide by sin(theta), Euler's equations do not";
  using Problem = LagrangianProblem<SeveralTorques>;
  const double theta = Problem::compute_angles(scene.attitude())[1];
  if (!(math::sin(theta) > Problem::least_sine)) {
    throw InvalidInput("formulation 'lagrangian'", "started away from theta = 0 and pi",
                       "theta = " + to_text(theta) + " rad", cause);
  }
  const SeveralTorques torques = scene.all_torques();
  const Problem problem(scene.inertia_B(), torques);
  Trajectory trajectory = integrate_problem<Method>(scene, problem, options);
  if (trajectory.status == Status::failed) trajectory.message.append(": ").append(cause);
  trajectory.model = "lagrangian", trajectory.state = "phi, theta, psi and their rates";
  return trajectory;
}

/// Integrates a scene by a method for any y' = f(t, y).
template <class Method>
Trajectory integrate_equations(const Scene& scene, const RunOptions& options) {
  return options.formulation == Formulation::euler ? integrate_euler<Method>(scene, options)
                                                   : integrate_lagrangian<Method>(scene, options);
}

}  // namespace polhode
