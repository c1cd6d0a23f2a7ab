#include "solve/ground/pilot.hpp"

#include <cmath>
#include <numbers>

#include "polhode/math/detail/functions.hpp"

namespace polhode {

double PilotRun::revolutions() const { return angle.empty() ? 0.0 : angle.back() / (2 * std::numbers::pi); }

PilotRun measure_rotation(const Trajectory& trajectory, double t0, double rate0) {
  PilotRun run;
  double t = t0, rate = rate0, angle = 0.0;
  for (std::size_t i = 0; i < trajectory.t.size(); ++i) {
    const double* w = trajectory.omega.data() + 3 * i;
    const double next = math::hypot(w[0], w[1], w[2]);
    angle += 0.5 * (rate + next) * std::abs(trajectory.t[i] - t);
    t = trajectory.t[i], rate = next;
    run.t.push_back(t), run.rate.push_back(rate), run.angle.push_back(angle);
  }
  return run;
}

std::vector<double> spread_times(const Scene& scene, const Facts& facts, int count) {
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(scene.t0() - facts.before + facts.span() * i / count);
  return times;
}

}  // namespace polhode
