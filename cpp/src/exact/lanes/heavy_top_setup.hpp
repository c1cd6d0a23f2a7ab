#pragma once

#include <cmath>
#include <limits>

#include "exact/lanes/heavy_top_complex.hpp"
#include "exact/lanes/heavy_top_enlargement.hpp"
#include "exact/lanes/heavy_top_roots.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/landen.hpp"

// Names follow docs/heavy_top.md: a = C w3 / A, b = p_phi / A, bt (there mu) = 2 M / A, u = cos(tilt),
// u1 <= u <= u2 <= u3.
namespace polhode::POLHODE_ISA {

using exact::degree_12;
using Chain = math::LandenChain<DD>;

constexpr int most_terms = 7;  // of the theta sums in the set-up: errors of q^42 for q <= 0.21

/// The number of terms that double-double needs for a nome.
inline int terms_for(double q) {
  int n = 1;
  double left = q, power = q * q * q;  // q^(n^2), q^(2n+1)
  for (; left > 1e-34 && n < most_terms; ++n, power *= q * q) left *= power;
  return n;
}
inline DD root_of(DD a) { return a.hi > 0.0 ? sqrt(a) : DD(0.0); }
inline double sign(DD a) { return a.hi < 0.0 ? -1.0 : 1.0; }
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Coefficients q^(n(n+1)) rho^(2n+1) (cosh, sinh)((2n+1) zeta) / rho^(2n) of one theta quotient, from the descent.
struct Series {
  DD cosh[most_terms], sinh[most_terms];
  int terms;
  Series(const Chain& chain, DD nome, DD P, DD Q, DD R) : terms(terms_for(nome.hi)) {
    const auto end = math::descend_imaginary(chain, P, Q, R);
    const DD sum = end.P + end.H, rho = end.Q / sum;
    const DD c = end.H / sum, s = end.P / sum, c2 = c * c + s * s, s2 = (c + c) * s;
    const DD ratio = nome.hi == 0.0 ? DD(0.0) : nome / (rho * rho);
    cosh[0] = c, sinh[0] = s;
    DD ce = c, se = s, weight = DD(1.0), q_n = DD(1.0);  // weight = (q / rho^2)^n q^(n^2)
    for (int n = 1; n < terms; ++n) {
      const DD next = ce * c2 + se * s2;
      se = se * c2 + ce * s2, ce = next;
      weight = weight * ratio * q_n * nome;  // q^(2n-1)
      q_n = q_n * nome * nome;
      cosh[n] = weight * ce, sinh[n] = weight * se;
    }
  }
  DD sum_cosh() const {
    DD sum = cosh[terms - 1];
    for (int n = terms - 2; n >= 0; --n) sum = sum + cosh[n];
    return sum;
  }
  /// The logarithmic derivative of the quotient at its quarter period, over i.
  DD rate() const {
    DD sum = DD(0.0);
    for (int n = terms - 1; n >= 0; --n) sum = sum + DD(2.0 * n + 1.0) * sinh[n];
    return sum / sum_cosh();
  }
};

/// sum of (+-1)^n coefficient[n] F_n, as monomials in X = cos 2z, where cos(2n+1)z = cos z V_n(X) and
/// sin(2n+1)z = sin z W_n(X). The table has V_n, and W_n(X) = (-1)^n V_n(-X).
struct Monomials {
  double p[5] = {};
  enum Kind { V, W };
  Monomials(const DD (&coefficient)[most_terms], double alternate, bool weighted, Kind kind, double factor) {
    static constexpr double table[5][5] = {
        {1, 0, 0, 0, 0}, {-1, 2, 0, 0, 0}, {-1, -2, 4, 0, 0}, {1, -4, -4, 8, 0}, {1, 4, -12, -8, 16}};
    for (int n = 0; n < 5; ++n, factor *= alternate) {
      const double c = factor * (weighted ? 2.0 * n + 1.0 : 1.0) * coefficient[n].hi;
      for (int i = 0; i <= n; ++i) p[i] += (kind == W && (n + i) % 2 ? -c : c) * table[n][i];
    }
  }
};

/// sum += factor (shift + slope X) a b, up to degree_12.
POLHODE_INLINE void add_product(double (&sum)[degree_12 + 1], double factor, double shift, double slope,
                                const Monomials& a, const Monomials& b) {
  double product[degree_12 + 1] = {};
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) product[i + j] = math::madd(a.p[i], b.p[j], product[i + j]);
  for (int i = 0; i <= degree_12; ++i)
    sum[i] = math::madd(factor, math::madd(shift, product[i], i > 0 ? slope * product[i - 1] : 0.0), sum[i]);
}

