#include "solve/certify/run_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

/// Rates and attitudes at the times of a piece.
struct Rows {
  std::vector<double> omega, attitude;

  Rows(const Scene& piece, const ClosedForm& form) {
    const std::vector<double>& times = piece.times();
    std::vector<double> since(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) since[i] = times[i] - piece.t0();
    omega.resize(3 * times.size());
    if (piece.want().attitude) attitude.resize(4 * times.size());
    form.at(since.data(), since.size(), omega.data(), attitude.empty() ? nullptr : attitude.data());
  }
};

/// The rows from a perturbed start, if it has a closed form.
std::optional<Rows> find_rows(const Scene& piece) {
  const std::shared_ptr<const ClosedForm> form = find_closed_form(piece, compute_facts(piece));
  return form ? std::optional(Rows(piece, *form)) : std::nullopt;
}

/// A start of a pendulum, perturbed in its plane.
Scene perturb_swing(const Scene& piece, const Vector3d& axis, const double* error) {
  SceneParts parts = piece.parts();
  const Quat& q = piece.attitude();
  const Quat apart = conjugate(q) * Quat{error[4], error[5], error[6], error[7]};
  const double half = axis[0] * apart.x + axis[1] * apart.y + axis[2] * apart.z;
  parts.omega += axis.dot(Vector3d(error[0], error[1], error[2])) * axis;
  parts.attitude = normalized(q * Quat{half * axis[0], half * axis[1], half * axis[2], 1.0});
  return Scene(std::move(parts));
}

Scene perturb_start(const Scene& piece, const ClosedForm& form, const double* error) {
  if (const std::optional<Vector3d> axis = form.swing_axis()) return perturb_swing(piece, *axis, error);
  SceneParts parts = piece.parts();
  for (int i = 0; i < 3; ++i) parts.omega[i] += error[i];
  const Quat& q = piece.attitude();
  const double x = q.x + error[4], y = q.y + error[5], z = q.z + error[6], w = q.w + error[7];
  const double size = std::sqrt(x * x + y * y + z * z + w * w);
  parts.attitude = {x / size, y / size, z / size, w / size};
  return Scene(std::move(parts));
}

/// The error of one row, in the layout of the trace.
void subtract(const Rows& perturbed, const Rows& rows, std::size_t i, double* error) {
  std::fill_n(error, 8, 0.0);
  for (std::size_t k = 0; k < 3; ++k) error[k] = perturbed.omega[3 * i + k] - rows.omega[3 * i + k];
  if (rows.attitude.empty()) return;
  const double *p = perturbed.attitude.data() + 4 * i, *q = rows.attitude.data() + 4 * i;
  const double sign = std::copysign(1.0, p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]);
  for (std::size_t k = 0; k < 4; ++k) error[4 + k] = sign * p[k] - q[k];
}

double measure_rates(const double* error) { return math::hypot(error[0], error[1], error[2]); }
double measure_angle(const double* e) { return 2 * math::hypot(math::hypot(e[4], e[5]), math::hypot(e[6], e[7])); }

}  // namespace

bool carry_error(const Scene& piece, const ClosedForm& form, double form_error, ode::ErrorTrace& trace) {
  const std::size_t n = piece.times().size();
  const Rows rows(piece, form);
  const std::optional<Rows> lost = find_rows(perturb_start(piece, form, trace.loss));
  const std::optional<Rows> spread = find_rows(perturb_start(piece, form, trace.spread));
  const std::optional<Rows> sample = find_rows(perturb_start(piece, form, trace.sample));
  if (!lost || !spread || !sample) return false;
  double rate_error = 0.0, attitude_error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    subtract(*lost, rows, i, trace.loss);
    subtract(*spread, rows, i, trace.spread);
    subtract(*sample, rows, i, trace.sample);
    size = math::hypot(rows.omega[3 * i], rows.omega[3 * i + 1], rows.omega[3 * i + 2]);
    trace.largest = std::max(trace.largest, size);
    const double rates = measure_rates(trace.loss) + measure_rates(trace.spread) + measure_rates(trace.sample);
    const double angle = measure_angle(trace.loss) + measure_angle(trace.spread) + measure_angle(trace.sample);
    rate_error = std::max(rate_error, rates / trace.scale + form_error * size);
    attitude_error = std::max(attitude_error, angle / trace.scale + form_error);
  }
  if (!(rate_error + attitude_error < 1e300)) rate_error = ode::ErrorTrace::infinity;
  trace.add(rate_error, attitude_error, trace.before + std::abs(piece.times().back() - piece.t0()));
  // The closed form's own error, in the direction of the spread.
  const double rates = size > 0.0 ? measure_rates(trace.spread) / size : 0.0;
  const double relative = std::max(rates, measure_angle(trace.spread));
  if (!(relative > 0.0)) return true;
  for (double& error : trace.spread) error *= 1 + trace.scale * form_error / relative;
  return true;
}

}  // namespace polhode
