#pragma once

#include <cmath>

#include "method/integrate.hpp"
#include "polhode/core/error.hpp"
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

/// Calls `action` with the scene's torques in the form that costs least to evaluate.
template <class Action>
Trajectory with_torque(const Scene& scene, Action&& action) {
  const auto& torques = scene.torques();
  if (torques.empty()) return action(NoTorque{});
  if (torques.size() > 1 || std::holds_alternative<torques::During>(torques.front()))
    return action(SeveralTorques{torques});
  return std::visit([&]<class Torque>(const Torque& one) -> Trajectory {
    if constexpr (std::is_same_v<Torque, torques::During>) return {};   // among several, above
    else return action(one);
  }, torques.front());
}

template <class Method>
Trajectory integrate_euler(const Scene& scene, const RunOptions& options) {
  const bool with_attitude =
      scene.want().attitude || scene.torque_sum().uses_attitude || !options.events.empty();
  const InertiaTensor& inertia = scene.inertia_B();
  return with_torque(scene, [&]<class Torque>(const Torque& torque) {
    const auto go = [&]<bool diagonal, bool attitude>() {
      const EulerProblem<Torque, diagonal, attitude> problem(inertia, torque);
      return integrate_problem<Method>(scene, problem, options);
    };
    Trajectory trajectory =
        inertia.is_diagonal()
            ? (with_attitude ? go.template operator()<true, true>() : go.template operator()<true, false>())
            : (with_attitude ? go.template operator()<false, true>() : go.template operator()<false, false>());
    trajectory.model = "euler", trajectory.state = with_attitude ? "omega, attitude" : "omega";
    return trajectory;
  });
}

template <class Method>
Trajectory integrate_lagrangian(const Scene& scene, const RunOptions& options) {
  constexpr const char* cause =
      "Lagrange's equations in z-x-z angles divide by sin(theta); Euler's, the default, do not";
  using Angles = LagrangianProblem<NoTorque>;
  const double theta = Angles::compute_angles(scene.attitude())[1];
  if (!(std::sin(theta) > Angles::least_sine)) {
    throw InvalidInput("formulation 'lagrangian'", "started away from theta = 0 and pi",
                       "theta = " + to_text(theta) + " rad", cause);
  }
  return with_torque(scene, [&]<class Torque>(const Torque& torque) {
    const LagrangianProblem<Torque> problem(scene.inertia_B(), torque);
    Trajectory trajectory = integrate_problem<Method>(scene, problem, options);
    if (trajectory.status == Status::failed) trajectory.message += std::string(": ") + cause;
    trajectory.model = "lagrangian", trajectory.state = "phi, theta, psi and their rates";
    return trajectory;
  });
}

/// A method for any y' = f(t, y) at work on a scene.
template <class Method>
Trajectory integrate_equations(const Scene& scene, const RunOptions& options) {
  return options.formulation == Formulation::euler ? integrate_euler<Method>(scene, options)
                                                         : integrate_lagrangian<Method>(scene, options);
}

}  // namespace polhode