/// The quantities that both forms need: roots, moduli, and rates of the phases at the extreme tilts.
struct Common {
  const HeavyTopStart& start;
  const TiltCubic& cubic;
  DD k, kc, p;              // modulus, complement, u = u1 + D sn^2(p t + ..)
  DD sn, cn, dn;            // at the start
  DD A_sn, A_cn, A_dn;      // times sqrt(mu2): of the imaginary argument of alpha, modulus k'
  DD B_sn, B_cn, B_dn;      // times k' sqrt(e1): of beta
  DD rate_a, rate_b;        // at the highest and the lowest point
  double sA, sB;
};

/// N1, N2, theta at the start and their derivatives by the theta argument, up to one common real factor.
struct AtStart {
  Complex N1, D1, N2, D2;
  DD theta, d_theta;
  bool by_slope_1, by_slope_2;  // near the vertical the values pass 0 and are small beside their greatest
};

/// The direction of the constant c in value = c N and slope = c (i k N + speed (D - N theta' / theta)), from the
/// equation that is not small.
inline Complex direction(bool by_slope, Complex value, Complex slope, Complex N, Complex D, DD k, DD speed,
                         const AtStart& f) {
  if (!by_slope) return unit(balanced(value) * conj(N));
  const Complex slope_N = k * times_i(N) + speed * (D - (f.d_theta / f.theta) * N);
  return unit(balanced(slope) * conj(balanced(slope_N)));
}

/// Sets the factors c_a and c_b, of given size, so that the attitude at t = 0 is that of the start.
inline void set_factors(HeavyTopConstants& c, const HeavyTopStart& s, DD ca, DD cb, DD kA, DD kB, DD speed,
                        const AtStart& f) {
  const Complex alpha{s.w, s.z}, beta{s.x, s.y}, wp{s.w1, s.w2};
  const DD half = DD(0.5);
  const Complex alpha_slope = half * (s.w3 * times_i(alpha) - conj(wp) * beta);
  const Complex beta_slope = half * (wp * alpha - s.w3 * times_i(beta));
  const Complex a = ca * direction(f.by_slope_1, alpha, alpha_slope, f.N1, f.D1, kA, speed, f);
  const Complex b = cb * direction(f.by_slope_2, beta, beta_slope, f.N2, f.D2, kB, speed, f), ab = conj(a) * b;
  c.ca_re = a.re.hi, c.ca_im = a.im.hi, c.cb_re = b.re.hi, c.cb_im = b.im.hi;
  c.w12_re = 2.0 * ab.re.hi, c.w12_im = 2.0 * ab.im.hi;
  c.speed = speed.hi, c.sum_k = (kA + kB).hi;
}

/// The half turns of N1 and N2 in the complex plane over a nutation; 0 when they pass through 0.
inline double half_turns_of_a(const Common& m) { return m.cubic.mu1.hi == 0.0 ? 0.0 : m.sA; }
inline double half_turns_of_b(const Common& m) { return m.cubic.x2.hi == 0.0 ? 0.0 : m.sB; }

