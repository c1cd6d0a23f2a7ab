#include "solve/ground/custom_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "polhode/core/error.hpp"
#include "solve/ground/options.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {
namespace {

struct Probe {
  double t;
  Vector3d omega;
  Quat attitude;
};

Vector3d call(const torques::Custom& torque, const Probe& probe, const Matrix3d& I_B) {
  const double q[4] = {probe.attitude.x, probe.attitude.y, probe.attitude.z, probe.attitude.w};
  double tau[3] = {0.0, 0.0, 0.0};
  torque.add(TorqueInput{probe.t, probe.omega.data(), q, I_B}, tau);
  return {tau[0], tau[1], tau[2]};
}

std::string text(const Vector3d& v) {
  return std::string("(")
      .append(to_text(v[0]))
      .append(", ")
      .append(to_text(v[1]))
      .append(", ")
      .append(to_text(v[2]))
      .append(")");
}

}  // namespace

void check_torques(const Scene& scene) {
  if (!has_windows(scene)) {
    if (scene.torque_sum().acting == 0) return;
    require_finite_start(scene);
    return require_true_claims(scene);
  }
  require_finite_start(scene);
  // Where the span is cut, the claims are checked at the start of each piece.
  if (cut(scene).whole) require_true_claims(drop_windows(scene));
}

void require_true_claims(const Scene& scene) {
  const auto& all = scene.torques();
  const auto is_custom = [](const AnyTorque& torque) { return std::holds_alternative<torques::Custom>(torque); };
  if (std::none_of(all.begin(), all.end(), is_custom)) return;
  double last = scene.t0();
  for (const double t : scene.times()) last = std::abs(t - scene.t0()) > std::abs(last - scene.t0()) ? t : last;
  const double span = last - scene.t0();
  double size = scene.omega().norm();
  if (size == 0.0) size = span != 0.0 ? 1 / std::abs(span) : 1.0;

  std::size_t index = 0;
  for (const AnyTorque& any : all) {
    const std::string where = "scene.torques[" + std::to_string(index++) + "]";
    const auto* custom = std::get_if<torques::Custom>(&any);
    if (custom == nullptr) continue;
    const TorqueTraits claims = custom->traits();
    if (claims.uses_time && claims.uses_attitude && claims.uses_rates) continue;
    // The start, and three states over the first eighth of the span.
    for (int i = 0; i < 4; ++i) {
      const double s = i / 24.0;
      const Probe here{scene.t0() + s * span, scene.omega() + s * size * Vector3d{1.0, -0.5, 0.7},
                      normalized(scene.attitude() * Quat{2.3 * s, -1.7 * s, 1.1 * s, 1.0})};
      const Vector3d tau = call(*custom, here, scene.inertia_B().matrix());
      const auto check = [&](bool seen, const char* claim, const char* changed, const Probe& other) {
        if (seen) return;
        const Vector3d then = call(*custom, other, scene.inertia_B().matrix());
        if (then == tau || !then.allFinite() || !tau.allFinite()) return;
        throw InvalidInput(where,
                           "given " + std::string(claim) + "=True, because its torque depends on " + changed,
                           text(tau) + " and " + text(then) + " N m at t = " + to_text(here.t) + " s",
                           "a false claim gives a wrong motion; leave it out when in doubt");
      };
      Probe other = here;
      other.t += 0.3 * (1 - s) * span;
      check(claims.uses_time, "uses_time", "time", other);
      other = here;
      other.attitude = normalized(here.attitude * Quat{0.5, 0.6, -0.4, 0.7});
      check(claims.uses_attitude, "uses_attitude", "attitude", other);
      other = here;
      other.omega += 0.3 * size * Vector3d{-0.8, 1.1, 0.9};
      check(claims.uses_rates, "uses_rates", "omega", other);
    }
  }
}

}  // namespace polhode
