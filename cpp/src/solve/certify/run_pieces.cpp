#include "solve/certify/run_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "method/method.hpp"
#include "polhode/core/error.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/ground/distance.hpp"
#include "solve/run/exact_run.hpp"
#include "solve/ground/options.hpp"
#include "solve/run/perturb.hpp"
#include "solve/run/join_pieces.hpp"

namespace polhode {
namespace {

/// Sets rates too small to affect any sample to zero at the start of a piece. Otherwise a new torque's first step,
/// chosen by these rates, would be far below the spacing of the times.
std::optional<Scene> zero_negligible_rates(const Scene& piece, const Scene& whole, double rtol) {
  double span = 0.0;
  for (const double t : whole.times()) span = std::max(span, std::abs(t - whole.t0()));
  const double rate = piece.omega().norm();
  if (piece.t0() == whole.t0() || rate == 0.0 || !(rate < 0.01 * rtol * std::min(whole.omega().norm(), 1 / span)))
    return std::nullopt;
  SceneParts parts = piece.parts();
  parts.omega.setZero();
  return Scene(std::move(parts));
}

/// Carries the errors of a trace over a jump of the rates. Adds the rounding of the jump, and of the momentum behind it.
/// @param omega  after the jump
void add_jump(const Scene& scene, const Vector3d& omega, const Momentum& before, const Momentum& after,
              ode::ErrorTrace& trace) {
  double dh = (after.h - before.h).norm();
  if (after.J != before.J) {
    for (double* error : {trace.loss, trace.spread, trace.sample}) {
      const Vector3d carried = carry_rates(scene, {error[0], error[1], error[2]}, before, after);
      std::copy_n(carried.data(), 3, error);
    }
    dh += (after.J - before.J).norm() * omega.norm();
  }
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  const double size = rounding * trace.scale * dh / compute_principal_axes(after.J).moments[0];
  for (int i = 0; i < 3; ++i) trace.spread[i] += std::copysign(size, trace.spread[i]);
}

/// Where momenta of parts inside cancel, rates are left that are rounding alone. They have no digits for a bound that is
/// relative to them, so they become zero, and an error.
std::optional<Scene> drop_rounded_rates(const Scene& part, ode::ErrorTrace& trace) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  const double rate = part.omega().norm();
  if (rate == 0.0 || !(rate < rounding * trace.largest)) return std::nullopt;
  for (int i = 0; i < 3; ++i)
    trace.spread[i] += std::copysign(trace.scale * std::abs(part.omega()[i]), trace.spread[i]);
  SceneParts parts = part.parts();
  parts.omega.setZero();
  return Scene(std::move(parts));
}

/// A comparison may have a time at the start itself, so a piece in a direction that was not planned. It has no length,
/// and takes the plan of the first piece in the other direction.
void copy_plans(const std::vector<Piece>& from, const std::vector<Piece>& other, std::vector<Piece>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Piece& planned = from.empty() ? other.front() : from[std::min(i, from.size() - 1)];
    to[i].plan = planned.plan, to[i].form = planned.form;
  }
}

/// The planned closed form of a piece. Where it does not hold at the start that the chain has reached, the first that
/// does; null if none does.
std::shared_ptr<const ClosedForm> make_form(const Scene& part, const Facts& facts, const ClosedFormRecord& planned) {
  return planned.refuse(part, facts, Words::no) ? find_closed_form(part, facts) : planned.make(part, facts);
}

}  // namespace

