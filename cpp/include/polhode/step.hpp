// polhode/step.hpp: the exact free motion of a rigid body over one fixed step, for engines and particle codes.
//
// This file needs nothing but <cmath> and C++17: copy it into any code base. docs/step.md explains its use.
//
//   using namespace polhode::step;
//   const auto body = make_inertia(0.2, 0.4, 0.5);   // principal moments, in any order
//   kick(L, torque, h / 2);                          // L and torque in space
//   drift_space(body, h, L, q);                      // q: attitude (x, y, z, w), principal axes to space
//   kick(L, torque, h / 2);                          // torque at the new attitude
//
// A drift keeps kinetic energy, |L| and L in space at any step. Its error per step is of order 2 N + 3 in h; N = 3 for
// float and 5 for double unless given. T is float, double, a GCC or Clang vector of them, or a type with its own Ops.
// -ffast-math is harmless: nothing depends on infinities, NaN or the order of sums, but for last bits.
//
// Copyright (c) 2026, the polhode developers. SPDX-License-Identifier: BSD-3-Clause
// Redistribution and use in source and binary forms, with or without modification, are permitted provided that the
// following conditions are met: 1. Redistributions of source code must retain the above copyright notice, this list of
// conditions and the following disclaimer. 2. Redistributions in binary form must reproduce the above copyright notice,
// this list of conditions and the following disclaimer in the documentation and/or other materials provided with the
// distribution. 3. Neither the name of the copyright holder nor the names of its contributors may be used to endorse or
// promote products derived from this software without specific prior written permission. THIS SOFTWARE IS PROVIDED BY
// THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS" AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO,
// THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN NO EVENT SHALL THE
// COPYRIGHT HOLDER OR CONTRIBUTORS BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL
// DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF USE, DATA, OR PROFITS;
// OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY, OR
// TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS SOFTWARE, EVEN IF ADVISED OF THE
// POSSIBILITY OF SUCH DAMAGE.
#pragma once

#include <cmath>
#if defined(__CUDACC__)
#define POLHODE_STEP __host__ __device__ inline
#elif defined(__GNUC__)
#define POLHODE_STEP __attribute__((always_inline)) inline
#else
#define POLHODE_STEP inline
#endif

