#include "solve/ground/options.hpp"

#include <cmath>

#include "method/method.hpp"
#include "method/series/formula_series.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/solve/plan.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {
namespace {

void require_positive(const char* where, const std::optional<double>& value) {
  if (value && !(std::isfinite(*value) && *value > 0.0))
    throw InvalidInput(where, "positive and finite", to_text(*value));
}

/// Refuses options without effect, and missing options.
void require_fitting(const ode::MethodRecord& record, const SolveOptions& options) {
  const std::string with = " with method '" + std::string(record.name) + "'";
  if (record.adaptive) {
    if (options.step) {
      throw InvalidInput("step", "left out" + with, to_text(*options.step),
                         "its step size follows from rtol and atol");
    }
    return;
  }
  if (!options.step) throw InvalidInput("step", "given" + with, "none", "it takes steps of one fixed length");
  const std::pair<const char*, const std::optional<double>&> without_effect[] = {
      {"accuracy", options.accuracy}, {"rtol", options.rtol}, {"atol", options.atol}};
  for (const auto& [where, value] : without_effect) {
    if (value) throw InvalidInput(where, "left out" + with, to_text(*value), "its error follows from step");
  }
}

void require_no_steps(const SolveOptions& options) {
  constexpr const char* cause = "a closed form has no steps";
  const std::pair<const char*, const std::optional<double>&> without_effect[] = {
      {"rtol", options.rtol}, {"atol", options.atol}, {"step", options.step}};
  for (const auto& [where, value] : without_effect) {
    if (value) throw InvalidInput(where, "left out with method 'exact'", to_text(*value), cause);
  }
  if (options.formulation != Formulation::euler) {
    throw InvalidInput("formulation", "left out with method 'exact'", "'lagrangian'",
                       "a closed form has no equations to integrate");
  }
}

[[noreturn]] void refuse_with_proof(const std::string& where, const std::string& found, const std::string& cause) {
  throw InvalidInput(where, "left out with certify='proof'", found, cause);
}

/// Refuses options and torques for which there is no proof.
void require_provable(const Scene& scene, const SolveOptions& options) {
  if (!options.proof) return;
  if (!options.certify) throw InvalidInput("certify", "true with proof", "false");
  const std::pair<const char*, const std::optional<double>&> tolerances[] = {
      {"rtol", options.rtol}, {"atol", options.atol}, {"step", options.step}};
  for (const auto& [where, value] : tolerances)
    if (value) refuse_with_proof(where, to_text(*value), "a proof is made for an accuracy and chooses its own steps");
  if (options.method)
    refuse_with_proof("method", "'" + *options.method + "'", "a proof has one method: Taylor series with a rigorous remainder");
  if (options.formulation != Formulation::euler)
    refuse_with_proof("formulation", "'lagrangian'", "a proof encloses Euler's equations");
  if (options.dense) refuse_with_proof("dense", "True", "bounds are given at the scene's times: add the times that are needed");
  if (!options.events.empty())
    refuse_with_proof("events", std::to_string(options.events.size()), "a function of the user's own has no known bounds");
  if (!rounds_to_nearest()) {
    throw InvalidInput("certify='proof'", "used where the processor rounds to nearest", "another rounding mode",
                       "the bounds on rounding hold for that mode alone: a library or fesetround() changed it");
  }
  if (scene.changes())
    refuse_with_proof("certify", "a body that changes", "a proof encloses bodies of constant inertia and momentum");
  if (calls_custom(scene)) {
    throw InvalidInput("certify='proof'", "left out with torques of the user's own", "a Custom torque",
                       "its function gives numbers, and a proof needs bounds on them at every state nearby: write it as "
                       "a Formula");
  }
  for (const AnyTorque& torque : scene.torques()) {
    const torques::Formula* formula = find_formula(torque);
    if (formula == nullptr) continue;
    if (!formula->program(scene.inertia_B().matrix()).graph.ephemerides().empty())
      refuse_with_proof("certify", "a torque on an orbit", "bounds on the position in an orbit are not made yet");
  }
}

/// Refuses what a run from tick to tick does not do.
void require_clocked(const Scene& scene, const SolveOptions& options) {
  if (scene.controllers().empty()) return;
  const auto refuse = [](const std::string& where, const std::string& found, const std::string& cause) {
    throw InvalidInput(where, "left out with controllers", found, cause);
  };
  if (options.proof) refuse("certify='proof'", "a proof", "proofs do not go through ticks yet");
  if (options.method && *options.method != "taylor")
    refuse("method", "'" + *options.method + "'", "taylor steps from tick to tick");
  if (options.formulation != Formulation::euler) refuse("formulation", "'lagrangian'", "taylor integrates Euler's equations");
  if (has_rotor_windows(scene))
    refuse("scene.rotors", "windows", "a rotor that starts or stops is not joined with ticks; a controller may drive it");
  if (calls_custom(scene)) refuse("scene.torques", "a Custom torque", "it has no Taylor series; write it as a Formula");
  for (const double t : scene.times())
    if (t < scene.t0())
      throw InvalidInput("scene.times", "at or after t0 with controllers", to_text(t), "a controller acts forward in time");
}

}  // namespace

