#pragma once

#include <string_view>

#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/methods.hpp"
#include "polhode/solve/plan.hpp"

// The parts of a plan, for those who make it, explain it and carry it out.
namespace polhode {

inline constexpr double default_accuracy = 1e-9;
inline constexpr double forecast_slack = 1.1;          ///< a forecast this near the accuracy reaches it
inline constexpr double pair_ratio = 5.0;             ///< of the tolerances of the two runs of a certificate
inline constexpr double custom_call_seconds = 3e-7;    ///< of a user's own torque, somewhere between C and Python

void check_options(const Scene& scene, const SolveOptions& options);   ///< @throws InvalidInput
bool leaves_choice(const SolveOptions& options);   ///< neither method nor formulation is asked for
double get_accuracy(const SolveOptions& options);
bool carries_attitude(const Scene& scene, const Facts& facts, const SolveOptions& options);
double find_seconds_per_call(const Scene& scene);
double find_factor(const CostFactors* factors, std::string_view name);

Candidate judge_method(const Scene& scene, const Facts& facts, const SolveOptions& options,
                       const ode::MethodRecord& record);
Candidate judge_closed_form(const Scene& scene, const ClosedForm& form, const Facts& facts,
                            const SolveOptions& options);
/// What an implicit method may leave of rates that have died away: so much less than the start's, and than what turns
/// the body by the tolerance over the span, that no sample tells [rad/s]. Else 0: explicit steps would not be longer
/// for it.
double find_atol(const ode::MethodRecord& record, const Scene& scene, double rtol);
double predict_closed_form(std::string_view model, double samples, const CostFactors* factors);   ///< [s]
Candidate choose_method(const Scene& scene, const Facts& facts, const SolveOptions& options);
Plan make_method_plan(const Scene& scene, const Facts& facts, const SolveOptions& options);
Plan make_exact_plan(const Scene& scene, const ClosedForm& form, const Facts& facts, const SolveOptions& options);
[[noreturn]] void throw_no_closed_form(const Scene& scene, const Facts& facts);

}  // namespace polhode
