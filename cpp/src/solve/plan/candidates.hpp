#pragma once

#include <string_view>

#include "polhode/method/methods.hpp"
#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/plan.hpp"

// The expected cost and error of each exact model and each method, and the choice between them.
namespace polhode {

inline constexpr double default_accuracy = 1e-9;
inline constexpr double forecast_slack = 1.1;         ///< forecast errors up to this times the accuracy pass
inline constexpr double aim = 10.0;                   ///< of a run without certificate: accuracy over forecast error
inline constexpr double solve_seconds = 7e-6;         ///< of any call of solve from Python, with its plan
inline constexpr double piece_seconds = 3e-6;         ///< to set up a run of one piece; the pilot run is one more
/// The cost of a run that carries its error, as a multiple of the run without, by benchmarks/planner/fit.py.
inline constexpr double carried_cost = 2.4, carried_cost_stiff = 3.0;
/// The cost of a pair of runs, as a multiple of what both take: the first pair often proves too little. Where stability
/// limits explicit steps, both runs take the same ones, and a third by another method is compared.
inline constexpr double pair_cost = 3.0, alike_pair_cost = 4.5, implicit_pair_cost = 1.5;
/// The same for calls of the user's own torque, whose pilot run makes the forecast better.
inline constexpr double pair_calls = 1.6, implicit_pair_calls = 1.2;
/// The e-foldings after which a rate is negligible. An implicit method follows no more of them, by its absolute
/// tolerance; an explicit one has none, and follows all.
inline constexpr double followed_foldings = 30.0;
inline constexpr double pair_ratio = 5.0;             ///< ratio of the tolerances of the two runs of a certificate
inline constexpr double wide_pair_ratio = 3 * pair_ratio;   ///< the same of implicit methods and of pieces
inline constexpr double most_stiff_factor = 10.0;     ///< of differences of chains with an implicit piece

double get_accuracy(const SolveOptions& options);
bool carries_attitude(const Scene& scene, const Facts& facts, const SolveOptions& options);

/// The tolerance whose forecast error is the accuracy, over that of the first run that carries its error: 5 at 1e-9 and
/// below, 25 from 1e-7 on. A run that misses a loose accuracy, and its repeat, cost more than a tighter accuracy does.
double find_carried_ratio(double accuracy);
/// The steps at most of the explicit run that a certificate of implicit ones takes besides (certify/pair.cpp).
double count_third_steps(double steps);
double find_factor(const CostFactors* factors, std::string_view name);

Candidate evaluate_method(const Scene& scene, const Facts& facts, const SolveOptions& options,
                          const ode::MethodRecord& record);
Candidate evaluate_closed_form(const Scene& scene, const ClosedForm& form, const Facts& facts,
                               const SolveOptions& options);
/// The absolute tolerance of an implicit method [rad/s]: smaller rates affect no sample. It is 0 for explicit methods,
/// because it would not lengthen their steps.
double find_atol(const ode::MethodRecord& record, const Scene& scene, double rtol);
/// The time of a closed form and of the changed ones that bound its error [s].
double predict_closed_form(const ClosedFormRecord& form, int set_ups, double samples, const CostFactors* factors);
Candidate choose_method(const Scene& scene, const Facts& facts, const SolveOptions& options);
Plan make_method_plan(const Scene& scene, const Facts& facts, const SolveOptions& options);
Plan make_exact_plan(const Scene& scene, const ClosedForm& form, const Facts& facts, const SolveOptions& options);

}  // namespace polhode
