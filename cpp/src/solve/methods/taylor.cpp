#include "polhode/ode/taylor.hpp"

#include <memory>

#include "polhode/solve/body_series.hpp"
#include "solve/methods/body_method.hpp"

namespace polhode {
namespace {

Motion solve_taylor(const Scene& scene, const RunOptions& options) {
  // Shared with the motion, whose dense output needs it to be read.
  const auto series = std::make_shared<const BodySeries>(scene, scene.want().attitude || !options.asked.events.empty());
  const Unpack unpack = [series](const double* rows, std::size_t n, double* omega, double* attitude) {
    series->unpack(rows, n, omega, attitude);
  };
  Motion motion = run(scene, options.asked, series->start(), unpack, [&](const double* y, double t_end) {
    return std::make_unique<ode::Taylor::Stepper<BodySeries>>(*series, scene.t0(), y, t_end, options.tolerances);
  });
  motion.plan = {"euler", "", series->describe_state()};
  return motion;
}

}  // namespace

const BodyMethod taylor_method{ode::Taylor::record, &solve_taylor, &compute_series_refusal};

}  // namespace polhode
