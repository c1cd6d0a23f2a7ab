#include "polhode/attitude/kinematics.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "attitude/rows.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

/// v rotated by the angle about the axis.
Vector3d rotate_about(const Vector3d& v, int axis, double angle) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const auto [s, c] = math::sincos(angle);
  Vector3d out = v;
  out[a] = c * v[a] - s * v[b];
  out[b] = s * v[a] + c * v[b];
  return out;
}

}  // namespace

// Before the last rotation, in the frame F that it rotates, the three rates lie along
//   first: cos(middle) e_first + sign sin(middle) e_other,   middle: e_second,   last: e_last;
// the last rotation then takes w_F to body axes, w_B = R_last(-angle) w_F.

Vector3d body_rates(const EulerSequence& sequence, const Vector3d& angles, const Vector3d& angle_rates) {
  const int out = sequence.extrinsic() ? 2 : 0;
  const double first_rate = angle_rates[out];
  Vector3d w_F = Vector3d::Zero();
  const math::SinCosPair middle = math::sincos(angles[1]);
  w_F[sequence.first()] = first_rate * middle.cos;
  w_F[sequence.other()] = first_rate * sequence.sign() * middle.sin;
  w_F[sequence.second()] = angle_rates[1];
  w_F[sequence.last()] += angle_rates[2 - out];
  return rotate_about(w_F, sequence.last(), -angles[2 - out]);
}

bool try_euler_rates(const EulerSequence& sequence, const Vector3d& angles, const Vector3d& w_B,
                     Vector3d& angle_rates) {
  const int out = sequence.extrinsic() ? 2 : 0;
  const auto [s, c] = math::sincos(angles[1]);
  // The double nearest to a pole is within half an ulp of it; theta = 0 is a pole only when it is 0.
  const double distance = std::abs(sequence.proper() ? s : c);
  if (!(distance > 0.5 * std::numeric_limits<double>::epsilon() * std::abs(angles[1]))) return false;
  const Vector3d w_F = rotate_about(w_B, sequence.last(), angles[2 - out]);
  const double along_first = w_F[sequence.first()], along_other = sequence.sign() * w_F[sequence.other()];
  double first_rate, last_rate;
  if (sequence.proper()) {
    first_rate = along_other / s;
    last_rate = along_first - first_rate * c;
  } else {
    first_rate = along_first / c;
    last_rate = sequence.sign() * (along_other - first_rate * s);
  }
  angle_rates[out] = first_rate;
  angle_rates[1] = w_F[sequence.second()];
  angle_rates[2 - out] = last_rate;
  return true;
}

Vector3d euler_rates(const EulerSequence& sequence, const Vector3d& angles, const Vector3d& w_B,
                     std::string_view where) {
  Vector3d angle_rates;
  if (try_euler_rates(sequence, angles, w_B, angle_rates)) return angle_rates;
  throw InvalidInput(where,
                     "away from gimbal lock, which for '" + sequence.letters() + "' is a middle angle of " +
                         (sequence.proper() ? "0 or pi" : "+-pi/2"),
                     to_text(angles[1]),
                     "the first and the third rotation have one axis there; use another sequence or quaternions");
}

}  // namespace polhode