inline void set_up_trig(HeavyTopConstants& c, HeavyTopMotion& motion, const Common& m) {
  const Chain chain(m.k, m.kc);
  const DD nome = chain.nome(), nu = m.p / chain.two_K_over_pi();
  const auto z = math::descend_real(chain, m.sn, m.cn, DD(1.0), m.dn);
  const Complex z0 = unit({z.X, z.Y});
  const Series a(chain, nome, m.A_sn, m.A_cn, m.A_dn), b(chain, nome, m.B_sn, m.B_cn, m.B_dn);
  const DD kA = m.rate_a - DD(m.sA) * (nu * a.rate()), kB = m.rate_b - DD(m.sB) * (nu * b.rate());

  // theta4 at a quarter period and at 0, for the sizes of the factors
  DD high = DD(1.0), low = DD(1.0), q_n2 = nome, q_odd = nome * nome * nome;
  const int terms = a.terms;
  for (int n = 1; n < terms; ++n) {
    high = high + q_n2 + q_n2;
    low = low + (n % 2 ? -(q_n2 + q_n2) : q_n2 + q_n2);
    q_n2 = q_n2 * q_odd;
    q_odd = q_odd * nome * nome;
  }
  const DD ca = sqrt(math::scaled(m.cubic.mu2, 0.5)) * high / a.sum_cosh();
  const DD cb = sqrt(math::scaled(m.cubic.e1, 0.5)) * low / b.sum_cosh();

  // the start, by addition of angles and not from a rounded z0
  AtStart f{};
  Complex odd = z0;  // the angle (2n+1) z0
  const Complex twice = z0 * z0;
  for (int n = 0; n < terms; ++n, odd = odd * twice) {
    const double alternate = n % 2 ? -1.0 : 1.0;
    const DD ac = math::scaled(a.cosh[n], alternate), as = math::scaled(a.sinh[n], m.sA * alternate);
    const DD bc = b.cosh[n], bs = math::scaled(b.sinh[n], m.sB);
    f.N1 = f.N1 + Complex{ac * odd.im, -as * odd.re};
    f.N2 = f.N2 + Complex{bc * odd.re, bs * odd.im};
  }
  const auto small = [](Complex N, DD greatest) { return size2(N) < 0.01 * greatest.hi * greatest.hi; };
  f.by_slope_1 = small(f.N1, a.sum_cosh()), f.by_slope_2 = small(f.N2, b.sum_cosh());
  if (f.by_slope_1 || f.by_slope_2) {
    odd = z0;
    Complex even{DD(1.0), DD(0.0)};
    DD weight = DD(1.0), q_step = nome;  // (-1)^n q^(n^2), twice that from n = 1 on
    for (int n = 0; n < terms; ++n, odd = odd * twice, even = even * twice) {
      const double alternate = n % 2 ? -1.0 : 1.0;
      const DD ac = math::scaled(a.cosh[n], alternate), as = math::scaled(a.sinh[n], m.sA * alternate);
      const DD m1 = DD(2.0 * n + 1.0);
      f.D1 = f.D1 + m1 * Complex{ac * odd.re, as * odd.im};
      f.D2 = f.D2 + m1 * Complex{-b.cosh[n] * odd.im, math::scaled(b.sinh[n], m.sB) * odd.re};
      f.theta = f.theta + weight * even.re;
      f.d_theta = f.d_theta - DD(2.0 * n) * weight * even.im;
      weight = -(n == 0 ? weight + weight : weight) * q_step;
      q_step = q_step * nome * nome;
    }
  }
  set_factors(c, m.start, ca, cb, kA, kB, nu, f);

  c.hyper = false;
  c.rate_z = in_cycles(nu), c.rate_a = in_cycles(kA), c.rate_b = in_cycles(kB);
  // relative to the nearest quarter cycle, so that the rounding is that of a small angle
  const bool along = abs(z0.re.hi) >= abs(z0.im.hi);
  const double quadrant = along ? (z0.re.hi > 0 ? 0.0 : 0.5) : (z0.im.hi > 0 ? 0.25 : -0.25);
  const double ratio = along ? (z0.im / z0.re).hi : -(z0.re / z0.im).hi;
  c.start_z = quadrant + math::atan(ratio) * 0.15915494309189535;
  using M = Monomials;
  const M N1r(a.cosh, -1, false, M::W, 1), N1i(a.sinh, -1, false, M::V, -m.sA);  // times sin z, cos z
  const M D1r(a.cosh, -1, true, M::V, 1), D1i(a.sinh, -1, true, M::W, m.sA);     // cos z, sin z
  const M N2r(b.cosh, 1, false, M::V, 1), N2i(b.sinh, 1, false, M::W, m.sB);     // cos z, sin z
  const M D2r(b.cosh, 1, true, M::W, -1), D2i(b.sinh, 1, true, M::V, m.sB);      // sin z, cos z
  const M* const parts[] = {&N1r, &N1i, &N2r, &N2i};
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 5; ++k) c.p[i][k] = parts[i]->p[k];
  // speed (conj(N1) D2 - N2 conj(D1)) + i sum_k conj(N1) N2, with sin^2 z, cos^2 z = (1 -+ X)/2
  const double half = 0.5 * c.speed;
  double even[degree_12 + 1] = {}, odd_part[degree_12 + 1] = {};
  add_product(even, half, 1, -1, N1r, D2r);
  add_product(even, -half, 1, -1, N2i, D1i);
  add_product(even, half, 1, 1, N1i, D2i);
  add_product(even, -half, 1, 1, N2r, D1r);
  add_product(even, -0.5 * c.sum_k, 1, -1, N1r, N2i);
  add_product(even, 0.5 * c.sum_k, 1, 1, N1i, N2r);
  add_product(odd_part, c.speed, 1, 0, N1r, D2i);
  add_product(odd_part, -c.speed, 1, 0, N1i, D2r);
  add_product(odd_part, c.speed, 1, 0, N2r, D1i);
  add_product(odd_part, -c.speed, 1, 0, N2i, D1r);
  add_product(odd_part, c.sum_k, 1, 0, N1r, N2r);
  add_product(odd_part, c.sum_k, 1, 0, N1i, N2i);
  for (int i = 0; i <= degree_12; ++i) c.even[i] = even[i], c.odd[i] = odd_part[i];

  motion.period = (math::pi<DD>() / nu).hi;
  motion.precession = (kA + kB + nu * DD(half_turns_of_a(m) + half_turns_of_b(m))).hi;
}

