// A brick thrown with a spin about its middle axis, as a tennis racket is: it flips, again and again. The closed form
// tells where it is at any time; rk45 follows it step by step, and the table shows how far it strays. The same program
// in Python, with the same output: examples/python/racket.py.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <polhode/polhode.hpp>

namespace ph = polhode;

int main() {
  const ph::MassProperties block = ph::shapes::box(12.0, {0.3, 0.2, 0.1});   // kg, half sides in m
  const ph::Vector3d omega(1e-2, 5.0, 1e-2);                                 // rad/s, body axes
  const double rtol = 1e-8;

  const ph::FreeMotion exact(block.inertia(), omega);
  ph::SceneParts parts{.inertia_B = block.inertia(), .omega = omega};
  for (int i = 1; i <= 15; ++i) parts.times.push_back(i);
  const ph::Scene scene(parts);
  const ph::Motion motion = ph::solve(scene, {.method = "rk45", .rtol = rtol});

  const ph::Vector3d& moments = block.inertia().moments();
  std::printf("moments %.4f %.4f %.4f kg m^2, omega %g %g %g rad/s\n", moments[0], moments[1], moments[2], omega[0],
              omega[1], omega[2]);
  std::printf("closed form: motion %s, period %.9f s, flips at", ph::to_text(exact.kind()), exact.period());
  for (const double t : exact.flip_times(0.0, 15.0)) std::printf(" %.6f", t);
  std::printf(" s\nrk45: rtol %.0e, %ld steps\n\n", rtol, static_cast<long>(motion.stats.steps));

  const std::size_t n = motion.t.size();
  std::vector<double> energy(n);
  ph::compute_energy(scene, n, motion.t.data(), motion.omega.data(), motion.attitude.data(), energy.data());
  double largest = 0.0;   // of |omega|, the measure of its error
  for (const double t : motion.t) largest = std::max(largest, exact.at(t).omega.norm());

  std::printf("   t        omega_x    omega_y    omega_z    energy drift  rk45's error\n");
  for (std::size_t i = 0; i < n; ++i) {
    const ph::State state = exact.at(motion.t[i]);
    const ph::Vector3d w(motion.omega[3 * i], motion.omega[3 * i + 1], motion.omega[3 * i + 2]);
    const double* a = &motion.attitude[4 * i];
    const ph::Quat turn = ph::conjugate(state.attitude) * ph::Quat{a[0], a[1], a[2], a[3]};
    const double angle = 2.0 * std::atan2(std::hypot(turn.x, turn.y, turn.z), std::abs(turn.w));
    const double error = std::max((w - state.omega).norm() / largest, angle);
    std::printf("%6.1f   %10.6f %10.6f %10.6f    %9.1e     %9.1e\n", state.t, state.omega[0], state.omega[1],
                state.omega[2], std::abs(energy[i] / exact.energy() - 1.0), error);
  }
}
