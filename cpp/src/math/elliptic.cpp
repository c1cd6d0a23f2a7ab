#include "polhode/math/elliptic.hpp"

#include <limits>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/math/detail/landen.hpp"

// Theta quotients (dlmf.nist.gov 22.2) with nome q where m <= 0.97, and the same after Poisson's transformation, in
// powers of e^-|v| with the nome q' of m1, elsewhere. Both converge in a few terms and cancel nowhere but at zeros.
namespace polhode::elliptic {
namespace {

using math::DD;

const DD one(1.0);

/// The arithmetic-geometric mean of 1 and x.
DD agm(DD x) {
  DD a(1.0), b = x;
  for (bool near = false;;) {
    const DD mean = math::scaled(a + b, 0.5);
    if (near) return mean;  // a and b agree to 1e-17 here, their mean and the limit to 1e-35
    near = std::abs(a.hi - b.hi) < 1e-8 * a.hi;
    b = sqrt(a * b);
    a = mean;
  }
}

struct ThetaConstants {
  DD t2, t3, t4;  ///< theta_2 / (2 q^(1/4)), theta_3, theta_4 at 0
};

ThetaConstants theta_constants(DD q) {
  ThetaConstants c{one, one, one};
  DD odd = one, square = q, power = q;  // q^(n(n+1)), q^(n^2), q^n
  for (int n = 1; n <= 7; ++n) {
    odd = odd * power * power;
    c.t2 = c.t2 + odd;
    c.t3 = c.t3 + square + square;
    c.t4 = n % 2 ? c.t4 - (square + square) : c.t4 + (square + square);
    square = square * power * power * q;
    power = power * q;
  }
  return c;
}

void check(double m, double m1) {
  const auto in_range = [](double x) { return x >= 0.0 && x <= 1.0; };
  if (!in_range(m)) throw InvalidInput("m", "in [0, 1]", to_text(m));
  if (!in_range(m1)) throw InvalidInput("m1", "in [0, 1]", to_text(m1));
  if (std::abs((m + m1) - 1.0) > 4 * std::numeric_limits<double>::epsilon()) {
    throw InvalidInput("m1", "1 - m to rounding", "m + m1 = " + to_text(m + m1));
  }
}

}  // namespace

Parameter::Parameter(double m, double m1) {
  check(m, m1);
  const DD m_dd = m <= m1 ? DD(m) : one - DD(m1), m1_dd = m <= m1 ? one - DD(m) : DD(m1);
  const DD k = sqrt(m_dd), kc = sqrt(m1_dd);
  m_ = m_dd.hi;
  hyper_ = m1_dd.hi < 0.03;
  const math::LandenChain<DD> chain = hyper_ ? math::LandenChain<DD>(kc, k) : math::LandenChain<DD>(k, kc);
  q_ = chain.nome();
  const ThetaConstants t = theta_constants(q_);
  if (!hyper_) {
    K_ = math::scaled(math::pi<DD>(), 0.5) * chain.two_K_over_pi();
    nome_ = q_.hi;
    sn_factor_ = t.t3 / t.t2;
    cn_factor_ = t.t4 / t.t2;
    dn_factor_ = t.t4 / t.t3;
    return;
  }
  v_rate_ = one / chain.two_K_over_pi();  // v = pi u / 2K'
  sn_factor_ = t.t3 / t.t4;
  cn_factor_ = math::scaled(t.t2 / t.t4, 2.0);
  dn_factor_ = math::scaled(t.t2 / t.t3, 2.0);
  if (m1_dd.hi == 0.0) {
    K_ = DD(std::numeric_limits<double>::infinity());
    nome_ = 1.0;
    return;
  }
  K_ = math::scaled(math::pi<DD>(), 0.5) / agm(kc);
  v_K_ = K_ * v_rate_;
  nome_ = math::exp(-(math::pi<DD>() * math::pi<DD>() * math::scaled(chain.two_K_over_pi() / K_, 0.5))).hi;
}

Jacobi Parameter::jacobi(double u) const {
  if (!(std::abs(u) <= 1e15 * K_.hi) || std::isinf(u)) throw InvalidInput("u", "finite and at most 1e15 K", to_text(u));
  if (std::isinf(K_.hi)) return from_exponential(DD(std::abs(u)), u);
  const double n = math::rint(u / (2.0 * K_.hi));
  const DD rest = DD(u) - math::scaled(K_, 2.0) * DD(n);
  Jacobi j{};
  if (std::abs(rest.hi) < 1e-9) {
    // sn u = u - (1 + m) u^3 / 6 + ...
    const double r = rest.hi;
    j = {r - (1.0 + m_) * r * r * r / 6.0, 1.0 - 0.5 * r * r, 1.0 - 0.5 * m_ * r * r};
  } else if (hyper_) {
    j = from_exponential(abs(rest) * v_rate_, rest.hi);
  } else {
    j = from_cycles(rest / K_ * math::scaled(math::pi<DD>(), 0.5));
  }
  if (std::fmod(n, 2.0) != 0.0) j.sn = -j.sn, j.cn = -j.cn;
  return j;
}

/// z = pi u / 2K in [-pi/2, pi/2].
Jacobi Parameter::from_cycles(DD z) const {
  const math::SinCos sc = math::sincos(z);
  const DD two_x = math::scaled((sc.cos - sc.sin) * (sc.cos + sc.sin), 2.0);  // 2 cos 2z
  // cos 2nz, cos (2n+1)z / cos z, sin (2n+1)z / sin z by the same recurrence from different starts.
  DD T0 = one, T1 = math::scaled(two_x, 0.5), V0 = one, V1 = two_x - one, W0 = one, W1 = two_x + one;
  DD theta1 = one, theta2 = one, theta3 = one, theta4 = one, odd = one, square = q_, power = q_;
  for (int n = 1; n <= 5; ++n) {
    odd = odd * power * power;
    const DD even = math::scaled(square * T1, 2.0);
    theta1 = n % 2 ? theta1 - odd * W1 : theta1 + odd * W1;
    theta2 = theta2 + odd * V1;
    theta3 = theta3 + even;
    theta4 = n % 2 ? theta4 - even : theta4 + even;
    square = square * power * power * q_;
    power = power * q_;
    const DD T2 = two_x * T1 - T0, V2 = two_x * V1 - V0, W2 = two_x * W1 - W0;
    T0 = T1, T1 = T2, V0 = V1, V1 = V2, W0 = W1, W1 = W2;
  }
  return {(sn_factor_ * sc.sin * theta1 / theta4).hi, (cn_factor_ * sc.cos * theta2 / theta4).hi,
          (dn_factor_ * theta3 / theta4).hi};
}

/// v = pi |u| / 2K' up to pi K / 2K' (without end for m1 = 0); the sign is u's.
Jacobi Parameter::from_exponential(DD v, double sign) const {
  const DD E = math::exp(-v);
  const DD g = std::isinf(K_.hi) ? DD(0.0) : math::exp(v - math::scaled(v_K_, 2.0));  // q' / E
  // u_n = g^n q'^{n(n-1)/2}, d_n = E^{n+1} q'^{n(n+1)/2}
  const DD u1 = g, u2 = g * g * q_, u3 = u2 * g * q_ * q_, d0 = E, d1 = E * E * q_, d2 = d1 * E * q_ * q_;
  const DD D = one + d0 * d0 + u1 * u1 + d1 * d1 + u2 * u2 + d2 * d2;
  const DD V = ((one - d0) * (one + d0) - u1 * u1 + d1 * d1) + (u2 * u2 - d2 * d2);
  const DD near = u1 + d1 * d0, far = u2 * u1 + d2 * d1, last = u3 * u2;
  const DD Wp = E + near + far + last, Wm = (E - u1) - d1 * d0 + far - last;
  return {std::copysign((sn_factor_ * V / D).hi, sign), (cn_factor_ * Wm / D).hi, (dn_factor_ * Wp / D).hi};
}

Jacobi jacobi(double u, double m, double m1) { return Parameter(m, m1).jacobi(u); }
double K(double m, double m1) { return Parameter(m, m1).K(); }
double nome(double m, double m1) { return Parameter(m, m1).nome(); }

}  // namespace polhode::elliptic