/// cos and sin of the multiples first, first + 2, first + 4, ... of an angle.
inline void multiples(Complex e, int first, DD (&cosine)[4], DD (&sine)[4]) {
  const Complex twice = e * e;
  Complex multiple = first == 0 ? Complex{DD(1.0), DD(0.0)} : e;
  for (int n = 0; n < 4; ++n, multiple = multiple * twice) cosine[n] = multiple.re, sine[n] = multiple.im;
}

inline void set_up_hyper(HeavyTopConstants& c, HeavyTopMotion& motion, const Common& m) {
  const Chain chain(m.kc, m.k);
  const bool closed = m.kc.hi > 0.0;  // else homoclinic exactly
  const DD nome = chain.nome(), speed = m.p / chain.two_K_over_pi();
  const DD scale_a = sqrt(m.cubic.mu2), scale_b = m.kc * sqrt(m.cubic.e1);
  const auto ea = math::descend_real(chain, m.A_sn / scale_a, m.A_cn / scale_a, DD(1.0), m.A_dn / scale_a);
  const auto eb = closed ? math::descend_real(chain, m.B_sn / scale_b, m.B_cn / scale_b, DD(1.0), m.B_dn / scale_b)
                         : math::RealDescent<DD>{DD(1.0), DD(0.0)};
  const Complex eta_a = unit({ea.X, DD(m.sA) * ea.Y}), eta_b = unit({eb.X, DD(m.sB) * eb.Y});
  DD cos_a[4], sin_a[4], cos_b[4], sin_b[4];
  multiples(eta_a, 1, cos_a, sin_a);
  multiples(eta_b, 0, cos_b, sin_b);
  const auto sums = [&](double sg, DD E, DD g) {
    return exact::heavy_top_hyper_sums<DD>(cos_a, sin_a, cos_b, sin_b, nome, DD(sg), E, g);
  };
  const auto theta = [&](DD E, DD g, double sg, DD* slope) {  // of the same argument, times E
    DD u = DD(1.0), d = E * E, sum = u + d, q_n = nome;
    *slope = DD(sg) * (u - d);
    for (int n = 1; n < 5; ++n) {
      u = u * g * q_n;
      d = d * q_n * nome * E * E;
      q_n = q_n * nome * nome;
      sum = sum + (u + d);
      *slope = *slope + DD((2.0 * n + 1.0) * sg) * (u - d);
    }
    return sum;
  };
  DD unused;

  // the highest point (v = vK, e^-vK = sqrt q') and the lowest (v = 0)
  const DD E_high = root_of(nome);
  const auto high = sums(1.0, E_high, DD(closed ? 1.0 : 0.0)), low = sums(1.0, DD(1.0), nome);
  const Complex high1{high.n1_re, high.n1_im};
  const Complex slope1 = Complex{high.d1_re, high.d1_im} * conj(high1);
  const DD kA = m.rate_a - speed * slope1.im / (squared(high1.re) + squared(high1.im));
  const DD kB = m.rate_b - speed * low.d2_im / low.n2_re;
  const DD theta_high = theta(E_high, DD(closed ? 1.0 : 0.0), 1.0, &unused);
  const DD ca = sqrt(math::scaled(m.cubic.mu2, 0.5)) * theta_high / norm(high1);
  const DD cb = sqrt(math::scaled(m.cubic.e1, 0.5)) * theta(DD(1.0), nome, 1.0, &unused) / abs(low.n2_re);

  const auto end = math::descend_imaginary(chain, m.sn.hi < 0.0 ? -m.sn : m.sn, m.cn, m.dn);
  const DD E0 = end.exp_minus();
  const double side = m.sn.hi < 0.0 ? -1.0 : 1.0;
  const DD g0 = nome.hi > 1e-290 ? nome / (E0 * E0) : DD(0.0);
  const auto first = sums(side, E0, g0);
  AtStart f{{first.n1_re, first.n1_im}, {first.d1_re, first.d1_im}, {first.n2_re, first.n2_im},
            {first.d2_re, first.d2_im}, DD(0.0), DD(0.0), false, false};
  f.by_slope_1 = size2(f.N1) < 0.01 * size2(f.D1), f.by_slope_2 = size2(f.N2) < 0.01 * size2(f.D2);
  f.theta = theta(E0, g0, side, &f.d_theta);
  set_factors(c, m.start, ca, cb, kA, kB, speed, f);

  const DD v0 = DD(-side) * logarithm(E0);
  c.hyper = true;
  c.rate_a = in_cycles(kA), c.rate_b = in_cycles(kB);
  c.v_rate_hi = speed.hi, c.v_rate_lo = speed.lo;
  c.v_start_hi = v0.hi, c.v_start_lo = v0.lo;
  c.nome = nome.hi;
  for (int n = 0; n < 4; ++n) {
    c.cos_a[n] = cos_a[n].hi, c.sin_a[n] = sin_a[n].hi, c.cos_b[n] = cos_b[n].hi, c.sin_b[n] = sin_b[n].hi;
  }
  motion.period = infinity;
  motion.precession = no_number;
  if (!closed) return;

  const DD passage = -logarithm(nome);  // 2 vK
  const DD rate = speed / passage, half = math::scaled(math::pi<DD>(), 0.5);
  c.v_passage_hi = passage.hi, c.v_passage_lo = passage.lo;
  c.rate_z = {rate.hi, rate.lo};
  c.start_z = (v0 / passage).hi;
  // each passage rotates alpha and beta by -2 eta; the half turn keeps the sign of the quaternion continuous
  const DD angle_a = angle_of(eta_a.im, eta_a.re), angle_b = angle_of(eta_b.im, eta_b.re);
  const DD pass_a = DD(m.sA) * half - angle_a, pass_b = DD(m.sB) * half - angle_b;
  c.passage_a = in_cycles(pass_a + pass_a), c.passage_b = in_cycles(pass_b + pass_b);
  motion.period = (DD(1.0) / rate).hi;
  const DD angle = DD(half_turns_of_a(m) + half_turns_of_b(m)) * half - angle_a - angle_b;
  motion.precession = (kA + kB + rate * (angle + angle)).hi;
}

