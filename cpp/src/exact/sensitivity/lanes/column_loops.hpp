#pragma once

#include "exact/lanes/free_bodies.hpp"
#include "exact/sensitivity/columns_hyper.hpp"
#include "exact/sensitivity/kernels.hpp"
#include "exact/sensitivity/lanes/series_loops.hpp"
#include "exact/sensitivity/lanes/store_rows.hpp"

// The columns of one body at many times, and the constants of many bodies, for one lane type `Wide`.
namespace polhode::POLHODE_ISA {

using exact::BodyColumns, exact::ColumnTarget, exact::FreeColumns, exact::Integrals;

/// d omega and the small rotation of the attitude of the columns of one group, in the caller's frames.
template <class T>
struct ColumnGroup {
  T omega[3][3], theta[3][3];  ///< row, column
};

/// The functions of Jacobi and the first two rows of the rotation to the working space axes.
template <class T>
struct Place {
  T cn, sn, dn, idn, omega[3], R_x[3], R_y[3];

  POLHODE_INLINE Place(const FreeColumns<double>& c, const exact::FreeState<T>& s, T sin_z, T cos_z) {
    const T steady(c.steady);
    cn = madd(steady, cos_z, T(c.cn_of) * s.omega[0]);
    sn = madd(steady, sin_z, T(c.sn_of) * s.omega[1]);
    dn = T(c.dn_of) * s.omega[2];
    idn = T(1.0) / dn;
    for (int a = 0; a < 3; ++a) omega[a] = s.omega[a];
    const T x2 = s.x + s.x, y2 = s.y + s.y, z2 = s.z + s.z;
    R_x[0] = T(1.0) - madd(y2, s.y, z2 * s.z), R_x[1] = madd(x2, s.y, -(z2 * s.w)), R_x[2] = madd(x2, s.z, y2 * s.w);
    R_y[0] = madd(x2, s.y, z2 * s.w), R_y[1] = T(1.0) - madd(x2, s.x, z2 * s.z), R_y[2] = madd(y2, s.z, -(x2 * s.w));
  }
};

template <class T>
POLHODE_INLINE void rotate_into(const double* matrix, const T (&v)[3], T (&rows)[3][3], int column) {
  for (int r = 0; r < 3; ++r) {
    const double* m = matrix + 3 * r;
    rows[r][column] = madd(T(m[0]), v[0], madd(T(m[1]), v[1], T(m[2]) * v[2]));
  }
}

/// The small rotation in working space axes, from dL there, the change dm of the momentum in working body axes, and
/// the angle about the momentum.
template <class T>
POLHODE_INLINE void theta_of(const FreeColumns<double>& c, const Place<T>& at, double dL_x, double dL_y,
                             const T (&dm)[3], T psi, T (&theta)[3]) {
  const T x = madd(at.R_x[0], dm[0], madd(at.R_x[1], dm[1], at.R_x[2] * dm[2]));
  const T y = madd(at.R_y[0], dm[0], madd(at.R_y[1], dm[1], at.R_y[2] * dm[2]));
  const T inverse(1.0 / c.L);
  theta[0] = (y - T(dL_y)) * inverse, theta[1] = (T(dL_x) - x) * inverse, theta[2] = psi;
}

template <class T>
POLHODE_INLINE void rate_columns(const BodyColumns& b, const Place<T>& at, const Integrals<T>& I, T t,
                                 ColumnGroup<T>& out) {
  const FreeColumns<double>& c = b.c;
  const T sd = at.sn * at.dn, cd = at.cn * at.dn, kap_sc = T(c.kap) * at.sn * at.cn;
  const T cn2 = at.cn * at.cn, sn2 = at.sn * at.sn, inverse_root(c.root_r_inverse);
  for (int k = 0; k < 3; ++k) {
    const auto& r = c.rates[k];
    const T U = madd(T(r.U_w), I.w, madd(-T(r.U_I), I.I, T(r.U)));
    const T dm[3] = {madd(at.cn, T(r.x), -(sd * U)), madd(at.sn, T(r.x), cd * U) * inverse_root,
                     madd(madd(T(r.Q), cn2, madd(-T(r.R), sn2, T(r.P))), at.idn, -(kap_sc * U))};
    const T w[3] = {dm[0] * T(1.0 / c.J[0]), dm[1] * T(1.0 / c.J[1]), dm[2] * T(1.0 / c.J[2])};
    T theta[3];
    theta_of(c, at, r.dL_x, r.dL_y, dm, t * T(r.psi), theta);
    rotate_into(b.omega, w, out.omega, k);
    rotate_into(b.theta, theta, out.theta, k);
  }
}

template <class T>
POLHODE_INLINE void moment_columns(const BodyColumns& b, const Place<T>& at, const Integrals<T>& I, T t,
                                   ColumnGroup<T>& out) {
  const FreeColumns<double>& c = b.c;
  const T sd = at.sn * at.dn, cd = at.cn * at.dn, k_sc = T(c.k2) * at.sn * at.cn;
  const T cn2 = at.cn * at.cn, sn2 = at.sn * at.sn, cn02(c.cn0 * c.cn0), sn02(c.sn0 * c.sn0);
  // sn^2 - sn0^2 from the smaller pair
  const T difference = select(cn2 + cn02 < sn2 + sn02, (T(c.cn0) - at.cn) * (T(c.cn0) + at.cn),
                              (at.sn - T(c.sn0)) * (at.sn + T(c.sn0)));
  const T X = madd(cn02, t, -I.C_over_p);
  for (int k = 0; k < 2; ++k) {
    const auto& m = c.moments[k];
    const T Y = madd(T(m.rate), I.w, madd(-T(m.of_I), I.I, T(m.mu_start)));
    const T bracket = madd(T(m.of_cn2), cn2, madd(T(m.of_sn2), sn2, T(m.of_difference) * difference));
    const T w[3] = {T(c.La1 / c.J[0]) * madd(at.cn, T(m.mu) * sn02, -(sd * Y)),
                    T(c.La1 * c.root_r_inverse / c.J[1]) * madd(cd, Y, -(at.sn * (T(m.mu) * cn02))),
                    T(c.La3 / c.J[2]) * madd(bracket, at.idn, -madd(k_sc, Y, T(m.rho_G) * at.dn))};
    const double* own = b.is_own[k];
    const T now = madd(T(own[0]), at.omega[0], madd(T(own[1]), at.omega[1], madd(T(own[2]), at.omega[2], T(0.0))));
    const T dm[3] = {madd(T(c.J[0]), w[0], T(own[0]) * now), madd(T(c.J[1]), w[1], T(own[1]) * now),
                     madd(T(c.J[2]), w[2], T(own[2]) * now)};
    T theta[3];
    theta_of(c, at, b.dL_x[k], b.dL_y[k], dm, T(m.psi) * X, theta);
    rotate_into(b.omega_moment, w, out.omega, k);
    rotate_into(b.theta_moment, theta, out.theta, k);
  }
  for (int r = 0; r < 3; ++r) {
    out.omega[r][2] = madd(T(b.share[0]), out.omega[r][0], T(b.share[1]) * out.omega[r][1]);
    out.theta[r][2] = madd(T(b.share[0]), out.theta[r][0], T(b.share[1]) * out.theta[r][1]);
  }
}

/// Stores the columns of a group for the lanes.
template <class T>
POLHODE_INLINE void store_group(const ColumnGroup<T>& group, const ColumnTarget& to, std::size_t first,
                                const std::size_t (&column)[3]) {
  double buffer[T::width];
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = r * to.width + column[k];
      group.omega[r][k].store(buffer);
      for (std::size_t i = 0; i < T::width; ++i) to.d_omega[(first + i) * 3 * to.width + at] = buffer[i];
      group.theta[r][k].store(buffer);
      for (std::size_t i = 0; i < T::width; ++i) to.d_attitude[(first + i) * 3 * to.width + at] = buffer[i];
    }
  }
}

