#include "exact/sensitivity/body.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "exact/free_frame.hpp"
#include "exact/sensitivity/short_times.hpp"
#include "polhode/core/error.hpp"

namespace polhode::exact {
namespace {

constexpr double closed_form_from = 0.5;  // |p t|: below it the parts of the closed form cancel
constexpr double hyper_from = 0.97;       // k^2, as in FreeMotion

/// Rows of 3 numbers, `width` apart, of one sample.
struct SampleColumns {
  double *omega, *theta;
  std::size_t width;

  void put(std::ptrdiff_t column, const Vector3d& d_omega, const Vector3d& d_theta) const {
    for (std::size_t r = 0; r < 3; ++r) {
      omega[r * width + static_cast<std::size_t>(column)] = d_omega[static_cast<Eigen::Index>(r)];
      theta[r * width + static_cast<std::size_t>(column)] = d_theta[static_cast<Eigen::Index>(r)];
    }
  }
  Vector3d get(const double* rows, std::ptrdiff_t column) const {
    const auto c = static_cast<std::size_t>(column);
    return {rows[c], rows[width + c], rows[2 * width + c]};
  }
};

SampleColumns sample(const ColumnTarget& to, std::size_t i) {
  return {to.d_omega + 3 * to.width * i, to.d_attitude + 3 * to.width * i, to.width};
}

Quat quat_at(const double* attitude, std::size_t i) {
  const double* q = attitude + 4 * i;
  return {q[0], q[1], q[2], q[3]};
}

/// (R0 - R) e for the principal axes e. With the momentum m it is R (m - m0) along m0, which keeps its accuracy near a
/// steady rotation; so that of the largest component follows from the two others.
Matrix3d moved_axes(const ColumnsStart& start, const Matrix3d& R0, const Matrix3d& R, const Vector3d& w,
                    Eigen::Index last) {
  const Vector3d m0 = start.I.cwiseProduct(start.w), m = start.I.cwiseProduct(w), sum = m + m0;
  Vector3d step = start.I.cwiseProduct(w - start.w);
  const Eigen::Index b = (last + 1) % 3, c = (last + 2) % 3;
  // |m| is constant
  if (std::abs(sum[last]) > std::abs(m0[last])) step[last] = -(step[b] * sum[b] + step[c] * sum[c]) / sum[last];
  Matrix3d moved = R0 - R;
  moved.col(last) = (R * step - m0[b] * moved.col(b) - m0[c] * moved.col(c)) / m0[last];
  return moved;
}

}  // namespace

ColumnLayout::ColumnLayout(const std::vector<SensitivityTo>& wrt, RotationSide which) : side(which) {
  for (const SensitivityTo to : wrt) {
    std::ptrdiff_t* const places[] = {&omega, &attitude, &inertia, &axes, &time};
    *places[static_cast<int>(to)] = static_cast<std::ptrdiff_t>(width);
    width += to == SensitivityTo::time ? 1 : 3;
  }
}

void check_wrt(const std::vector<SensitivityTo>& wrt) {
  if (wrt.empty()) throw InvalidInput("wrt", "at least one name", "none");
  for (const SensitivityTo to : wrt)
    if (std::count(wrt.begin(), wrt.end(), to) > 1) throw InvalidInput("wrt", "each name once", "one twice");
}

std::vector<SensitivityTo> with_needed(std::vector<SensitivityTo> wrt) {
  const auto has = [&](SensitivityTo to) { return std::count(wrt.begin(), wrt.end(), to) > 0; };
  if (has(SensitivityTo::axes) && !has(SensitivityTo::omega)) wrt.push_back(SensitivityTo::omega);
  return wrt;
}

ColumnsStart make_columns_start(const FreeMotion& motion) {
  ColumnsStart start;
  const InertiaTensor& inertia = motion.inertia();
  const bool exact_axes = inertia.is_diagonal();
  const Vector3d moments = exact_axes ? Vector3d(inertia.matrix().diagonal()) : inertia.moments();
  if (!exact_axes) start.R_BP = inertia.axes();
  start.omega = motion.omega(), start.attitude = motion.attitude();
  if (start.omega.isZero(0.0)) return start;
  start.time_exponent = exponent_of(start.omega), start.moment_exponent = exponent_of(moments);
  start.w = to_principal(start, start.omega), start.I = ldexp(moments, -start.moment_exponent);
  return start;
}

ColumnsBody::ColumnsBody(const ColumnsStart& start, ColumnsForm form, const FreeColumns<double>& columns,
                         const double* omega, const FreeTrig<double>* trig, const FreeHyper<double>* hyper,
                         const FreeFrame& frame)
    : start_(start), form_(form), trig_(trig), hyper_(hyper) {
  if (form == ColumnsForm::rest) return;
  rate_ = std::abs(columns.p);
  if (form != ColumnsForm::intermediate) finish(columns, omega, frame);
}

/// Brings the constants of the working axes to the caller's frames.
void ColumnsBody::finish(const FreeColumns<double>& given, const double* omega, const FreeFrame& frame) {
  BodyColumns& b = columns_;
  b.c = given;
  b.time_scale = frame.time_scale;
  Matrix3d S;
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < 3; ++a) S(c, a) = frame.omega[3 * c + a] / frame.time_scale;
  const double* A = frame.attitude;
  const Quat left{A[3], A[7], A[11], A[15]};
  const Quat first = conjugate(left) * start_.attitude;  // the start in the working space axes, body axes
  const Matrix3d theta = to_matrix(left) * S, R0 = S.transpose() * to_matrix(first) * S;
  const int e = start_.time_exponent, f = start_.moment_exponent;
  for (int i = 0; i < 9; ++i) {
    b.omega[i] = S(i / 3, i % 3), b.theta[i] = std::ldexp(theta(i / 3, i % 3), -e);
    b.omega_moment[i] = std::ldexp(S(i / 3, i % 3), e - f), b.theta_moment[i] = std::ldexp(theta(i / 3, i % 3), -f);
  }

