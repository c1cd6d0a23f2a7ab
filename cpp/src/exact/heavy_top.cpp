#include "polhode/exact/heavy_top.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "exact/heavy_top_start.hpp"
#include "exact/time_parts.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/exact/detail/heavy_top_kernels.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/phase.hpp"

namespace polhode {
namespace {

using math::DD;

std::string text(const Vector3d& v) {
  std::string all = "(";
  all.append(to_text(v[0])).append(", ").append(to_text(v[1])).append(", ").append(to_text(v[2])).append(")");
  return all;
}

/// `found` is a function, so that its text is made only for a refusal.
template <class Found>
void require(bool fine, const char* where, const char* requirement, const Found& found, const char* cause = "") {
  if (!fine) throw InvalidInput(where, requirement, found(), cause);
}

/// The symmetry axis and the two moments, A of the equal pair and C about the axis.
struct TopSymmetry {
  Vector3d axis;
  double A, C;
};

constexpr double negligible = 0x1p-900;   // beside rates and attitudes near 1
constexpr double equal_within = 32 * std::numeric_limits<double>::epsilon();

TopSymmetry symmetry_of(const Vector3d& moments) {
  const double tolerance = equal_within * moments.maxCoeff();
  for (const int axis : {2, 0, 1}) {
    const double a = moments[(axis + 1) % 3], b = moments[(axis + 2) % 3];
    if (std::abs(a - b) <= tolerance) return {Vector3d::Unit(axis), a == b ? a : a / 2 + b / 2, moments[axis]};
  }
  const Vector3d m = moments;
  const double gap = std::min({std::abs(m[0] - m[1]), std::abs(m[1] - m[2]), std::abs(m[2] - m[0])});
  throw InvalidInput("inertia", "that of a symmetric top, two moments equal", text(moments),
                     "the nearest two differ by " + to_text(gap / moments.maxCoeff()) +
                         " of the largest: set them equal if they should be, else integrate with polhode.solve");
}

/// The same for a full tensor. With two equal moments A, I = A + (C - A) n n^T. The column with the largest diagonal
/// entry of n n^T is along n. The invariants of the deviator give the mean of the equal moments.
TopSymmetry symmetry_of(const Matrix3d& I) {
  const double largest = I.cwiseAbs().maxCoeff();
  if (I(0, 1) == 0.0 && I(0, 2) == 0.0 && I(1, 2) == 0.0) return symmetry_of(Vector3d(I.diagonal()));
  const Matrix3d S = I / largest;
  const double mean = S.trace() / 3.0;
  Matrix3d T = S - mean * Matrix3d::Identity();  // deviator: (C - A) (n n^T - 1/3)
  const double size = std::sqrt(1.5 * T.squaredNorm());
  const double split = T.determinant() >= 0.0 ? size : -size;  // C - A
  TopSymmetry found{Vector3d::UnitZ(), (mean - split / 3.0) * largest, (mean + split * (2.0 / 3.0)) * largest};
  if (size > equal_within) {
    T = T / split + Matrix3d::Identity() / 3.0;  // n n^T
    Eigen::Index column = 0;
    T.diagonal().maxCoeff(&column);
    found.axis = T.col(column).normalized();
  }
  const Vector3d n = found.axis;
  const double rest =
      (I - found.A * Matrix3d::Identity() - (found.C - found.A) * (n * n.transpose())).cwiseAbs().maxCoeff() / largest;
  require(rest <= equal_within, "inertia", "that of a symmetric top, two moments equal",
          [&] { return "a tensor that differs from one by " + to_text(rest) + " of its largest entry"; },
          "use the symmetric tensor that is meant, or solve the scene step by step");
  Eigen::Index lead = 0;
  n.cwiseAbs().maxCoeff(&lead);
  if (n[lead] < 0.0) found.axis = -n;
  return found;
}

/// q_SB, which rotates the symmetry axis to z. Exact for a coordinate axis.
Quat to_working_axes(const Vector3d& n) {
  if (n == Vector3d::UnitZ()) return {};
  if (n == Vector3d::UnitX()) return {-0.5, -0.5, -0.5, 0.5};
  if (n == Vector3d::UnitY()) return {0.5, 0.5, 0.5, 0.5};
  return normalized({n[1], -n[0], 0.0, 1.0 + n[2]});
}

struct DDQuat {
  DD x, y, z, w;
};
DDQuat multiply(const DDQuat& a, const DDQuat& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
DDQuat widen(const Quat& q) { return {q.x, q.y, q.z, q.w}; }

/// 2^e x; throws InvalidInput if it is not representable in float64.
double from_scaled(double x, int e, const char* what) {
  const double result = std::ldexp(x, e);
  const bool fine = std::isfinite(result) && (x == 0.0 || std::abs(result) >= std::numeric_limits<double>::min());
  require(fine, what, "representable in float64", [&] { return to_text(x) + " * 2^" + std::to_string(e); },
          "choose other units");
  return result;
}

}  // namespace

const char* to_text(TopKind kind) {
  constexpr const char* names[] = {"free",              "sleeping",        "hanging",
                                   "steady_precession", "planar_pendulum", "spherical_pendulum",
                                   "homoclinic",        "looping",         "cuspidal",
                                   "monotone"};
  return names[static_cast<int>(kind)];
}

HeavyTop::HeavyTop(const Vector3d& moments, double weight_arm, const Vector3d& omega, const Quat& attitude,
                   double rotor)
    : HeavyTop(InertiaTensor::from_moments(moments), weight_arm, omega, attitude, rotor) {}

HeavyTop::HeavyTop(const InertiaTensor& inertia, double weight_arm, const Vector3d& omega, const Quat& attitude,
                   double rotor)
    : inertia_(inertia), weight_arm_(weight_arm), omega_(omega), attitude_(attitude), rotor_(rotor) {
  set_up();
}

void HeavyTop::set_up() {
  make_attitude(attitude_);  // refuses; the start itself is normalised in double-double
  require(std::isfinite(weight_arm_), "weight_arm", "finite", [&] { return to_text(weight_arm_); });
  require(omega_.allFinite(), "omega", "finite", [&] { return text(omega_); });
  require(std::isfinite(rotor_), "rotor", "finite", [&] { return to_text(rotor_); });
  require_kept(weight_arm_, "weight_arm");
  require_kept(rotor_, "rotor");
  for (const double rate : omega_) require_kept(rate, "omega");
  const TopSymmetry body = symmetry_of(inertia_.matrix());
  axis_ = body.axis;

  // Scales: powers of two, so that A, and the larger of |omega| and sqrt(M / A), are near 1.
  require(body.A > 0.0, "inertia", "above 0 across the symmetry axis", [&] { return to_text(body.A); });
  const double spin = omega_.dot(axis_);
  require(body.C > 0.0 || (body.C == 0.0 && spin == 0.0 && rotor_ == 0.0), "inertia", "above 0 about the symmetry axis",
          [&] { return to_text(body.C); },
          "a rod or a point may swing, but not spin about its own axis");
  const int e_A = std::ilogb(body.A);
  require(std::abs(e_A) <= 1021 && (body.C == 0.0 || std::abs(std::ilogb(body.C) - e_A) <= 500), "inertia",
          "moments within the range of float64", [&] { return text({body.A, body.A, body.C}); }, "choose other units");
  const DD added = rotor_ == 0.0 ? DD(0.0) : DD(rotor_) / DD(body.C);   // to the rate about the axis
  const DD half_turns = math::scaled(added * DD(0.15915494309189535, -9.839338337591243e-18), 0.5);
  half_turns_ = half_turns.hi, half_turns_low_ = half_turns.lo;
  const double fastest = std::max(omega_.cwiseAbs().maxCoeff(), std::abs(added.hi));
  require(std::isfinite(fastest), "rotor", "such that rotor / moment is a finite rate",
          [&] { return to_text(rotor_); });
  const int none = -100000;
  const int e_w = fastest > 0.0 ? std::ilogb(fastest) : none;
  const int e_M = weight_arm_ != 0.0 ? (std::ilogb(weight_arm_) - e_A) / 2 : none;
  const int e = std::max(e_w, e_M) == none ? 0 : std::max(e_w, e_M);
  require(e <= 1020 && e >= -1000, "omega", "such that rates are representable in float64",
          [&] { return "rates near 2^" + std::to_string(e) + " rad/s"; }, "choose other units of time");
  constants_.rate_scale = std::ldexp(1.0, e);
  largest_time_ = std::min(std::ldexp(1e25, -e), std::numeric_limits<double>::max());

  // Centre of mass below: rotate the body axes by pi about x.
  Vector3d w = omega_.unaryExpr([&](double c) { return std::ldexp(c, -e); });
  Quat start_q = attitude_;
  const bool below = weight_arm_ < 0.0;
  // A weight next to the smallest numbers would lose its digits, and no time lets it act: it is taken as none. What is
  // as small beside 1 in the start is then none either: quotients of it leave the range of float64.
  const double weight = std::ldexp(std::abs(weight_arm_), -e_A - 2 * e);
  if (weight < negligible) {
    for (double* part : {&w[0], &w[1], &w[2], &start_q.x, &start_q.y, &start_q.z, &start_q.w})
      if (std::abs(*part) < negligible) *part = 0.0;
  }
  exact::HeavyTopStart s{.A = std::ldexp(body.A, -e_A), .C = std::ldexp(body.C, -e_A),
                         .M = weight < negligible ? 0.0 : weight,
                         .w1 = w[0], .w2 = w[1], .w3 = w[2],
                         .x = start_q.x, .y = start_q.y, .z = start_q.z, .w = start_q.w};
  constants_.framed = below || axis_ != Vector3d::UnitZ();
  if (axis_ != Vector3d::UnitZ()) {
    DDQuat q = widen(to_working_axes(axis_));
    const DD norm = math::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    q = {q.x / norm, q.y / norm, q.z / norm, q.w / norm};
    const DDQuat back{-q.x, -q.y, -q.z, q.w};
    const DDQuat start = multiply(widen(start_q), back);
    const DDQuat w_S = multiply(multiply(q, {w[0], w[1], w[2], 0.0}), back);
    s.w1 = w_S.x, s.w2 = w_S.y, s.w3 = w_S.z;
    s.x = start.x, s.y = start.y, s.z = start.z, s.w = start.w;
    constants_.q_SB = {q.x.hi, q.y.hi, q.z.hi, q.w.hi};
  }
  const DD w3 = s.w3;
  if (rotor_ != 0.0) s.w3 = s.w3 + math::scaled(added, std::ldexp(1.0, -e));
  if (below) {
    s.w2 = -s.w2, s.w3 = -s.w3;
    const DD x = s.x, y = s.y;
    s.x = s.w, s.y = s.z, s.z = -y, s.w = -x;
    const Quat q = constants_.q_SB;
    constants_.q_SB = {-q.w, q.z, -q.y, q.x};  // (-1, 0, 0; 0) q
  }
  exact::HeavyTopMotion motion;
  exact::heavy_top_kernels().set_up(s, constants_, motion);
  require(motion.lost_within == 0.0, "attitude", "further from the unstable upright position, or exactly in it",
          [&] { return "a tilt or kick of " + to_text(motion.lost_within) + " beside 1"; },
          "float64 cannot follow it from there");

  // The hyperbolic form counts its nutations in a double.
  if (constants_.hyper && constants_.rate_z.hi > 0.0)
    largest_time_ = std::min(largest_time_, std::ldexp(0x1p52 / constants_.rate_z.hi, -e));

  const Matrix3d R_SB = to_matrix(constants_.q_SB);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) constants_.R_BS[3 * i + j] = R_SB(j, i);
  constants_.w3 *= constants_.rate_scale;
  constants_.w12_re *= constants_.rate_scale;
  constants_.w12_im *= constants_.rate_scale;

