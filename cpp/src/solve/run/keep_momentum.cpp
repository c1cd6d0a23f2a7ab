#include "solve/run/keep_momentum.hpp"

#include <algorithm>
#include <vector>

#include "polhode/solve/invariants.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {

void keep_momentum(const Scene& scene, Motion& motion) {
  if (!(scene.changes() || scene.has_inner_states()) || !scene.is_closed() || motion.plan.method == "exact") return;
  if (motion.omega.empty() || motion.attitude.empty() || !(motion.error <= motion.asked)) return;
  const State start = scene.start();
  const double q0[4] = {start.attitude.x, start.attitude.y, start.attitude.z, start.attitude.w};
  Vector3d L;
  compute_angular_momentum(scene, 1, &start.t, start.omega.data(), q0, L.data(), start.states.data());
  std::vector<double> omega = motion.omega;
  const auto width = static_cast<std::size_t>(scene.count_states());
  double largest = 0.0;
  const bool constant = !scene.changes();
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const double t = motion.t[i], *q = motion.attitude.data() + 4 * i;
    const Vector3d own = rotate({-q[0], -q[1], -q[2], q[3]}, L) - sum_momenta(scene, t, motion.states.data() + width * i);
    const Vector3d w = -(constant ? compute_rate_jump(scene.inertia_B(), own)
                                  : compute_rate_jump(InertiaTensor::from_trusted(scene.inertia_B(t), false), own));
    double* kept = omega.data() + 3 * i;
    largest = std::max(largest, (w - Vector3d(kept[0], kept[1], kept[2])).norm());
    std::copy_n(w.data(), 3, kept);
  }
  const double scale = motion.omega_scale();
  const double error = motion.error + (largest > 0.0 ? largest / scale : 0.0);
  if (!(error <= motion.asked)) return;
  motion.omega = std::move(omega), motion.error = error;
}

}  // namespace polhode
