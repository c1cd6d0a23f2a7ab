#include "polhode/attitude/euler.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "attitude/rows.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

using std::numbers::pi;

constexpr double kLock = 0x1p-50;                   // [rad] from the pole
constexpr double kTwoPiTail = 2.449293598294706e-16;  // 2 pi - double(2 pi)

/// Into [-pi, pi], the rounding of 2 pi included.
double wrap(double angle) {
  if (angle > pi) return (angle - 2 * pi) - kTwoPiTail;
  if (angle < -pi) return (angle + 2 * pi) + kTwoPiTail;
  return angle;
}

/// The quaternion read as two plane vectors r_sum (cos, sin)(sum) and r_difference (cos, sin)(difference), where
/// sum and difference are half those of the outer angles: Bernardes & Viollet 2022, PLoS ONE 17(11) e0276302.
/// One of the two vectors vanishes at each pole.
struct Polar {
  double sum_x, sum_y, difference_x, difference_y;
  double r_sum, r_difference;

  Polar(const EulerSequence& sequence, const Quat& q) {
    const double v[3] = {q.x, q.y, q.z};
    const double i = v[sequence.first()], j = v[sequence.second()], k = sequence.sign() * v[sequence.other()];
    if (sequence.proper()) {
      sum_x = q.w, sum_y = i;        // r = cos(middle/2)
      difference_x = j, difference_y = k;  // r = sin(middle/2)
    } else {
      sum_x = q.w + j, sum_y = i + k;        // r = cos(middle/2) + sin(middle/2)
      difference_x = q.w - j, difference_y = i - k;  // r = cos(middle/2) - sin(middle/2)
    }
    // Components that underflow here are far below kLock.
    r_sum = std::sqrt(sum_x * sum_x + sum_y * sum_y);
    r_difference = std::sqrt(difference_x * difference_x + difference_y * difference_y);
  }

  /// The distance to the pole in radians is 2 r (proper) or sqrt(2) r, r being the lesser radius.
  bool locked(const EulerSequence& sequence) const {
    return std::fmin(r_sum, r_difference) * (sequence.proper() ? 2.0 : std::numbers::sqrt2) <= kLock;
  }
};

int axis_of(char letter, char x) { return letter >= x && letter <= x + 2 ? letter - x : -1; }

}  // namespace

EulerSequence::EulerSequence(std::string_view letters) {
  const auto refuse = [&](std::string_view cause) {
    throw InvalidInput("sequence", "three axes such as 'ZXZ' (intrinsic) or 'zxz' (extrinsic)",
                       "'" + std::string(letters) + "'", cause);
  };
  if (letters.size() != 3) refuse("");
  extrinsic_ = axis_of(letters[0], 'x') >= 0;
  int axes[3];
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = axis_of(letters[i], extrinsic_ ? 'x' : 'X');
    if (axes[i] < 0) refuse(axis_of(letters[i], extrinsic_ ? 'X' : 'x') >= 0 ? "upper and lower case are mixed" : "");
  }
  if (axes[0] == axes[1] || axes[1] == axes[2]) refuse("neighbouring axes must differ");
  proper_ = axes[0] == axes[2];
  first_ = extrinsic_ ? axes[2] : axes[0];
  second_ = axes[1];
  other_ = 3 - first_ - second_;
  sign_ = (second_ - first_ + 3) % 3 == 1 ? 1.0 : -1.0;
}

std::string EulerSequence::letters() const {
  const char x = extrinsic_ ? 'x' : 'X';
  std::string text = {static_cast<char>(x + first_), static_cast<char>(x + second_), static_cast<char>(x + last())};
  if (extrinsic_) std::swap(text[0], text[2]);
  return text;
}

Quat quat_from_euler(const EulerSequence& sequence, const Vector3d& angles) {
  double s[3], c[3], q[4];
  for (int i = 0; i < 3; ++i) {
    const math::SinCosPair half = math::sincos(0.5 * angles[sequence.extrinsic() ? 2 - i : i]);
    s[i] = half.sin, c[i] = half.cos;
  }
  compose(sequence, s, c, q);
  return {q[0], q[1], q[2], q[3]};
}

bool gimbal_lock(const EulerSequence& sequence, const Quat& q_WB) { return Polar(sequence, q_WB).locked(sequence); }

Vector3d to_euler(const EulerSequence& sequence, const Quat& q_WB) {
  const Polar p(sequence, q_WB);
  const bool at_sum_pole = p.r_difference < p.r_sum;
  const double last_sign = sequence.proper() ? 1.0 : sequence.sign();
  double first, middle, last;
  if (p.locked(sequence)) {
    // Only the half angle of the longer vector is known; the angle that comes third in the letters is 0.
    const double half = at_sum_pole ? math::atan2(p.sum_y, p.sum_x) : math::atan2(p.difference_y, p.difference_x);
    const double whole = wrap(2.0 * half);
    first = sequence.extrinsic() ? 0.0 : whole;
    last = sequence.extrinsic() ? last_sign * (at_sum_pole ? whole : -whole) : 0.0;
    middle = (at_sum_pole ? 0.0 : pi);
    if (!sequence.proper()) middle = at_sum_pole ? 0.5 * pi : -0.5 * pi;
  } else {
    const double sum = math::atan2(p.sum_y, p.sum_x), difference = math::atan2(p.difference_y, p.difference_x);
    first = wrap(sum + difference);
    last = last_sign * wrap(sum - difference);
    if (sequence.proper()) {
      middle = 2.0 * math::atan2(p.r_difference, p.r_sum);
    } else {
      // Its sine and cosine: (r_sum^2 - r_difference^2)/2, without the cancellation, and r_sum r_difference.
      const double v[3] = {q_WB.x, q_WB.y, q_WB.z};
      const double sine = 2.0 * (q_WB.w * v[sequence.second()] +
                                 sequence.sign() * v[sequence.first()] * v[sequence.other()]);
      middle = math::atan2(sine, p.r_sum * p.r_difference);
    }
  }
  if (sequence.extrinsic()) std::swap(first, last);
  return {first, middle, last};
}

}  // namespace polhode
