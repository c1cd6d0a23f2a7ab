#include "solve/certify/certify.hpp"

#include "method/method.hpp"
#include "solve/run/exact_run.hpp"
#include "solve/ground/options.hpp"
#include "solve/run/join_pieces.hpp"
#include "solve/certify/run_pieces.hpp"

namespace polhode {
namespace {

/// A run by rtol and atol, or by a fixed step. Its error is not estimated.
Motion run_by_tolerance(const Decision& decision, const SolveOptions& options) {
  const BodyMethod& method = find_body_method(decision.plan.method);
  const StepTolerances step = choose_tolerances(method.record, options);
  const auto run_piece = [&](const Scene& scene, const Piece&, const SolveOptions& piece_options) {
    return Motion(method.integrate(scene, to_run_options(piece_options, step.tolerances)));
  };
  Motion motion = decision.pieces.size() == 0
                      ? Motion(method.integrate(decision.scene, to_run_options(options, step.tolerances)))
                      : run_pieces(decision.scene, decision.pieces, options, run_piece);
  motion.plan = decision.plan;
  describe_end(step, motion);
  return motion;
}

}  // namespace

Motion execute(const Decision& decision, const SolveOptions& options) {
  if (is_by_tolerance(options)) return run_by_tolerance(decision, options);
  if (decision.form) return run_closed_form(decision.scene, decision.facts, options, decision.form, decision.plan);
  if (decision.plan.method == "exact") return solve_exact_pieces(decision, options);
  return certify(decision, options);
}

}  // namespace polhode