template <class T>
POLHODE_INLINE void write_columns(const BodyColumns& b, const Place<T>& at, const Integrals<T>& I, T t,
                                  const ColumnTarget& to, std::size_t first) {
  ColumnGroup<T> group;
  if (to.rates >= 0 && to.moments >= 0 && to.width == 6) {
    // The usual six columns: whole rows, transposed.
    T omega[18], theta[18];
    rate_columns(b, at, I, t, group);
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t to_place = i / 3 * 6 + static_cast<std::size_t>(to.rates) + i % 3;
      omega[to_place] = group.omega[i / 3][i % 3], theta[to_place] = group.theta[i / 3][i % 3];
    }
    moment_columns(b, at, I, t, group);
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t to_place = i / 3 * 6 + static_cast<std::size_t>(to.moments) + b.place[i % 3];
      omega[to_place] = group.omega[i / 3][i % 3], theta[to_place] = group.theta[i / 3][i % 3];
    }
    store_rows(to.d_omega + 18 * first, omega);
    store_rows(to.d_attitude + 18 * first, theta);
    return;
  }
  if (to.rates >= 0) {
    rate_columns(b, at, I, t, group);
    const auto r = static_cast<std::size_t>(to.rates);
    store_group(group, to, first, {r, r + 1, r + 2});
  }
  if (to.moments >= 0) {
    moment_columns(b, at, I, t, group);
    const auto m = static_cast<std::size_t>(to.moments);
    store_group(group, to, first, {m + b.place[0], m + b.place[1], m + b.place[2]});
  }
}

