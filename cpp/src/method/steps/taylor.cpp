#include "polhode/ode/tracked_taylor.hpp"

#include <memory>
#include <optional>

#include "method/clock/clock_run.hpp"
#include "method/method.hpp"
#include "method/series/body_series.hpp"
#include "method/series/formula_series.hpp"
#include "method/series/switched_series.hpp"

namespace polhode {
namespace {

template <class Series>
Trajectory integrate_series(const Scene& scene, const RunOptions& options) {
  // Shared with the trajectory, because dense output needs it to unpack states.
  const auto series = std::make_shared<const Series>(scene, scene.want().attitude || !options.events.empty());
  const Unpack unpack = [series](const double* rows, std::size_t n, double* omega, double* attitude) {
    series->unpack(rows, n, omega, attitude);
  };
  using Tracked = ode::TrackedTaylor<Series>;
  ode::ErrorTrace* trace = options.trace;
  std::optional<Series> lost, perturbed, sampled;
  if (trace != nullptr) {
    sampled = series->perturbed(trace->perturbation(), 2);
    perturbed = series->perturbed(trace->perturbation(), 1);
    lost = trace->separates_rounding() ? *series : *sampled;
    if (trace->continued) {
      for (double* error : {trace->loss, trace->spread, trace->sample}) series->pack_error(error);
      lost = lost->shifted(scene.t0(), trace->loss);
      perturbed = perturbed->shifted(scene.t0(), trace->spread);
      sampled = sampled->shifted(scene.t0(), trace->sample);
    }
  }
  const auto make = [&](const double* y, double t_end) -> std::unique_ptr<ode::Stepper> {
    if constexpr (ode::SwitchedProblem<Series>) series->restart();
    if (trace != nullptr) {
      return std::make_unique<Tracked>(*series, *lost, *perturbed, *sampled, scene.t0(), y, t_end,
                                       options.tolerances, *trace);
    }
    return std::make_unique<ode::Taylor::Stepper<Series>>(*series, scene.t0(), y, t_end, options.tolerances);
  };
  ExtraStates extra;
  if constexpr (ode::WideProblem<Series>) extra = {series->count_states(), ode::series_width, series->width()};
  Trajectory trajectory;
  if (scene.controllers().empty()) {
    trajectory = integrate(scene, options, series->start(), unpack, make, extra);
  } else if constexpr (ode::WideProblem<Series>) {
    trajectory = ClockRun<Series>(scene, options, *series, extra).run(unpack, make);
  }
  if (trace != nullptr)
    for (double* error : {trace->loss, trace->spread, trace->sample}) series->unpack_error(error);
  trajectory.model = "euler", trajectory.state = series->describe_state();
  return trajectory;
}

Trajectory integrate_taylor(const Scene& scene, const RunOptions& options) {
  if (has_switches(scene)) return integrate_series<SwitchedSeries>(scene, options);
  return needs_formula_series(scene) ? integrate_series<FormulaSeries>(scene, options)
                                     : integrate_series<BodySeries>(scene, options);
}

}  // namespace

const BodyMethod taylor_method{ode::Taylor::record, &integrate_taylor, &compute_series_refusal, true, true};

}  // namespace polhode
