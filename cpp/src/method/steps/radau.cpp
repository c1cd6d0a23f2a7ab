#include <algorithm>
#include <limits>
#include <memory>

#include "method/method.hpp"
#include "method/steps/magnus.hpp"
#include "method/steps/radau_body.hpp"
#include "method/steps/radau_system.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/detail/first_step.hpp"
#include "polhode/ode/detail/step_control.hpp"

namespace polhode {
namespace {

using ode::StepResult;

double sum3(const double* v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

/// Radau IIA of order 5 for the rate variables r, with Newton steps in systems of three equations. The attitude follows
/// from the collocation polynomial r(s) by Magnus' expansion: at the end of a step, at its stages and between them.
class RadauStepper final : public ode::Stepper {
 public:
  static constexpr int N = radau::Body::N;
  static constexpr int segment_size = 2 + 12 + 4;   ///< h, half_over_k, the cubic r(s), q at the start of the step

  RadauStepper(const radau::Body& body, const Scene& scene, bool with_attitude, const double* y0, double t_end,
               const ode::Tolerances& tolerances)
      : Stepper(N, segment_size, &evaluate_segment, scene.t0()),
        body_(body),
        control_(3),
        with_attitude_(with_attitude),
        coupled_(scene.torque_sum().uses_attitude),
        atol_(tolerances.atol) {
    // The estimate has order 3, the solution order 5. The tolerance is changed so that errors are proportional to the
    // given tolerance, as in RADAU5 (Hairer & Wanner 1996, sec. IV.8).
    rtol_ = 0.1 * math::fast_pow(tolerances.rtol, 2.0 / 3);
    newton_tolerance_ = std::max(10 * std::numeric_limits<double>::epsilon() / rtol_, std::min(0.03, std::sqrt(rtol_)));
    std::copy_n(y0, N, y_);
    std::copy_n(body.start_carry(), 3, carry_);
    segment_[1] = body.half_over_k();
    compute(t_, y_, f_);
    h_ = initial_step(t_end);
  }

  const double* y() const override { return y_; }
  void interpolate(double t, double* out) override { evaluate_segment(segment_, (t - t_old_) / segment_[0], out); }
  const double* segment() override { return segment_; }

  static void evaluate_segment(const double* segment, double s, double* out) {
    const double* c = segment + 2;
    for (int i = 0; i < 3; ++i) out[i] = c[i] + s * (c[3 + i] + s * (c[6 + i] + s * c[9 + i]));
    std::copy_n(c + 12, 4, out + 3);
    double w[12], rotation[3];
    to_rates(segment[1], c, w);
    compute_rotation_vector(w, segment[0], s, rotation);
    rotate_by_vector(rotation, out + 3);
  }

  StepResult advance(double t_end) override {
    const double direction = t_end < t_ ? -1.0 : 1.0;
    compute_jacobian();
    bool finite = true, first_try = counts_.steps == 0;
    for (;;) {
      const double rest = t_end - t_;
      const bool last = std::abs(h_) * 1.01 >= std::abs(rest);
      const double h = last ? rest : ode::representable_step(t_, h_);
      const double least =
          last ? std::numeric_limits<double>::min() : 8 * std::numeric_limits<double>::epsilon() * std::abs(t_);
      if (!(std::abs(h) > least)) return finite ? StepResult::underflow : StepResult::not_finite;
      double Z[3][3];
      body_.compute_sizes(h, y_, f_, size_);
      const Newton newton = solve_stages(h, Z);
      if (newton != Newton::converged) {
        finite = newton != Newton::not_finite;
        ++counts_.rejected;
        h_ = h * (finite ? 0.5 : 0.1);
        continue;
      }
      double c[12];
      set_polynomial(Z, c);
      double error = estimate(h, Z, c, first_try);
      if (error <= 1.0) {
        double y[N], f[3], carry[3];
        segment_[0] = h;
        std::copy_n(c, 12, segment_ + 2);
        std::copy_n(y_ + 3, 4, segment_ + 14);
        evaluate_segment(segment_, 1.0, y);
        for (int i = 0; i < 3; ++i) {
          const math::DD sum = math::two_sum(y_[i], carry_[i] + Z[2][i]);
          y[i] = sum.hi, carry[i] = sum.lo;
        }
        if (!with_attitude_) std::copy_n(y_ + 3, 4, y + 3);
        const double t_new = last ? t_end : t_ + h;
        compute(t_new, y, f);
        error = std::isfinite(sum3(f)) ? error : std::numeric_limits<double>::quiet_NaN();
        if (error <= 1.0) {
          std::copy_n(y, N, y_);
          std::copy_n(f, 3, f_);
          std::copy_n(carry, 3, carry_);
          t_old_ = t_;
          t_ = t_new;
          const double next = h * control_.accepted(error);
          h_ = last ? direction * std::max(std::abs(next), std::abs(h_)) : next;
          ++counts_.steps;
          return StepResult::accepted;
        }
      }
      finite = std::isfinite(error);
      ++counts_.rejected;
      h_ = h * control_.rejected(error);
      first_try = true;
    }
  }

 private:
  enum class Newton { converged, diverged, not_finite };

  void compute(double t, const double* y, double* f) {
    body_.compute_derivative(t, y, f);
    ++counts_.derivatives;
  }

  /// Converts the polynomial of the rate variables to that of the rates.
  static void to_rates(double half_over_k, const double* c, double* w) {
    for (int k = 0; k < 12; k += 3) radau::Body::to_rates(half_over_k, c + k, w + k);
  }

  /// d(r')/dr at the start of the step.
  void compute_jacobian() {
    const double size = std::max(sum3(y_), sum3(f_) * std::abs(h_));
    const double change = size > 0 ? std::ldexp(1.0, std::ilogb(size) - 26) : 1.0;
    counts_.derivatives += body_.compute_jacobian(t_, y_, f_, change, J_);
  }

  /// The increments of the three stages by simplified Newton steps in the variables W = T^-1 Z.
  Newton solve_stages(double h, double (&Z)[3][3]) {
    using namespace radau;
    systems_.prepare(J_, h);
    guess(h, Z);
    double W[3][3];
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        W[k][i] = T_inverse[k][0] * Z[0][i] + T_inverse[k][1] * Z[1][i] + T_inverse[k][2] * Z[2][i];
    // The effect of rounding in r' on an iteration, through the linear systems. No iteration gets below it.
    double rounding[3], noise[3];
    for (int i = 0; i < 3; ++i) {
      const double sum = std::abs(J_[i][0] * y_[0]) + std::abs(J_[i][1] * y_[1]) + std::abs(J_[i][2] * y_[2]);
      rounding[i] = 16 * std::numeric_limits<double>::epsilon() * std::abs(h) * sum;
    }
    systems_.spread(rounding, noise);
    double last = -1.0;
    for (int n = 0; n < most_iterations_; ++n) {
      double F[3][3], c[12], w[12];
      if (coupled_) {
        set_polynomial(Z, c);
        to_rates(segment_[1], c, w);
      }
      for (int k = 0; k < 3; ++k) {
        double y[N];
        for (int i = 0; i < 3; ++i) y[i] = y_[i] + Z[k][i];
        std::copy_n(y_ + 3, 4, y + 3);
        if (coupled_) {
          double rotation[3];
          compute_rotation_vector(w, h, node[k], rotation);
          rotate_by_vector(rotation, y + 3);
        }
        compute(t_ + node[k] * h, y, F[k]);
      }
      double b[3], change[3];
      Complex bc[3], pair[3];
      for (int i = 0; i < 3; ++i) {
        double G[3];
        for (int k = 0; k < 3; ++k)
          G[k] = h * (T_inverse[k][0] * F[0][i] + T_inverse[k][1] * F[1][i] + T_inverse[k][2] * F[2][i]);
        b[i] = G[0] - mu_real * W[0][i];
        bc[i] = Complex{G[1], G[2]} - Complex{mu_re, mu_im} * Complex{W[1][i], W[2][i]};
      }
      systems_.solve_real(b, change);
      systems_.solve_complex(bc, pair);
      double update[3];
      bool at_rounding = true;
      for (int i = 0; i < 3; ++i) {
        W[0][i] += change[i];
        W[1][i] += pair[i].re;
        W[2][i] += pair[i].im;
        update[i] = std::abs(change[i]) + std::abs(pair[i].re) + std::abs(pair[i].im);
        at_rounding = at_rounding && update[i] <= noise[i];
      }
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) Z[k][i] = T[k][0] * W[0][i] + T[k][1] * W[1][i] + T[k][2] * W[2][i];
      if (!std::isfinite(sum3(update))) return Newton::not_finite;
      if (at_rounding) return Newton::converged;
      const double now = measure(update, Z[2]);
      if (last >= 0.0) {
        const double rate = now / last;
        if (rate < 1.0 && rate / (1 - rate) * now < newton_tolerance_) return Newton::converged;
        if (rate >= 1.0 || math::power(rate, most_iterations_ - n) / (1 - rate) * now > newton_tolerance_)
          return Newton::diverged;
      }
      last = now;
    }
    return Newton::diverged;
  }

  /// Extrapolates the polynomial of the last step.
  void guess(double h, double (&Z)[3][3]) const {
    const double reach = counts_.steps == 0 ? 0.0 : h / segment_[0];
    const double* c = segment_ + 2;
    for (int k = 0; k < 3; ++k) {
      const double s = 1 + reach * radau::node[k];
      for (int i = 0; i < 3; ++i) {
        Z[k][i] = counts_.steps == 0 ? 0.0 : c[i] + s * (c[3 + i] + s * (c[6 + i] + s * c[9 + i])) - y_[i];
      }
    }
  }

  /// r(s) through the start and the stages.
  void set_polynomial(const double (&Z)[3][3], double* c) const {
    using radau::node;
    for (int i = 0; i < 3; ++i) {
      const double d1 = Z[0][i] / node[0], d2 = (Z[1][i] - Z[0][i]) / (node[1] - node[0]);
      const double d3 = (Z[2][i] - Z[1][i]) / (node[2] - node[1]);
      const double e1 = (d2 - d1) / node[1], e2 = (d3 - d2) / (node[2] - node[0]), g = (e2 - e1) / node[2];
      c[i] = y_[i];                                    // Newton's form, multiplied out
      c[3 + i] = d1 - e1 * node[0] + g * node[0] * node[1];
      c[6 + i] = e1 - g * (node[0] + node[1]);
      c[9 + i] = g;
    }
  }

  /// An error of the rate variables relative to the tolerance, for a step that changes them by `change`.
  double measure(const double* error, const double* change) const {
    const double end[3] = {std::abs(y_[0] + change[0]), std::abs(y_[1] + change[1]), std::abs(y_[2] + change[2])};
    if (!body_.relative()) return ratio(sum3(error), std::max(size_[2], sum3(end)));
    const double u = ratio(error[0], std::max(size_[0], end[0])), v = ratio(error[1], std::max(size_[1], end[1]));
    // max(|u|, |v|) is |w3| + k |w1|, as plain rates are measured by their sum. A NaN in u or v must survive.
    return (u > v || u != u ? u : v) + ratio(error[2], std::max(size_[2], std::max(end[0], end[1]) + end[2]));
  }
  double ratio(double error, double size) const {
    return error == 0.0 ? 0.0 : std::abs(error) / (rtol_ * size + atol_);
  }

  /// The error of the embedded formula relative to the tolerance, the larger of rates and attitude.
  double estimate(double h, const double (&Z)[3][3], const double* c, bool again) {
    using namespace radau;
    double ZE[3], b[3], e[3];
    for (int i = 0; i < 3; ++i) {
      ZE[i] = error[0] * Z[0][i] + error[1] * Z[1][i] + error[2] * Z[2][i];
      b[i] = h * f_[i] + ZE[i];
    }
    systems_.solve_real(b, e);
    double rates = measure(e, Z[2]);
    if (again && rates > 1.0) {   // filtered once more, for the first steps of a stiff problem (8.20)
      double y[N], f[3];
      std::copy_n(y_, N, y);
      for (int i = 0; i < 3; ++i) y[i] += e[i];
      compute(t_, y, f);
      for (int i = 0; i < 3; ++i) b[i] = h * f[i] + ZE[i];
      systems_.solve_real(b, e);
      rates = measure(e, Z[2]);
    }
    if (!with_attitude_) return rates;
    // The same formula for the integral of w(s). Only the cubic term contributes: sum of E_i node_i^4 / 4.
    constexpr auto fourth = [](double x) { return x * x * x * x; };
    constexpr double weight = (error[0] * fourth(node[0]) + error[1] * fourth(node[1]) + error[2]) / 4 / mu_real;
    double w[12], rotation[3], beyond[3];
    to_rates(segment_[1], c, w);
    compute_rotation_vector(w, h, 1.0, rotation, beyond);
    const double angle = 0.5 * std::max(std::abs(h * weight) * sum3(w + 9), sum3(beyond)) / (rtol_ + atol_);
    return rates > angle || rates != rates ? rates : angle;
  }

  double initial_step(double t_end) const {
    const double span = t_end - t_;
    double size[3], rate = 0.0;
    body_.compute_sizes(0.0, y_, f_, size);
    for (int i = 0; i < 3; ++i) rate += size[i] > 0.0 ? std::abs(f_[i]) / size[i] : 0.0;
    const double first = rate > 0 ? 0.01 / rate : 1e-3 * std::abs(span);
    return std::copysign(std::min(std::max(first, ode::shortest_first_step(t_)), std::abs(span)), span);
  }

  static constexpr int most_iterations_ = 12;
  const radau::Body& body_;
  ode::StepControl control_;
  radau::Systems systems_;
  bool with_attitude_, coupled_;
  double rtol_ = 0.0, atol_, newton_tolerance_ = 0.0, h_ = 0.0;
  double y_[N], carry_[3], f_[3], size_[3] = {}, J_[3][3] = {}, segment_[segment_size] = {};
};

Trajectory integrate_radau(const Scene& scene, const RunOptions& options) {
  const bool with_attitude =
      scene.want().attitude || scene.torque_sum().uses_attitude || !options.events.empty();
  const auto body = std::make_shared<const radau::Body>(scene);   // dense output needs it to unpack states
  const Unpack unpack = by_rows<radau::Body::N>(
      [body](const double* y, double* omega, double* attitude) { body->unpack(y, omega, attitude); });
  Trajectory trajectory = integrate(scene, options, body->start(), unpack, [&](const double* y, double t_end) {
    return std::make_unique<RadauStepper>(*body, scene, with_attitude, y, t_end, options.tolerances);
  });
  const std::string rates = body->relative() ? "separatrix variables" : "omega";
  trajectory.model = "euler", trajectory.state = with_attitude ? rates + ", attitude" : rates;
  return trajectory;
}

}  // namespace

const BodyMethod radau_method{
    {
        .name = "radau",
        .order = 5,
        .dense_order = 3,
        .adaptive = true,
        .implicit = true,
        .keeps = "nothing",
        .doc =
            "Radau IIA of order 5 for the rates, with the attitude by Magnus' expansion. For stiff damping, where "
            "stability limits explicit steps.",
        .source = "Hairer & Wanner 1996, Solving ODEs II, sec. IV.8; Blanes, Casas & Ros 2000, BIT 40, 434",
        .forecast = {.error_per_turn = 0.007,
                     .error_power = 0.7,
                     .margin = 2.0,
                     .floor_per_turn = 1e-15,
                     .steps_per_radian = 0.21,
                     .power = 0.165,
                     .step_seconds = 4.5e-7,
                     .sample_seconds = 9e-8,
                     .calls_per_step = 10},
    },
    &integrate_radau,
};

}  // namespace polhode
