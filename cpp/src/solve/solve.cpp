#include "polhode/solve/solve.hpp"

#include <chrono>
#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/solve/invariants.hpp"
#include "solve/certify.hpp"
#include "solve/checked_options.hpp"
#include "solve/exact_run.hpp"
#include "solve/handover.hpp"
#include "solve/methods/body_method.hpp"
#include "solve/planning.hpp"
#include "solve/spot_check.hpp"

namespace polhode {
namespace {

void require_positive(const char* where, const std::optional<double>& value) {
  if (value && !(std::isfinite(*value) && *value > 0.0))
    throw InvalidInput(where, "positive and finite", to_text(*value));
}

/// Options without effect are refused, and so are those that are missing.
void require_fitting(const ode::MethodRecord& record, const SolveOptions& options) {
  const std::string with = " with method '" + std::string(record.name) + "'";
  if (record.adaptive) {
    if (options.step) {
      throw InvalidInput("step", "left out" + with, to_text(*options.step),
                         "it chooses its own steps by rtol and atol");
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

}  // namespace

void require_finite_start(const Scene& scene) {
  const double attitude[4] = {scene.attitude().x, scene.attitude().y, scene.attitude().z, scene.attitude().w};
  const TorqueInput in{scene.t0(), scene.omega().data(), attitude, scene.inertia_B().matrix()};
  for (const AnyTorque& torque : scene.torques()) {
    double tau[3] = {0.0, 0.0, 0.0};
    std::visit([&](const auto& one) { one.add(in, tau); }, torque);
    for (int i = 0; i < 3; ++i) {
      if (std::isfinite(tau[i])) continue;
      throw InvalidInput("the torque's function", "finite in all three components",
                         to_text(tau[i]) + " in component " + std::to_string(i) + " at t = " + to_text(in.t) + " s");
    }
  }
}

CheckedOptions choose_tolerances(const ode::MethodRecord& record, const SolveOptions& options) {
  const double asked = record.adaptive ? options.rtol.value_or(1e-9) : std::numeric_limits<double>::infinity();
  const bool raised = asked < record.least_rtol;
  return {{raised ? record.least_rtol : asked, options.atol.value_or(0.0), options.step.value_or(0.0)}, asked, raised};
}

void describe_end(const CheckedOptions& checked, Motion& motion) {
  motion.asked = checked.asked;
  if (motion.message.empty()) motion.message = "reached the last time; the error was not estimated";
  if (checked.raised) {
    motion.message +=
        "; the tolerance was raised to " + to_text(checked.tolerances.rtol) + ", the least that float64 can serve";
  }
}

namespace {

void require_no_steps(const SolveOptions& options) {
  constexpr const char* cause = "a closed form has no steps";
  const std::pair<const char*, const std::optional<double>&> without_effect[] = {
      {"rtol", options.rtol}, {"atol", options.atol}, {"step", options.step}};
  for (const auto& [where, value] : without_effect) {
    if (value) throw InvalidInput(where, "left out with method 'exact'", to_text(*value), cause);
  }
  if (options.formulation != Formulation::euler) {
    throw InvalidInput("formulation", "left out with method 'exact'", "'lagrangian'",
                       "a closed form integrates nothing");
  }
}

}  // namespace

void check_options(const Scene& scene, const SolveOptions& options) {
  if (options.accuracy && !(*options.accuracy > 0.0 && *options.accuracy <= 1.0)) {
    throw InvalidInput("accuracy", "above 0 and at most 1", to_text(*options.accuracy));
  }
  if (options.accuracy && (options.rtol || options.atol)) {
    throw InvalidInput("accuracy", "left out where rtol or atol is given", to_text(*options.accuracy),
                       "accuracy is about the answer, rtol and atol are about a step");
  }
  require_positive("rtol", options.rtol);
  require_positive("step", options.step);
  if (options.atol && !(std::isfinite(*options.atol) && *options.atol >= 0.0)) {
    throw InvalidInput("atol", "0 or positive, and finite", to_text(*options.atol));
  }
  if (options.max_steps < 1) throw InvalidInput("max_steps", "at least 1", std::to_string(options.max_steps));
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
    throw InvalidInput("formulation", "'euler' with method '" + name + "'", "'lagrangian'", "it steps the body itself");
  }
  if (const std::string why = compute_refusal(name, scene); !why.empty()) {
    throw InvalidInput("method '" + name + "'", "used with " + std::string(method.record.needs), why);
  }
}

namespace {

/// By tolerances of a step, or steps of one length: the error is not estimated.
Motion solve_by_tolerance(const Scene& scene, const SolveOptions& options, const Pieces* pieces) {
  const std::string name = options.method.value_or("rk45");
  const BodyMethod& method = find_body_method(name);
  require_fitting(method.record, options);
  const CheckedOptions checked = choose_tolerances(method.record, options);
  const auto run_one = [&](const Scene& piece, const SolveOptions& one) {
    return method.solve(piece, {one, checked.tolerances});
  };
  Motion motion = pieces == nullptr ? run_one(scene, options) : run_pieces(scene, *pieces, options, run_one);
  motion.plan.method = name;
  describe_end(checked, motion);
  return motion;
}

/// By the plan: a closed form where one holds, else steps whose error is certified.
Motion solve_planned(const Scene& scene, const SolveOptions& options, const Pieces* pieces) {
  if (pieces != nullptr) {
    PiecesPlan made = plan_pieces(scene, *pieces, options);
    if (made.plan.method == "exact") return solve_exact_pieces(scene, options, made.plan);
    return solve_certified(scene, made.facts, options, made.plan);
  }
  const Facts facts = compute_facts(scene);
  if (leaves_choice(options) || options.method == "exact") {
    if (std::optional<ClosedForm> form = find_closed_form(scene, facts)) {
      const Plan plan = make_exact_plan(scene, *form, facts, options);
      return solve_exactly(scene, facts, options, *std::move(form), plan);
    }
    if (options.method) throw_no_closed_form(scene, facts);
  }
  if (const std::optional<PiecesPlan> damped = plan_damped(scene, facts, options)) {
    return solve_certified(scene, damped->facts, options, damped->plan);
  }
  return solve_certified(scene, facts, options, make_method_plan(scene, facts, options));
}

}  // namespace

Motion solve(const Scene& scene, const SolveOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  check_options(scene, options);
  std::optional<Pieces> pieces;
  if (has_windows(scene)) {
    pieces = cut(scene);
    if (pieces->whole) return solve(drop_windows(scene), options);
    require_finite_start(scene);
  } else if (scene.torque_sum().acting > 0) {
    require_finite_start(scene);
    require_true_claims(scene);
  }
  const bool by_tolerance = options.rtol || options.atol || options.step;
  const Pieces* cut_at = pieces ? &*pieces : nullptr;
  Motion motion = by_tolerance ? solve_by_tolerance(scene, options, cut_at) : solve_planned(scene, options, cut_at);
  motion.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return motion;
}

bool succeeded(const Scene& scene, const Motion& motion) {
  if (motion.status != Status::finished && motion.status != Status::event) return false;
  if (!std::isnan(motion.error)) return motion.error <= motion.asked;
  for (const auto& [name, moved] : compute_drift(scene, motion)) {
    if (!(moved <= motion.asked)) return false;
  }
  return true;
}

}  // namespace polhode