  kind_ = motion.kind;
  period_ = std::ldexp(motion.period, -e);
  precession_ = std::ldexp(motion.precession, e);
  tilt_min_ = 2.0 * math::atan2(motion.sin_high, motion.cos_high);
  tilt_max_ = 2.0 * math::atan2(motion.sin_low, motion.cos_low);
  if (below) {
    tilt_min_ = 2.0 * math::atan2(motion.cos_low, motion.sin_low);
    tilt_max_ = 2.0 * math::atan2(motion.cos_high, motion.sin_high);
  }
  const DD w3_all = below ? -s.w3 : s.w3, inside = s.C * (w3_all - w3) * (w3_all + w3);
  scaled_[0] = (motion.energy - math::scaled(inside, 0.5)).hi, scaled_[1] = motion.p_phi.hi;
  scaled_[2] = below ? -motion.p_psi.hi : motion.p_psi.hi;
  scale_of_A_ = e_A, scale_of_rate_ = e;
}

double HeavyTop::energy() const { return from_scaled(scaled_[0], scale_of_A_ + 2 * scale_of_rate_, "energy"); }
double HeavyTop::p_phi() const { return from_scaled(scaled_[1], scale_of_A_ + scale_of_rate_, "p_phi"); }
double HeavyTop::p_psi() const { return from_scaled(scaled_[2], scale_of_A_ + scale_of_rate_, "p_psi"); }

void HeavyTop::at(const double* t, std::size_t n, double* omega, double* attitude) const {
  exact::each_part(exact::TimeGrid(t, n), [&](const exact::TimeGrid& part, std::size_t begin) {
    at(part, omega ? omega + 3 * begin : nullptr, attitude ? attitude + 4 * begin : nullptr);
  });
}

void HeavyTop::at(const exact::TimeGrid& times, double* omega, double* attitude) const {
  const exact::HeavyTopKernels& kernels = exact::heavy_top_kernels();
  if (!(kernels.times.reach(times.t, times.n) <= largest_time_)) {
    for (std::size_t i = 0; i < times.n; ++i) {
      if (!(std::abs(times.t[i]) <= largest_time_)) {
        throw InvalidInput("t", "finite and at most " + to_text(largest_time_) + " s in size", to_text(times.t[i]),
                           "beyond it the phase has too few digits");
      }
    }
  }
  kernels.at(constants_, times, omega, attitude);
  if (rotor_ != 0.0) rotate_back(times, omega, attitude);
}

/// The plain top has omega3 + h / C about its axis. The body is rotated back about it by h t / C.
void HeavyTop::rotate_back(const exact::TimeGrid& times, double* omega, double* attitude) const {
  const Vector3d& n = axis_;
  const Vector3d axial = omega_.dot(n) * n;   // constant
  for (std::size_t i = 0; i < times.n; ++i) {
    double s = 0.0, c = 1.0;   // of half the angle
    math::sincos_cycles(math::cycle_fraction(times.t[i], half_turns_, half_turns_low_, 0.0), s, c);
    if (omega != nullptr) {
      Eigen::Map<Vector3d> w(omega + 3 * i);
      const Vector3d across = w - n.dot(w) * n;
      const Vector3d quarter{n[1] * across[2] - n[2] * across[1], n[2] * across[0] - n[0] * across[2],
                             n[0] * across[1] - n[1] * across[0]};   // n x across
      w = axial + (across + 2 * s * (c * quarter - s * across));
    }
    if (attitude == nullptr) continue;
    double* q = attitude + 4 * i;
    const Quat rotated = Quat{q[0], q[1], q[2], q[3]} * Quat{-s * n[0], -s * n[1], -s * n[2], c};
    q[0] = rotated.x, q[1] = rotated.y, q[2] = rotated.z, q[3] = rotated.w;
  }
}

State HeavyTop::at(double t) const { return exact::find_state(*this, t); }

}  // namespace polhode