template <class T>
POLHODE_INLINE void columns_at(const exact::FreeTrig<double>& body, const BodyColumns& b, const double* times,
                               const ColumnTarget& to, std::size_t first) {
  const T t = T::load(times + first) * T(b.time_scale);
  T s, c, ks, kc;
  sincos_cycles(few_cycles(t, T(body.nu_hi), T(body.nu_lo), T(body.phi0)), s, c);
  sincos_cycles(few_cycles(t, T(body.kappa_hi), T(body.kappa_lo), T(0.0)), ks, kc);
  const auto state = exact::evaluate(body, exact::evaluate_pair(body, s, c), s, c, ks, kc);
  const Place<T> at(b.c, state, c, -s);
  write_columns(b, at, exact::integrate_trig(b.c, t, s, c), t, to, first);
}

template <class T>
POLHODE_INLINE void columns_at(const exact::FreeHyper<double>& body, const BodyColumns& b, const double* times,
                               const ColumnTarget& to, std::size_t first) {
  const T t = T::load(times + first) * T(b.time_scale);
  const auto passage = exact::evaluate_passage(body, t);
  const Place<T> at(b.c, exact::evaluate(body, passage), T(0.0), T(0.0));
  write_columns(b, at, exact::integrate_hyper(b.c, body, t, passage, at.cn), t, to, first);
}

template <class Body>
void columns_loop(const Body& body_in, const BodyColumns& b_in, const double* t, std::size_t n,
                  const ColumnTarget& to) {
  const Body body = body_in;  // copies, which writing the results cannot change
  const BodyColumns b = b_in;
  std::size_t i = 0;
  for (; i + Wide::width <= n; i += Wide::width) columns_at<Wide>(body, b, t, to, i);
  for (; i < n; ++i) columns_at<One>(body, b, t, to, i);
}

inline void trig_columns(const exact::FreeTrig<double>& body, const BodyColumns& b, const double* t, std::size_t n,
                         const ColumnTarget& to) {
  columns_loop(body, b, t, n, to);
}

inline void hyper_columns(const exact::FreeHyper<double>& body, const BodyColumns& b, const double* t, std::size_t n,
                          const ColumnTarget& to) {
  columns_loop(body, b, t, n, to);
}