/// Constant tilt: only the phases of alpha and beta change. It is the trig form with z fixed at a quarter cycle.
inline void set_up_steady(HeavyTopConstants& c, HeavyTopMotion& motion, const HeavyTopStart& s, const TiltStart& t) {
  const DD kA = math::scaled(s.w3 - t.a + (t.op.hi > 0.0 ? t.ab / t.op : DD(0.0)), 0.5);
  const DD kB = math::scaled(t.a - s.w3 + (t.om.hi > 0.0 ? t.ba / t.om : DD(0.0)), 0.5);
  c.hyper = false;
  c.rate_a = in_cycles(kA), c.rate_b = in_cycles(kB);
  c.start_z = 0.25;
  c.p[0][0] = 1.0, c.p[3][0] = 1.0;  // N1 = 1, N2 = i
  c.even[0] = -(kA + kB).hi;         // i sum_k conj(N1) N2
  const Complex a{s.w, s.z}, b{s.y, -s.x}, ab = conj(a) * b;
  c.ca_re = a.re.hi, c.ca_im = a.im.hi, c.cb_re = b.re.hi, c.cb_im = b.im.hi;
  c.w12_re = 2.0 * ab.re.hi, c.w12_im = 2.0 * ab.im.hi;
  c.sum_k = (kA + kB).hi;
  motion.sin_low = motion.sin_high = root_of(t.om).hi;
  motion.cos_low = motion.cos_high = root_of(t.op).hi;
  motion.period = 0.0;
  const bool vertical = t.om.hi == 0.0 || t.op.hi == 0.0;
  motion.precession = vertical ? no_number : (kA + kB).hi;
  motion.kind = t.om.hi == 0.0   ? TopKind::sleeping
                : t.op.hi == 0.0 ? TopKind::hanging
                                 : TopKind::steady_precession;
}