  for (int c = 0; c < 3; ++c) {
    RateColumn<double> sum{};
    for (int a = 0; a < 3; ++a) {
      const RateColumn<double>& r = given.rates[a];
      const double share = S(c, a);
      sum.x += share * r.x, sum.U += share * r.U, sum.U_w += share * r.U_w, sum.U_I += share * r.U_I;
      sum.P += share * r.P, sum.Q += share * r.Q, sum.R += share * r.R, sum.psi += share * r.psi;
      sum.dL_x += share * given.J[a] * R0(0, a), sum.dL_y += share * given.J[a] * R0(1, a);
    }
    b.c.rates[c] = sum;
  }

  // The column of the largest component of the momentum follows from the two others.
  int last = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(given.J[a] * omega[a]) > std::abs(given.J[last] * omega[last])) last = a;
  const Matrix3d M = start_.R_BP.transpose() * S;
  int column = 0;
  for (int a = 0; a < 3; ++a) {
    Eigen::Index place = 0;
    M.col(a).cwiseAbs().maxCoeff(&place);
    const int k = a == last ? 2 : column++;
    b.place[k] = static_cast<std::size_t>(place);
    if (k == 2) continue;
    b.c.moments[k] = given.moments[a];
    b.is_own[k][a] = 1.0, b.share[k] = -given.J[a] / given.J[last];
    b.dL_x[k] = R0(0, a) * omega[a], b.dL_y[k] = R0(1, a) * omega[a];
  }
}

/// The columns of omega(0), of the moments and of the axes in space axes; of the axes only where the power series gives
/// them.
void ColumnsBody::groups(const ColumnTarget& to, std::ptrdiff_t axes, const double* t, std::size_t n,
                         const double* omega, const double* attitude) const {
  const double scale = std::ldexp(1.0, start_.time_exponent);
  const auto is_short = [&](std::size_t i) { return std::abs(rate_ * (t[i] * scale)) <= closed_form_from; };
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) count += is_short(i);
  if (count < n) {
    const FreeColumnsKernels& kernels = free_columns_kernels();
    if (form_ == ColumnsForm::trig) kernels.trig(*trig_, columns_, t, n, to);
    if (form_ == ColumnsForm::hyper) kernels.hyper(*hyper_, columns_, t, n, to);
  }
  if (count == 0 && form_ != ColumnsForm::intermediate) return;
  double longest = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    if (is_short(i)) longest = std::max(longest, std::abs(t[i] * scale));
  const ShortTimes series(start_, rate_ * longest, axes >= 0);
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_short_i = is_short(i);
    if (!is_short_i && form_ != ColumnsForm::intermediate) continue;
    const Vector3d w = Eigen::Map<const Vector3d>(omega + 3 * i);
    const ShortColumns found = is_short_i ? series.at(t[i] * scale, rate_, w, quat_at(attitude, i))
                                          : series.on_unstable_axis(t[i] * scale, quat_at(attitude, i));
    const SampleColumns out = sample(to, i);
    for (int c = 0; c < 3; ++c) {
      if (to.rates >= 0) out.put(to.rates + c, found.omega.col(c), found.theta.col(c));
      if (to.moments >= 0) out.put(to.moments + c, found.omega.col(3 + c), found.theta.col(3 + c));
      if (axes >= 0 && is_short_i) out.put(axes + c, found.omega.col(6 + c), found.theta.col(6 + c));
    }
  }
}