Motion run_planned(const Decision& decision, const Scene& scene, const SolveOptions& options, double rtol,
                   bool perturb_joins, ode::ErrorTrace* trace) {
  Pieces pieces = cut(scene, decision.pieces.method_switches);
  copy_plans(decision.pieces.backward, decision.pieces.forward, pieces.backward);
  copy_plans(decision.pieces.forward, decision.pieces.backward, pieces.forward);
  std::vector<std::string> runs;
  const auto run_one = [&](const Scene& part, const Piece& piece, const SolveOptions& piece_options) -> Motion {
    std::string name = piece.plan.method;
    runs.emplace_back();
    if (piece.form != nullptr) {
      const Facts facts = compute_facts(part);
      if (const std::shared_ptr<const ClosedForm> form = make_form(part, facts, *piece.form)) {
        const Plan plan = make_exact_plan(part, *form, facts, piece_options);
        if (trace == nullptr || carry_error(part, *form, plan.predicted_error, *trace)) {
          if (form->name() != piece.plan.model) runs.back() = form->name();
          return run_closed_form(part, facts, piece_options, form, plan);
        }
      }
      // Perturbed inputs may have no closed form, and a chain may reach a piece with a start that has none.
      name = trace != nullptr ? "taylor" : choose_method(part, facts, piece_options).name;
      runs.back() = name;
    }
    const BodyMethod& method = find_body_method(name);
    // Two runs at the least tolerance of a piece would take the same steps there, and share their error.
    const double least_scaled = (perturb_joins ? wide_pair_ratio : 1.0) * method.record.least_rtol;
    const double scaled = std::max(rtol * piece.plan.rtol_scale, least_scaled);
    const std::optional<Scene> at_rest = zero_negligible_rates(part, scene, scaled);
    const Scene& start = at_rest ? *at_rest : part;
    Motion motion(method.integrate(
        start, to_run_options(piece_options, {scaled, find_atol(method.record, scene, scaled)}, trace)));
    // The first step was below the spacing of the times.
    const bool stuck = motion.status == Status::failed && motion.stats.steps == 0;
    if (!stuck || name == "taylor" || !compute_refusal("taylor", start).empty()) return motion;
    const double least = taylor_method.record.least_rtol;
    runs.back() = "taylor";
    return Motion(taylor_method.integrate(start, to_run_options(piece_options, {std::max(rtol, least)})));
  };
  Momentum momentum{Matrix3d::Zero(), Vector3d::Zero()};   // before the piece
  const auto run_piece = [&](const Scene& part, const Piece& piece, const SolveOptions& piece_options) {
    if (trace == nullptr) return run_one(part, piece, piece_options);
    if (piece.begin == scene.t0()) {
      const Quat& q = part.attitude();
      const Vector3d& w = part.omega();
      double start[ode::most_series_width] = {w[0], w[1], w[2], 0.0, q.x, q.y, q.z, q.w};
      const std::vector<double> states = part.start().states;
      std::copy(states.begin(), states.end(), start + ode::series_width);
      trace->start(start, ode::series_width + static_cast<int>(states.size() + 7) / 8 * 8);
      trace->continued = true;
      momentum = find_momentum(scene, scene.t0());
    }
    if (const Momentum after = find_momentum(scene, piece, piece.begin); !(after == momentum))
      add_jump(scene, part.omega(), momentum, after, *trace);
    momentum = find_momentum(scene, piece, piece.end);
    const std::optional<Scene> at_rest = piece.form == nullptr ? drop_rounded_rates(part, *trace) : std::nullopt;
    Motion motion = run_one(at_rest ? *at_rest : part, piece, piece_options);
    trace->before += std::abs(piece.end - piece.begin);
    return motion;
  };
  Motion motion = run_pieces(scene, pieces, options, run_piece, perturb_joins);
  motion.piece_runs = std::move(runs);
  return motion;
}

Plan describe_run(const Decision& decision, const Motion& motion) {
  Plan plan = decision.plan;
  const std::vector<const Piece*> pieces = decision.pieces.all();
  for (std::size_t i = 0; i < motion.piece_runs.size() && i < pieces.size(); ++i) {
    for (PiecePlan& piece : plan.pieces)
      if (piece.begin == pieces[i]->plan.begin) piece.ran = motion.piece_runs[i];
  }
  return plan;
}

Motion solve_exact_pieces(const Decision& decision, const SolveOptions& options) {
  const Scene& scene = decision.scene;
  Motion motion = run_planned(decision, scene, options, 0.0, false);
  motion.plan = describe_run(decision, motion);
  motion.asked = decision.plan.accuracy;
  constexpr double safety = 1.5;
  constexpr std::size_t most = 256;   // samples to compare: the error grows along the span
  const std::size_t n = motion.t.size(), stride = std::max<std::size_t>(1, n / most);
  SceneParts parts = scene.parts();
  parts.times.clear();
  std::vector<double> omega, attitude;
  for (std::size_t i = (n - 1) % stride; i < n; i += stride) {
    parts.times.push_back(motion.t[i]);
    if (!motion.omega.empty()) omega.insert(omega.end(), &motion.omega[3 * i], &motion.omega[3 * i] + 3);
    if (!motion.attitude.empty())
      attitude.insert(attitude.end(), &motion.attitude[4 * i], &motion.attitude[4 * i] + 4);
  }
  if (!parts.times.empty()) {
    SolveOptions comparison = options;
    comparison.dense = false, comparison.events.clear(), comparison.progress = {};
    ode::ErrorTrace trace{.asked = decision.plan.accuracy / safety};
    const Motion other = run_planned(decision, perturb(Scene(std::move(parts))), comparison, 0.0, true, &trace);
    const double apart = compute_distance(other.t.size(), scene.omega().norm(), get_data(omega), get_data(attitude),
                                          get_data(other.omega), get_data(other.attitude));
    // The errors of two runs may by chance be alike; those carried along are other samples of them.
    const double rates = other.omega.empty() || trace.rate_error == 0.0 ? 0.0 : trace.rate_error / other.omega_scale();
    motion.error += safety * std::max({apart, rates, other.attitude.empty() ? 0.0 : trace.attitude_error});
  }
  ++motion.runs;
  motion.error_kind = motion.error <= motion.asked ? "bounded" : "limit";
  if (motion.message.empty()) {
    motion.message = "evaluated at every time by the closed forms of " + std::to_string(decision.pieces.size()) +
                     " pieces; a second run with perturbed inputs bounds the error";
  }
  if (motion.error > motion.asked && motion.status == Status::finished) {
    motion.message.append("; float64 allows an error of ").append(to_text(motion.error));
    motion.message.append(", more than the requested ").append(to_text(motion.asked));
  }
  return motion;
}

}  // namespace polhode
