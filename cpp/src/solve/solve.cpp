#include "polhode/solve/solve.hpp"

#include <chrono>
#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/ode/methods.hpp"
#include "polhode/solve/euler_problem.hpp"
#include "polhode/solve/invariants.hpp"
#include "polhode/solve/lagrangian_problem.hpp"
#include "run.hpp"

namespace polhode {
namespace {

constexpr double least_rtol = 4 * std::numeric_limits<double>::epsilon();

/// What remains of the options once they have been checked.
struct RunOptions {
  const SolveOptions& asked;
  ode::Tolerances tolerances;
};

template <class Method, class P>
Motion run_problem(const Scene& scene, const P& problem, const RunOptions& options) {
  double y0[P::dimension];
  P::pack(scene.start(), y0);
  return run(scene, options.asked, y0, &P::unpack, [&](const double* y, double t_end) {
    return std::make_unique<typename Method::template Stepper<P>>(problem, scene.t0(), y, t_end, options.tolerances);
  });
}

/// Calls `action` with the scene's torques in the form that costs least to evaluate.
template <class Action>
Motion with_torque(const Scene& scene, Action&& action) {
  const auto& torques = scene.torques();
  if (torques.empty()) return action(NoTorque{});
  if (torques.size() == 1) return std::visit([&](const auto& one) { return action(one); }, torques.front());
  return action(SeveralTorques{torques});
}

template <class Method>
Motion run_euler(const Scene& scene, const RunOptions& options) {
  const bool with_attitude =
      scene.want().attitude || scene.torque_sum().uses_attitude || !options.asked.events.empty();
  const InertiaTensor& inertia = scene.inertia_B();
  return with_torque(scene, [&]<class Torque>(const Torque& torque) {
    const auto go = [&]<bool diagonal, bool attitude>() {
      const EulerProblem<Torque, diagonal, attitude> problem(inertia, torque);
      return run_problem<Method>(scene, problem, options);
    };
    Motion motion = inertia.is_diagonal()
                        ? (with_attitude ? go.template operator()<true, true>() : go.template operator()<true, false>())
                        : (with_attitude ? go.template operator()<false, true>() : go.template operator()<false, false>());
    motion.plan = {"euler", "", with_attitude ? "omega, attitude" : "omega"};
    return motion;
  });
}

template <class Method>
Motion run_lagrangian(const Scene& scene, const RunOptions& options) {
  constexpr const char* cause = "Lagrange's equations in z-x-z angles divide by sin(theta); Euler's, the default, do not";
  using Angles = LagrangianProblem<NoTorque>;
  const double theta = Angles::compute_angles(scene.attitude())[1];
  if (!(std::sin(theta) > Angles::least_sine)) {
    throw InvalidInput("formulation 'lagrangian'", "started away from theta = 0 and pi",
                       "theta = " + to_text(theta) + " rad", cause);
  }
  return with_torque(scene, [&]<class Torque>(const Torque& torque) {
    const LagrangianProblem<Torque> problem(scene.inertia_B(), torque);
    Motion motion = run_problem<Method>(scene, problem, options);
    if (motion.status == Status::failed) motion.message += std::string(": ") + cause;
    motion.plan = {"lagrangian", "", "phi, theta, psi and their rates"};
    return motion;
  });
}

void require_positive(const char* where, const std::optional<double>& value) {
  if (value && !(std::isfinite(*value) && *value > 0.0)) throw InvalidInput(where, "positive and finite", to_text(*value));
}

}  // namespace

Motion solve(const Scene& scene, const SolveOptions& options) {
  if (options.accuracy && !(*options.accuracy > 0.0 && *options.accuracy <= 1.0)) {
    throw InvalidInput("accuracy", "above 0 and at most 1", to_text(*options.accuracy));
  }
  if (options.accuracy && (options.rtol || options.atol)) {
    throw InvalidInput("accuracy", "left out where rtol or atol is given", to_text(*options.accuracy),
                       "accuracy is about the answer, rtol and atol are about a step");
  }
  require_positive("rtol", options.rtol);
  if (options.atol && !(std::isfinite(*options.atol) && *options.atol >= 0.0)) {
    throw InvalidInput("atol", "0 or positive, and finite", to_text(*options.atol));
  }
  if (options.max_steps < 1) throw InvalidInput("max_steps", "at least 1", std::to_string(options.max_steps));
  for (const SceneEvent& event : options.events) {
    if (event.direction < -1 || event.direction > 1) {
      throw InvalidInput("event.direction", "-1, 0 or 1", std::to_string(event.direction));
    }
  }
  const std::string method = options.method.value_or("rk45");
  const ode::MethodRecord& record = ode::find_method(method);
  if (record.adaptive && options.step) {
    throw InvalidInput("step", "left out with method '" + method + "'", to_text(*options.step),
                       "it chooses its own steps by rtol and atol");
  }

  const double asked = options.accuracy ? *options.accuracy : options.rtol.value_or(1e-9);
  double rtol = options.rtol ? *options.rtol : asked / 10;
  const bool raised = rtol < least_rtol;
  if (raised) rtol = least_rtol;
  const RunOptions run_options{options, {rtol, options.atol.value_or(0.0)}};

  const auto begin = std::chrono::steady_clock::now();
  Motion motion = ode::with_method(method, [&]<class Method>() {
    return options.formulation == Formulation::euler ? run_euler<Method>(scene, run_options)
                                                     : run_lagrangian<Method>(scene, run_options);
  });
  motion.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  motion.plan.method = method;
  motion.asked = asked;
  if (motion.message.empty()) motion.message = "reached the last time; the error was not estimated";
  if (raised) motion.message += "; the tolerance was raised to " + to_text(rtol) + ", the least that float64 can serve";
  return motion;
}

bool succeeded(const Scene& scene, const Motion& motion) {
  if (motion.status != Status::finished && motion.status != Status::event) return false;
  for (const auto& [name, moved] : compute_drift(scene, motion)) {
    if (!(moved <= motion.asked)) return false;
  }
  return true;
}

}  // namespace polhode