template <class T>
POLHODE_INLINE void start_integrals(const exact::FreeTrig<T>& trig, FreeColumns<T>& columns) {
  T s, c;
  sincos_cycles(trig.phi0 - rint(trig.phi0), s, c);
  const auto osc = exact::oscillate(columns, T(-2.0) * s * c, (s - c) * (s + c));
  columns.osc_start = osc.of_sd, columns.osc_cn_start = osc.of_cn;
}

inline void prepare_columns(const exact::FreeConstants<double>& constants, const exact::FreeTrig<double>* trig,
                            const exact::FreeHyper<double>* hyper, FreeColumns<double>& columns) {
  exact::FreeConstants<One> f;
  __builtin_memcpy(static_cast<void*>(&f), &constants, sizeof f);
  FreeColumns<One> c;
  __builtin_memset(static_cast<void*>(&c), 0, sizeof c);
  exact::set_up_columns(f, c);
  if (trig) {
    exact::FreeTrig<One> body;
    __builtin_memcpy(static_cast<void*>(&body), trig, sizeof body);
    exact::set_up_integrals_trig(f, c);
    start_integrals(body, c);
  } else {
    exact::FreeHyper<One> body;
    __builtin_memcpy(static_cast<void*>(&body), hyper, sizeof body);
    exact::set_up_integrals_hyper(f, body, c);
  }
  __builtin_memcpy(static_cast<void*>(&columns), &c, sizeof c);
}

/// Copies a struct of lanes to structs of numbers.
template <class Lanes, class Numbers>
POLHODE_INLINE void to_rows(const Lanes& lanes, Numbers* rows, std::size_t count) {
  constexpr std::size_t width = sizeof(Lanes) / sizeof(Numbers);
  const auto* from = reinterpret_cast<const double*>(&lanes);
  for (std::size_t i = 0; i < count; ++i) {
    auto* to = reinterpret_cast<double*>(rows + i);
    for (std::size_t k = 0; k < sizeof(Numbers) / sizeof(double); ++k) to[k] = from[k * width + i];
  }
}

inline std::size_t set_up_bodies(FreeStarts starts, std::size_t n, FreeTrig<double>* trig, FreeFrame* frames,
                                 FreeColumns<double>* columns, double* speeds, std::size_t* left) {
  constexpr std::size_t width = Two::width;
  std::size_t count = 0;
  for (std::size_t first = 0; first < n; first += width) {
    const Pick pick{nullptr, first, n};
    const Block<Two> block = read_block<Two>(starts, pick);
    const FreeTrig<Two> body = exact::set_up_trig(block.constants);
    FreeColumns<Two> c;
    c.period = c.nome = c.nome_over_kc2 = c.u_of_v = c.K = Two(0.0);
    c.passage_start = c.passages_cn_start = c.u_start = c.u_cn_start = Two(0.0);
    exact::set_up_columns(block.constants, c);
    exact::set_up_integrals_trig(block.constants, c);
    start_integrals(body, c);
    const std::size_t rows = n - first < width ? n - first : width;
    to_rows(body, trig + first, rows);
    to_rows(make_frame(block, exact::evaluate(body, Two(0.0))), frames + first, rows);
    to_rows(c, columns + first, rows);
    for (std::size_t a = 0; a < 3; ++a) {
      double w[width];
      block.constants.start.w[a].store(w);
      for (std::size_t i = 0; i < rows; ++i) speeds[3 * (first + i) + a] = w[i];
    }
    for (std::size_t i = 0; i < rows; ++i)
      if ((block.neither | block.hyper) >> i & 1u) left[count++] = first + i;
  }
  return count;
}

inline constexpr exact::FreeColumnsKernels column_kernels = {.set_up = &set_up_bodies,
                                                             .prepare = &prepare_columns,
                                                             .trig = &trig_columns,
                                                             .hyper = &hyper_columns,
                                                             .make_series = &make_series,
                                                             .sum_series = &sum_series};

}  // namespace polhode::POLHODE_ISA
