#include "exact/pendulum_start.hpp"

#include <algorithm>
#include <cmath>

#include "exact/expansion.hpp"
#include "exact/free_frame.hpp"
#include "polhode/exact/detail/free_setup.hpp"

namespace polhode::exact {
namespace {

using math::DD;

constexpr int widest_ratio = 400;   // of omega and the frequency, as a power of two

/// a b == c d, exactly.
bool are_products_equal(double a, double b, double c, double d) {
  if (a == 0.0 || b == 0.0 || c == 0.0 || d == 0.0) return (a == 0.0 || b == 0.0) && (c == 0.0 || d == 0.0);
  int ea = 0, eb = 0, ec = 0, ed = 0;
  const DD left = math::two_prod(std::frexp(a, &ea), std::frexp(b, &eb));
  const DD right = math::two_prod(std::frexp(c, &ec), std::frexp(d, &ed));
  const int apart = ea + eb - ec - ed;
  return std::abs(apart) <= 1 && math::scaled(left, std::ldexp(1.0, apart)) == right;
}

/// a^2 + b^2 == c^2 + d^2, exactly; false if a square is below the range of double-doubles.
bool are_sums_of_squares_equal(double a, double b, double c, double d) {
  Expansion difference;
  const double all[4] = {a, b, c, d};
  for (int i = 0; i < 4; ++i) {
    if (all[i] != 0.0 && std::abs(all[i]) < 0x1p-480) return false;
    const DD square = math::two_prod(all[i], i < 2 ? all[i] : -all[i]);
    difference.add(square.lo), difference.add(square.hi);
  }
  return difference.is_zero();
}

/// e_z . R e of a body axis e vanishes.
bool is_horizontal(const Quat& q, int axis) {
  if (axis == 0) return are_products_equal(q.x, q.z, q.w, q.y);
  if (axis == 1) return are_products_equal(q.y, q.z, -q.w, q.x);
  return are_sums_of_squares_equal(q.z, q.w, q.x, q.y);
}

std::string refuse_axis(const Matrix3d& I, const Vector3d& arm, const Quat& attitude, int axis) {
  const int f = (axis + 1) % 3, g = (axis + 2) % 3;
  if (arm[axis] != 0.0) return "the centre of mass is not in the plane across the axis of rotation";
  if (I(f, axis) != 0.0 || I(g, axis) != 0.0) return "the axis of rotation is no principal axis";
  if (!is_horizontal(attitude, axis)) return "the axis of rotation is not exactly horizontal";
  return "";
}

/// cos(phi / 2) and sin(phi / 2) of an angle, times any common factor, and their squares.
struct HalfAngle {
  DD cosine, sine, cosine2, sine2;
};

DD square(DD x) { return x * x; }

/// The angle of the vertical (R^T e_z) from the body axis f, in the plane of f and g.
HalfAngle measure_vertical(const Quat& q, int f, int g, double sign_of_g) {
  const DD x(q.x), y(q.y), z(q.z), w(q.w), two(2.0);
  const DD row[3] = {x * z - w * y, y * z + w * x, (z * z + w * w) - (x * x + y * y)};
  // |q|^2 (1 +- row_f), as sums of squares.
  DD plus, minus;
  if (f == 0) {
    plus = square(x + z) + square(w - y), minus = square(x - z) + square(w + y);
  } else if (f == 1) {
    plus = square(y + z) + square(w + x), minus = square(y - z) + square(w - x);
  } else {
    plus = two * (z * z + w * w), minus = two * (x * x + y * y);
  }
  HalfAngle half{sqrt(plus), sqrt(minus), plus, minus};
  if (row[g].hi * sign_of_g < 0.0) half.sine = -half.sine;
  return half;
}

}  // namespace

PendulumAxis find_pendulum_axis(const Matrix3d& I, const Vector3d& arm, const Vector3d& omega, const Quat& attitude) {
  std::string first;
  int along = 0, moving = 0;
  for (int i = 0; i < 3; ++i)
    if (omega[i] != 0.0) ++moving, along = i;
  if (moving > 1) return {-1, "omega is not along one of the body axes"};
  for (int axis = 0; axis < 3; ++axis) {
    if (moving == 1 && axis != along) continue;
    std::string why_not = refuse_axis(I, arm, attitude, axis);
    if (why_not.empty()) return {axis, ""};
    if (first.empty()) first = std::move(why_not);
  }
  return {-1, moving == 1 ? first : "no body axis is principal, exactly horizontal and at right angles to the arm"};
}

bool carries_pendulum(double moment, double weight, const Vector3d& arm, double omega) {
  const double least = std::min({std::abs(weight), arm.cwiseAbs().maxCoeff(), moment});
  const double most = std::max({std::abs(weight), arm.cwiseAbs().maxCoeff(), moment});
  if (!(least >= 0x1p-1000 && most <= 0x1p1000)) return false;
  const int twice = std::ilogb(weight) + exponent_of(arm) - std::ilogb(moment);
  if (std::abs(twice) > 1800) return false;
  return omega == 0.0 || std::abs(std::ilogb(omega) - twice / 2) <= widest_ratio;
}

PendulumStart analyse_pendulum(double moment, double weight, const Vector3d& arm, double omega, const Quat& attitude,
                               int axis) {
  PendulumStart out;
  const DD one(1.0), four(4.0);
  // f is the body axis nearest to the arm; f x g is the body axis of rotation. The weight is taken as positive.
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  const bool first = std::abs(arm[next]) >= std::abs(arm[last]);
  const int f = first ? next : last, g = first ? last : next;
  const double sign_of_g = first ? 1.0 : -1.0;
  const int e_arm = exponent_of(arm), e_weight = std::ilogb(weight), e_moment = std::ilogb(moment);
  const double up = weight < 0.0 ? -1.0 : 1.0;
  const double rf = up * std::ldexp(arm[f], -e_arm), rg = up * sign_of_g * std::ldexp(arm[g], -e_arm);
  const DD length = rg == 0.0 ? DD(std::abs(rf)) : sqrt(math::two_prod(rf, rf) + math::two_prod(rg, rg));

  // theta0 / 2 = pi / 2 - (phi - rho) / 2, phi of the vertical and rho of the arm, both from f towards g.
  const HalfAngle phi = measure_vertical(attitude, f, g, sign_of_g);
  DD s, c, c2;   // times sqrt(2) |q|
  if (rg == 0.0) {
    s = rf > 0.0 ? phi.cosine : phi.sine, c = rf > 0.0 ? phi.sine : -phi.cosine;
    c2 = rf > 0.0 ? phi.sine2 : phi.cosine2;
  } else {
    const DD cosine = rf > 0.0 ? length + DD(rf) : DD(rg), sine = rf > 0.0 ? DD(rg) : length - DD(rf);
    const DD size = sqrt(cosine * cosine + sine * sine);
    s = (phi.cosine * cosine + phi.sine * sine) / size, c = (phi.sine * cosine - phi.cosine * sine) / size;
    c2 = c * c;
  }
  if (c.hi < 0.0) s = -s, c = -c;
  if (c.hi == 0.0) s = abs(s);
  if (omega < 0.0) s = -s;
  const DD size2 = phi.cosine2 + phi.sine2, size = sqrt(size2);   // 2 |q|^2
  out.half_sine = s / size, out.half_cosine = c / size;

  // Scales: powers of two, so that the larger of |omega| and the frequency is near 1.
  int twice = e_weight + e_arm - e_moment;
  double scaled_weight = std::ldexp(std::abs(weight), -e_weight);
  if (twice % 2 != 0) scaled_weight *= 2.0, --twice;
  const int e_frequency = twice / 2, e = omega == 0.0 ? e_frequency : std::max(e_frequency, std::ilogb(omega));
  const DD pull = math::scaled(DD(scaled_weight) * length, std::ldexp(1.0, 2 * (e_frequency - e)));   // m g |r|
  const double I = std::ldexp(moment, -e_moment), w = std::abs(std::ldexp(omega, -e));
  out.rate_exponent = e;
  out.frequency = sqrt(pull / DD(I));
  if (w == 0.0 && (s.hi == 0.0 || c.hi == 0.0)) return out;   // at rest, hanging or upright

  // k^2 = sin^2(theta0 / 2) + p^2, k'^2 = cos^2(theta0 / 2) - p^2, p = omega / (2 frequency); k'^2 without division, so
  // that a start on the separatrix is there to the last bit.
  const DD p = DD(w) / math::twice(out.frequency);
  const DD weightless = four * pull * size2;
  const DD excess = four * pull * c2 - DD(I) * math::two_prod(w, w) * size2;
  const DD kc = sqrt(abs(excess) / weightless), k = hypotenuse(abs(out.half_sine), p);
  if (excess.hi == 0.0) {
    out.kind = PendulumKind::separatrix;
    out.rate = out.frequency, out.k = one, out.kc = DD(0.0);
    out.sn = out.half_sine, out.cn = out.dn = out.half_cosine;
    return out;
  }
  if (excess.hi > 0.0) {
    out.kind = PendulumKind::swinging;
    out.rate = out.frequency, out.k = k, out.kc = kc;
    out.sn = out.half_sine / k, out.cn = p / k, out.dn = out.half_cosine;
  } else {
    out.kind = PendulumKind::rotating;
    out.rate = out.frequency * k, out.k = one / k, out.kc = kc / k;
    out.sn = out.half_sine, out.cn = out.half_cosine, out.dn = p / k;
  }
  // The smaller of the two decides.
  if (out.k < out.kc) {
    out.kc = sqrt((one - out.k) * (one + out.k));
  } else {
    out.k = sqrt((one - out.kc) * (one + out.kc));
  }
  return out;
}

}  // namespace polhode::exact