inline TopKind kind_of(const HeavyTopStart& s, const TiltStart& t, const TiltCubic& cubic, DD kc) {
  if (kc.hi == 0.0) return TopKind::homoclinic;
  if (s.w3.hi == 0.0) {
    const bool planar = t.sv.hi * t.sv.hi <= 1e-31 * t.wp2.hi;
    return planar ? TopKind::planar_pendulum : TopKind::spherical_pendulum;
  }
  if (t.ab.hi == 0.0 || t.ba.hi == 0.0) return TopKind::monotone;  // through the vertical: phi' = a / (1 +- u)
  // phi' has the sign of b - a u, at the turning points
  const DD high = t.sv - t.a * cubic.d2, low = t.sv - t.a * cubic.d1;
  const double size = abs(t.sv.hi) + abs(t.a.hi) * (abs(cubic.d1.hi) + abs(cubic.d2.hi));
  if (abs(high.hi) <= 4e-16 * size) return TopKind::cuspidal;
  return (high.hi < 0.0) == (low.hi < 0.0) ? TopKind::monotone : TopKind::looping;
}

inline void set_up_top(const HeavyTopStart& given, HeavyTopConstants& c, HeavyTopMotion& motion) {
  HeavyTopStart s = given;
  const DD n = sqrt(squared(s.x) + squared(s.y) + squared(s.z) + squared(s.w));
  s.x = s.x / n, s.y = s.y / n, s.z = s.z / n, s.w = s.w / n;

  const TiltStart given_tilt(s);
  const Enlargement enlargement(s, given_tilt, motion);
  if (motion.lost_within > 0.0) return;
  const TiltStart t(s);
  motion.energy = math::scaled(s.A * given_tilt.wp2 + s.C * s.w3 * s.w3, 0.5) + s.M * given_tilt.u0;
  motion.p_phi = s.A * (given_tilt.sv + given_tilt.a * given_tilt.u0);
  motion.p_psi = s.C * s.w3;
  c.w3 = s.w3.hi;
  if (t.c0.hi == 0.0 && t.c1.hi == 0.0) {
    set_up_steady(c, motion, s, t);
  } else {
    const TiltCubic cubic(t);
    const DD E = cubic.E, D = cubic.D;
    const DD k = root_of(t.bt * D / E), kc = root_of(cubic.kc2_E / E);
    const Common m{
        .start = s, .cubic = cubic, .k = k, .kc = kc, .p = math::scaled(sqrt(E), 0.5),
        .sn = DD(sign(t.du0)) * root_of(-cubic.d1 / D), .cn = root_of(cubic.d2 / D), .dn = root_of(cubic.e3 / E),
        .A_sn = root_of(cubic.mu1), .A_cn = sqrt(D), .A_dn = root_of(D * cubic.m3 / E),
        .B_sn = root_of(cubic.x2), .B_cn = root_of(D * cubic.X3 / E), .B_dn = kc * sqrt(D),
        .rate_a = math::scaled(s.w3 - t.a + cubic.ab / cubic.mu2, 0.5),
        .rate_b = math::scaled(t.a - s.w3 + cubic.ba / cubic.e1, 0.5),
        .sA = sign(cubic.ab), .sB = sign(cubic.ba)};
    if (k.hi * k.hi <= 0.97) {
      set_up_trig(c, motion, m);
    } else {
      set_up_hyper(c, motion, m);
    }
    motion.sin_low = root_of(cubic.e1).hi, motion.cos_low = root_of(cubic.mu1).hi;
    motion.sin_high = root_of(cubic.x2).hi, motion.cos_high = root_of(cubic.mu2).hi;
    motion.kind = kind_of(s, t, cubic, kc);
  }
  enlargement.undo(c, motion);
  if (s.M.hi == 0.0) motion.kind = TopKind::free;
}

}  // namespace polhode::POLHODE_ISA