namespace polhode::step {

/// What a number type needs beside + - * /. These serve float and double.
template <class T>
struct ScalarOps {
  static constexpr bool scalar = true, single = sizeof(T) == sizeof(float);   ///< single: 24 bits of mantissa, else 53
  static POLHODE_STEP T set(double x) { return static_cast<T>(x); }           ///< a constant
  static POLHODE_STEP T madd(T a, T b, T c) { return a * b + c; }             ///< fused or not
  static POLHODE_STEP T pick(T a, T b, T x, T y) { return a < b ? x : y; }
  static POLHODE_STEP T nearest(T x) { return static_cast<T>(static_cast<int>(x + (x < 0 ? T(-0.5) : T(0.5)))); }
  static POLHODE_STEP T root(T x) { return std::sqrt(x); }
  static POLHODE_STEP T inverse_root(T x) { return T(1) / std::sqrt(x); }
};

template <class T> struct Ops;   // specialise it for a type of your own
template <> struct Ops<float> : ScalarOps<float> {};
template <> struct Ops<double> : ScalarOps<double> {};

#if defined(__GNUC__) && !defined(__CUDACC__)
/// The same for GCC's and Clang's vectors, such as float __attribute__((vector_size(32))).
template <class T>
struct Ops {
  static POLHODE_STEP auto first(T x) { return x[0]; }
  using Scalar = decltype(first(T()));
  using Whole = decltype(T() < T());   // integers of the same size
  static constexpr bool scalar = false, single = sizeof(Scalar) == sizeof(float);
  static POLHODE_STEP T set(double x) { return T() + static_cast<Scalar>(x); }
  static POLHODE_STEP T madd(T a, T b, T c) { return a * b + c; }
  static POLHODE_STEP T pick(T a, T b, T x, T y) { return a < b ? x : y; }
  static POLHODE_STEP T nearest(T x) {
#if defined(__FAST_MATH__)   // which would drop the sum below
    return __builtin_convertvector(__builtin_convertvector(x + pick(x, T(), set(-0.5), set(0.5)), Whole), T);
#endif
    return x + set(single ? 0x1.8p23 : 0x1.8p52) - set(single ? 0x1.8p23 : 0x1.8p52);
  }
  static POLHODE_STEP T root(T x) { return x * inverse_root(x); }
  /// A guess from the bits, one or two steps of Halley's method and one of Newton's: faster than a division and a root.
  static POLHODE_STEP T inverse_root(T x) {
    const decltype(Whole()[0] + 0) magic = single ? 0x5f3759df : 0x5fe6eb50c7b537a9;
    T y = (T)(magic - ((Whole)x >> 1));
    for (int i = single ? 1 : 0; i < 2; ++i) {
      const T e = madd(-x * y, y, set(1));
      y = madd(y * e, madd(e, set(0.375), set(0.5)), y);
    }
    return madd(set(0.5) * y, madd(-x * y, y, set(1)), y);
  }
};
#endif

/// A parameter of this type is converted to T, which the other arguments give: a step of 1.0 / 60 serves floats too.
template <class T> struct Given { using Type = T; };
template <class T> using As = typename Given<T>::Type;
template <class T> struct Vec { T x, y, z; };
template <class T> struct Quat { T x, y, z, w; };
/// A body in its principal axes: a = largest moment over each moment, scale = 1 / largest moment.
template <class T> struct Inertia {
  T a[3], scale;
  /// The same body in another type, as from make_inertia(0.2, 0.4, 0.5) to floats, or from one body to all lanes.
  template <class U> POLHODE_STEP operator Inertia<U>() const {
    return {{Ops<U>::set(a[0]), Ops<U>::set(a[1]), Ops<U>::set(a[2])}, Ops<U>::set(scale)};
  }
};
/// A body with a full tensor in body axes B, and its principal axes P.
template <class T> struct Principal { Inertia<T> inertia; Quat<T> q_BP; };
template <class T> POLHODE_STEP T larger(T a, T b) { return Ops<T>::pick(a, b, b, a); }
template <class T> POLHODE_STEP T smaller(T a, T b) { return Ops<T>::pick(a, b, a, b); }

/// From principal moments, all positive, in any order.
template <class T> POLHODE_STEP Inertia<T> make_inertia(T I1, T I2, T I3) {
  const T most = larger(larger(I1, I2), I3);
  return {{most / I1, most / I2, most / I3}, Ops<T>::set(1) / most};
}

/// The angular velocity in principal axes, omega = I^-1 L.
template <class T> POLHODE_STEP Vec<T> rates(const Inertia<T>& body, const Vec<T>& L) {
  const T s = body.scale;
  return {body.a[0] * (s * L.x), body.a[1] * (s * L.y), body.a[2] * (s * L.z)};
}

/// L += h torque, both in the same axes. An impulse J at r from the centre of mass has h torque = r x J.
template <class T> POLHODE_STEP void kick(Vec<T>& L, const Vec<T>& torque, As<T> h) {
  L = {Ops<T>::madd(h, torque.x, L.x), Ops<T>::madd(h, torque.y, L.y), Ops<T>::madd(h, torque.z, L.z)};
}

/// R(p)^T v. What the length of p lacks to 1 is taken out, and small terms are summed first: |v| hardly drifts.
template <class T> POLHODE_STEP Vec<T> rotate_back(const Quat<T>& p, const Vec<T>& v) {
  using O = Ops<T>;
  const T ww = O::madd(-p.w, p.w, O::set(1)), two = O::set(2);
  const T k = O::madd(-p.x, p.x, O::madd(-p.y, p.y, O::madd(-p.z, p.z, ww)));
  const T x = v.y * p.z - v.z * p.y, y = v.z * p.x - v.x * p.z, z = v.x * p.y - v.y * p.x;
  const T a = O::madd(p.w, x, y * p.z - z * p.y), b = O::madd(p.w, y, z * p.x - x * p.z);
  const T c = O::madd(p.w, z, x * p.y - y * p.x), da = O::madd(k, a, a), db = O::madd(k, b, b), dc = O::madd(k, c, c);
  return {O::madd(two, da, v.x), O::madd(two, db, v.y), O::madd(two, dc, v.z)};
}

/// q p, of length 1. p is scaled first and the large terms are added last, so each component is rounded once.
template <class T> POLHODE_STEP Quat<T> compose(const Quat<T>& q, const Quat<T>& p) {
  using O = Ops<T>;
  const T s = O::madd(q.x, q.x, O::madd(q.y, q.y, O::madd(q.z, q.z, q.w * q.w))), k = O::set(0.5) - O::set(0.5) * s;
  const T x = O::madd(k, p.x, p.x), y = O::madd(k, p.y, p.y), z = O::madd(k, p.z, p.z), w = O::madd(k, p.w, p.w);
  return {O::madd(q.x, w, O::madd(q.w, x, q.y * z - q.z * y)), O::madd(q.y, w, O::madd(q.w, y, q.z * x - q.x * z)),
          O::madd(q.z, w, O::madd(q.w, z, q.x * y - q.y * x)), O::madd(q.w, w, -O::madd(q.x, x, q.y * y + q.z * z))};
}

/// A polynomial of z, the highest coefficient first.
template <int i = 1, class T, int n> POLHODE_STEP T horner(T z, const double (&c)[n], T sum) {
  if constexpr (i == n) return sum; else return horner<i + 1>(z, c, Ops<T>::madd(sum, z, Ops<T>::set(c[i])));
}

/// cos and sin of the angle modulo pi: their common sign is free. Beyond 1e6 the angle is cut off.
template <class T> POLHODE_STEP void circle(T angle, T& c, T& s) {
  using O = Ops<T>;
  const T most = O::set(1e6), x = larger(smaller(angle, most), -most);
  const T n = O::nearest(x * O::set(0.31830988618379067));
  // pi in two parts. Products with the first are exact up to 2^12 (float) and 2^20 (double) half turns.
  const T high = O::set(O::single ? 3.140625 : 3.1415926534682512), r1 = O::madd(-n, high, x);
  const T r = O::madd(-n, O::set(O::single ? 9.67653589793e-4 : 1.2154199265806587e-10), r1), z = r * r;
  // Minimax polynomials on [-pi/2, pi/2]: to 8e-9 and 4e-10 for float, to 4e-19 and 8e-18 for double.
  if constexpr (O::single) {
    constexpr double sf[] = {2.60513711e-6, -1.980994313e-4, 8.333084136e-3, -0.16666661084};
    constexpr double cf[] = {-2.60507846e-7, 2.476087712e-5, -1.3888397951e-3, 4.16666419601e-2, -0.499999996416};
    s = horner(z, sf, O::set(sf[0])), c = horner(z, cf, O::set(cf[0]));
  } else {
    constexpr double sd[] = {2.721564614418325e-15, -7.64305603346974484e-13, 1.60589434712486388e-10,
                             -2.50521069790729212e-8, 2.75573192127231413e-6, -1.98412698412215981e-4,
                             8.3333333333332396e-3, -0.166666666666666661};
    constexpr double cd[] = {4.6089589004551118e-14, -1.14629578758462289e-11, 2.08765667567583149e-9,
                             -2.75573165587862117e-7, 2.48015872802453621e-5, -1.38888888887974776e-3,
                             4.16666666666648907e-2, -0.499999999999999898};
    s = horner(z, sd, O::set(sd[0])), c = horner(z, cd, O::set(cd[0]));
  }
  s = O::madd(r * z, s, r), c = O::madd(z, c, O::set(1));
}

/// The rotation of the free body over a step h, a unit quaternion in principal axes. y = (h / 4) L / I_max.
/// Weierstrass's wp with roots -K_i gives the polhode, Lame's equation (n = 1) the angle about L: DLMF 23.9, 23.10 and
/// Whittaker & Watson, sec. 23.7. Both are series at a quarter of the step, doubled by their addition theorems. T and
/// |L| are kept for any value of the series, because f_i^2 - f_j^2 = K_i - K_j is all that the polhode uses. The
/// rotation has the form of Moser and Veselov's discrete body (Hairer & Vilmart 2006, J. Phys. A 39, 13225).
template <int N = 0, class T> POLHODE_STEP Quat<T> free_rotation(const Inertia<T>& body, const Vec<T>& y) {
  using O = Ops<T>;
  constexpr int terms = N != 0 ? N : O::single ? 3 : 5;
  static_assert(terms >= 2 && terms <= 5, "series of 2 to 5 terms");
  const auto madd = [](T a, T b, T c) { return O::madd(a, b, c); };
  const auto set = [](double x) { return O::set(x); };
  const T *a = body.a, zero = set(0), one = set(1), two = set(2), four = set(4);
  const T least = set(O::single ? 1e-30 : 1e-290);   // keeps subnormal numbers away, which are slow

  // The polhode: p_i = g_j g_k y_i^2, K_i = p_i - pm.
  const T g1 = a[2] - a[1], g2 = a[0] - a[2], g3 = a[1] - a[0];
  const T g2x = g2 * y.x, g3x = g3 * y.x, g3y = g3 * y.y, g1y = g1 * y.y, g1z = g1 * y.z, g2z = g2 * y.z;
  T pm = set(1.0 / 3) * madd(g2x, g3x, madd(g3y, g1y, madd(g1z, g2z, least)));
  T K1 = madd(g2x, g3x, -pm), K2 = madd(g3y, g1y, -pm), K3 = madd(g1z, g2z, -pm), s = one;
  T kk = madd(K1, K1, madd(K2, K2, madd(K3, K3, least)));
  // Where it rotates by more than about 1.4 rad in h / 4: a slower body on the same polhode, of moments u + s (a - u).
  bool fast = true;
  if constexpr (O::scalar) fast = two < kk;
  if (fast) {
    s = O::pick(two, kk, set(1.4142135) * O::inverse_root(kk), one);
    const T ss = s * s;
    pm = ss * pm, K1 = ss * K1, K2 = ss * K2, K3 = ss * K3, kk = madd(K1, K1, madd(K2, K2, madd(K3, K3, least)));
  }

  const T LL = madd(y.x, y.x, madd(y.y, y.y, madd(y.z, y.z, least))), r = O::inverse_root(LL), l = LL * r;
  const T ul = r * madd(a[0] * y.x, y.x, madd(a[1] * y.y, y.y, a[2] * y.z * y.z)), u = ul * r;
  const T d1 = s * (u - a[0]), d2 = s * (u - a[1]), d3 = s * (u - a[2]);
  // LLdd and G are below 4, but for the rounding of very long steps.
  const T LLdd = larger(smaller(LL * d1 * d2, four), -four), e = K3 + LLdd;
  // Below rounding the series do not count, and their powers would be subnormal.
  const T size = madd(e, e, kk), few = set(O::single ? 1e-9 : 1e-18), ek = O::pick(size, few, zero, e);
  const T Kk = O::pick(size, few, zero, K1), G0 = l * O::pick(size, few * few, zero, LLdd) * d3;
  const T G = larger(smaller(G0, four), -four), P = G * r;

  // Series at h / 4: wp in W, Lame's function in E + i H.
  const T c2 = O::pick(size, few, zero, set(0.1) * kk), c3 = set(-1.0 / 7) * (Kk * K2 * K3);
  const T m2 = set(0.5) * e, m3 = set(-1.0 / 3) * G, m4 = set(0.25) * madd(-ek, m2, c2 + c2);
  const T m5 = set(-0.1) * (ek * m3);
  T W = c2, E = m2 + m4, H = m3 + m5;
  if constexpr (terms >= 3) {
    const T m6 = set(1.0 / 18) * madd(-ek, m4, two * madd(c2, m2, c3));
    const T m7 = set(1.0 / 28) * madd(-ek, m5, two * (c2 * m3));
    T W3 = c3, E3 = m6, H3 = m7;
    if constexpr (terms >= 4) {
      const T c4 = set(1.0 / 3) * (c2 * c2), m8 = set(1.0 / 40) * madd(-ek, m6, two * madd(c2, m4, madd(c3, m2, c4)));
      const T m9 = set(1.0 / 54) * madd(-ek, m7, two * madd(c2, m5, c3 * m3));
      W3 = W3 + c4, E3 = E3 + m8, H3 = H3 + m9;
      if constexpr (terms >= 5) {
        const T c5 = set(3.0 / 11) * (c2 * c3);
        const T m10 = set(1.0 / 70) * madd(-ek, m8, two * madd(c2, m6, madd(c3, m4, madd(c4, m2, c5))));
        const T m11 = set(1.0 / 88) * madd(-ek, m9, two * madd(c2, m7, madd(c3, m5, c4 * m3)));
        W3 = W3 + c5, E3 = E3 + m10, H3 = H3 + m11;
      }
    }
    W = W + W3, E = E + E3, H = H + H3;
  }
  W = one + W, E = one + E;

  // From a quarter to half a step: f_i = N_i / (2 Pi). Products alone follow, as p needs no length.
  const T R1 = larger(W + K1, least), R2 = larger(W + K2, least), R3 = larger(W + K3, least);
  const T X = R1 * R2 * R3, Pi = O::root(X);
  const T N1 = madd(R1, R2 + R3, -(R2 * R3)), N2 = madd(R2, R3 + R1, -(R3 * R1)), N3 = madd(R3, R1 + R2, -(R1 * R2));
  const T N23 = N2 * N3, N31 = N3 * N1, N12 = N1 * N2, N0 = N12 * N3, NPi = two * s * (Pi * N0), X12 = set(12) * X;
  const T Q = madd(N1, N1, madd(N2, N2, N3 * N3)), Qe = madd(X12, e, Q), Qp = madd(-X12, pm, Q), P12 = X12 * P;
  // The phase: C + i S = (cos ul + i sin ul)^2 (E + i H)^2 (A - 2 i Pi G).
  T c, v;
  circle(ul, c, v);
  const T ec = madd(E, c, -(H * v)), es = madd(E, v, H * c), cc = madd(ec, ec, -(es * es)), cs = two * (ec * es);
  const T We = W + e, A = madd((W + W - e) * We, We, madd(G, G, -X)), B = two * (Pi * G);
  const T C = madd(A, cc, B * cs), S = set(1.5) * (r * N0) * madd(A, cs, -(B * cc)), CPi = C * Pi;
  const T CQ = CPi * Qe, CP = madd(CPi, P12, S);
  const T px = madd(N23 * N23, y.x, NPi * (g1y * y.z)) * madd(-d1, CQ, CP);
  const T py = madd(N31 * N31, y.y, NPi * (g2z * y.x)) * madd(-d2, CQ, CP);
  const T pz = madd(N12 * N12, y.z, NPi * (g3x * y.y)) * madd(-d3, CQ, CP);
  const T pw = set(1.0 / 6) * (N0 * Qp) * (Qe * C);
  const T n = O::inverse_root(madd(px, px, madd(py, py, madd(pz, pz, pw * pw))));
  return {n * px, n * py, n * pz, n * pw};
}

/// Moves the body by h: L in principal axes, q principal axes to space.
template <int N = 0, class T> POLHODE_STEP void drift_body(const Inertia<T>& body, As<T> h, Vec<T>& L, Quat<T>& q) {
  const T k = Ops<T>::set(0.25) * h * body.scale;
  const Quat<T> p = free_rotation<N>(body, Vec<T>{k * L.x, k * L.y, k * L.z});
  L = rotate_back(p, L), q = compose(q, p);
}

/// Moves the body by h: L in space, where it does not change.
template <int N = 0, class T>
POLHODE_STEP void drift_space(const Inertia<T>& body, As<T> h, const Vec<T>& L, Quat<T>& q) {
  const T k = Ops<T>::set(0.25) * h * body.scale;
  const Vec<T> y = rotate_back(q, L);
  q = compose(q, free_rotation<N>(body, Vec<T>{k * y.x, k * y.y, k * y.z}));
}

/// From a full tensor, by Jacobi's method with its rotations as quaternions. For float and double; once for each body.
template <class T> Principal<T> make_principal(T xx, T yy, T zz, T xy, T xz, T yz) {
  Quat<T> q{0, 0, 0, 1};
  T m[6] = {xx, yy, zz, yz, xz, xy};   // m[3 + k]: off the diagonal, opposite to k
  for (int step = 0; step < 24; ++step) {
    const int k = step % 3, i = (k + 1) % 3, j = (k + 2) % 3;
    const T off = m[3 + k], gap = (m[j] - m[i]) / 2;
    if (off == 0) continue;
    const T t = off / (gap + (gap < 0 ? T(-1) : T(1)) * std::sqrt(gap * gap + off * off));   // tan of the angle
    const T c = 1 / std::sqrt(1 + t * t), s = t * c, mi = m[3 + i], mj = m[3 + j], half = std::sqrt((1 + c) / 2);
    m[i] -= t * off, m[j] += t * off, m[3 + k] = 0, m[3 + i] = c * mi + s * mj, m[3 + j] = c * mj - s * mi;
    const T v = -s / (2 * half);
    q = compose(q, Quat<T>{k == 0 ? v : 0, k == 1 ? v : 0, k == 2 ? v : 0, half});
  }
  return {make_inertia(m[0], m[1], m[2]), q};
}

/// Moves a body with a full tensor: q body to space, L in space.
template <int N = 0, class T>
POLHODE_STEP void drift_space(const Principal<T>& body, As<T> h, const Vec<T>& L, Quat<T>& q) {
  const Quat<T>& b = body.q_BP;
  Quat<T> q_WP = compose(q, b);
  drift_space<N>(body.inertia, h, L, q_WP);
  q = compose(q_WP, Quat<T>{-b.x, -b.y, -b.z, b.w});
}

}  // namespace polhode::step