void ColumnsBody::at(const ColumnLayout& layout, const double* t, std::size_t n, const double* omega,
                     const double* attitude, double* d_omega, double* d_attitude) const {
  const ColumnTarget to{d_omega, d_attitude, layout.width, layout.omega, layout.inertia};
  const Matrix3d R0 = to_matrix(start_.attitude);
  const bool rotates = form_ != ColumnsForm::rest;
  const double scale = std::ldexp(1.0, start_.time_exponent);
  if (!rotates) {
    std::fill_n(d_omega, 3 * layout.width * n, 0.0), std::fill_n(d_attitude, 3 * layout.width * n, 0.0);
    for (std::size_t i = 0; i < n && layout.omega >= 0; ++i)
      for (int c = 0; c < 3; ++c) sample(to, i).put(layout.omega + c, Matrix3d::Identity().col(c), t[i] * R0.col(c));
  } else if (layout.omega >= 0 || layout.inertia >= 0) {
    groups(to, layout.axes, t, n, omega, attitude);
  }
  if (layout.attitude < 0 && layout.axes < 0 && layout.time < 0 && layout.side == RotationSide::space) return;

  const Vector3d w0 = start_.R_BP * start_.w, m0 = start_.I.cwiseProduct(start_.w);
  Eigen::Index last = 0;
  m0.cwiseAbs().maxCoeff(&last);
  for (std::size_t i = 0; i < n; ++i) {
    const SampleColumns out = sample(to, i);
    const Matrix3d R = to_matrix(quat_at(attitude, i));
    const Vector3d w_B = Eigen::Map<const Vector3d>(omega + 3 * i), w = to_principal(start_, w_B);
    if (layout.time >= 0 && rotates) {
      const Vector3d& I = start_.I;
      const Vector3d slope((I[1] - I[2]) / I[0] * w[1] * w[2], (I[2] - I[0]) / I[1] * w[2] * w[0],
                           (I[0] - I[1]) / I[2] * w[0] * w[1]);
      out.put(layout.time, ldexp(start_.R_BP * slope, 2 * start_.time_exponent), R * w_B);
    }
    if (layout.attitude >= 0)
      for (int c = 0; c < 3; ++c) out.put(layout.attitude + c, Vector3d::Zero(), Matrix3d::Identity().col(c));
    if (layout.axes >= 0 && rotates && !(std::abs(rate_ * (t[i] * scale)) <= closed_form_from)) {
      const Matrix3d moved = moved_axes(start_, R0 * start_.R_BP, R * start_.R_BP, w, last) * start_.R_BP.transpose();
      for (int c = 0; c < 3; ++c) {
        const Vector3d e = Matrix3d::Identity().col(c), start = e.cross(w0);
        Vector3d d_w = e.cross(w_B), d_theta = moved.col(c);
        for (int a = 0; a < 3; ++a) {
          d_w -= ldexp(out.get(out.omega, layout.omega + a) * start[a], start_.time_exponent);
          d_theta -= ldexp(out.get(out.theta, layout.omega + a), start_.time_exponent) * start[a];
        }
        out.put(layout.axes + c, d_w, d_theta);
      }
    }
    if (layout.side == RotationSide::space) continue;
    for (std::size_t c = 0; c < layout.width; ++c) {
      const auto column = static_cast<std::ptrdiff_t>(c);
      Vector3d d_theta = out.get(out.theta, column);
      if (layout.attitude >= 0 && column >= layout.attitude && column < layout.attitude + 3) d_theta = R0 * d_theta;
      out.put(column, out.get(out.omega, column), R.transpose() * d_theta);
    }
  }
}

MotionColumns::MotionColumns(const FreeMotion& motion) {
  const ColumnsStart start = make_columns_start(motion);
  FreeColumns<double> constants{};
  FreeFrame frame{};
  if (start.omega.isZero(0.0)) {
    body_.emplace(start, ColumnsForm::rest, constants, nullptr, nullptr, nullptr, frame);
    return;
  }
  FreeStart<double> given{};
  for (int a = 0; a < 3; ++a) given.I[a] = start.I[a], given.w[a] = start.w[a], given.M[a][a] = 1.0;
  FreeConstants<double> f;
  free_kernels().prepare(given, f, trig_, hyper_);
  const FreeStart<double>& s = f.start;
  constants.p = f.p.hi;
  if (s.w[0] == 0.0 && s.w[2] == 0.0 && s.I[0] != s.I[1] && s.I[1] != s.I[2]) {
    body_.emplace(start, ColumnsForm::intermediate, constants, nullptr, nullptr, nullptr, frame);
    return;
  }
  const bool is_hyper = f.k.hi * f.k.hi > hyper_from;
  Matrix3d M;
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < 3; ++a) M(c, a) = s.M[c][a];
  free_columns_kernels().prepare(f, is_hyper ? nullptr : &trig_, is_hyper ? &hyper_ : nullptr, constants);
  frame = make_free_frame(start.R_BP, M, std::ldexp(1.0, start.time_exponent),
                          is_hyper ? first_attitude(hyper_) : first_attitude(trig_), start.attitude);
  body_.emplace(start, is_hyper ? ColumnsForm::hyper : ColumnsForm::trig, constants, s.w, &trig_, &hyper_, frame);
}

}  // namespace polhode::exact