bool calls_custom(const Scene& scene) {
  return std::any_of(scene.torques().begin(), scene.torques().end(), [](const AnyTorque& torque) {
    const auto* during = std::get_if<torques::During>(&torque);
    return during != nullptr ? std::holds_alternative<torques::Custom>(during->torque())
                             : std::holds_alternative<torques::Custom>(torque);
  });
}

void require_finite_start(const Scene& scene) {
  const double attitude[4] = {scene.attitude().x, scene.attitude().y, scene.attitude().z, scene.attitude().w};
  const TorqueInput in{scene.t0(), scene.omega().data(), attitude, scene.inertia_B().matrix()};
  for (const AnyTorque& torque : scene.torques()) {
    double tau[3] = {0.0, 0.0, 0.0};
    std::visit([&](const auto& acting) { acting.add(in, tau); }, torque);
    for (int i = 0; i < 3; ++i) {
      if (std::isfinite(tau[i])) continue;
      throw InvalidInput("the torque's function", "finite in all three components",
                         to_text(tau[i]) + " in component " + std::to_string(i) + " at t = " + to_text(in.t) + " s");
    }
  }
}

StepTolerances choose_tolerances(const ode::MethodRecord& record, const SolveOptions& options) {
  require_fitting(record, options);
  const double asked = record.adaptive ? options.rtol.value_or(1e-9) : std::numeric_limits<double>::infinity();
  const bool raised = asked < record.least_rtol;
  return {{raised ? record.least_rtol : asked, options.atol.value_or(0.0), options.step.value_or(0.0)}, asked, raised};
}

void describe_end(const StepTolerances& step, Motion& motion) {
  motion.asked = step.asked;
  if (motion.message.empty()) motion.message = "reached the last time; the error was not estimated";
  if (step.raised) {
    motion.message +=
        "; the tolerance was raised to " + to_text(step.tolerances.rtol) + ", the smallest that float64 allows";
  }
}

void check_options(const Scene& scene, const SolveOptions& options) {
  if (options.accuracy && !(*options.accuracy > 0.0 && *options.accuracy <= 1.0)) {
    throw InvalidInput("accuracy", "above 0 and at most 1", to_text(*options.accuracy));
  }
  if (options.accuracy && (options.rtol || options.atol)) {
    throw InvalidInput("accuracy", "left out where rtol or atol is given", to_text(*options.accuracy),
                       "accuracy bounds the error of the samples, rtol and atol that of one step");
  }
  require_positive("rtol", options.rtol);
  require_positive("step", options.step);
  if (options.atol && !(std::isfinite(*options.atol) && *options.atol >= 0.0)) {
    throw InvalidInput("atol", "0 or positive, and finite", to_text(*options.atol));
  }
  if (options.max_steps < 1) throw InvalidInput("max_steps", "at least 1", std::to_string(options.max_steps));
  require_clocked(scene, options);
  require_provable(scene, options);
  for (const SceneEvent& event : options.events) {
    if (event.direction < -1 || event.direction > 1) {
      throw InvalidInput("event.direction", "-1, 0 or 1", std::to_string(event.direction));
    }
  }
  if (options.method == "exact") return require_no_steps(options);
  if (!options.method) return;
  const std::string& name = *options.method;
  const BodyMethod& method = find_body_method(name);
  require_fitting(method.record, options);
  if (options.formulation != Formulation::euler && method.of_bodies) {
    throw InvalidInput("formulation", "'euler' with method '" + name + "'", "'lagrangian'",
                       "this method integrates Euler's equations only");
  }
  if (const std::string why = compute_refusal(name, scene); !why.empty()) {
    throw InvalidInput("method '" + name + "'", "used with " + std::string(method.record.needs.empty() ? "another scene" : method.record.needs), why);
  }
}

RunOptions to_run_options(const SolveOptions& options, const ode::Tolerances& tolerances, ode::ErrorTrace* trace) {
  return {.tolerances = tolerances,
          .max_steps = options.max_steps,
          .dense = options.dense,
          .formulation = options.formulation,
          .events = options.events,
          .progress = options.progress,
          .body = options.body,
          .keep_ticks = options.keep_ticks,
          .trace = trace};
}

}  // namespace polhode
