#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "method/method.hpp"
#include "method/steps/principal_body.hpp"
#include "polhode/ode/fixed_step.hpp"

namespace polhode {

/// A fixed step of a body. The state is L, because a conversion to omega in each step would bias |L| by rounding.
///
/// `Step` is the method, made from a PrincipalBody and the scene. It has bool advance(double h, const double* kick,
/// double* L, double* q) for one step of L_P and q_WP, which returns false if it finds no solution, and static
/// constexpr bool kick_within   the torque acts inside the step, as h tau in `kick` static constexpr int interior
/// the number of shorter steps for the polynomial between the steps A Step with numbers of its own has their count
/// `carried`, `start(w, own)` and `kick(kick, own)`. They are stored behind L. A Step with `ascending` needs the
/// moments of a triaxial body in ascending order. Without kick_within the torque acts between the parts of a step, by
/// `kicks` and `drifts` if Step has them. Otherwise half of it acts before the step and half after (Strang 1968, SIAM
/// J. Numer. Anal. 5, 506).
template <class Step>
class BodyStepper final : public ode::FixedStepper {
 public:
  static constexpr int N = 7;                            ///< (w_B, q_WB)
  static constexpr int nodes = 4 + Step::interior;       ///< of the polynomial: each end twice, and the interior nodes
  static constexpr int segment_size = nodes * N;
  static constexpr bool carries = requires { Step::carried; };
  static constexpr int momenta = [] {                    ///< numbers in L: its three components, and those behind it
    if constexpr (carries) return 3 + Step::carried;
    return 3;
  }();

  BodyStepper(const Scene& scene, double t0, const double* y0, const ode::Tolerances& tolerances)
      : FixedStepper(N, segment_size, &evaluate_segment, t0, tolerances.step),
        body_(
            scene, tolerances.step, requires { Step::ascending; }),
        step_(body_, scene),
        earlier_(step_) {
    std::copy_n(y0, N, y_);
    body_.enter(y0, L_, q_);
    if constexpr (carries) {
      double w[3];
      body_.compute_rates(y0, w);
      step_.start(w, L_ + 3);
    }
  }

  const double* y() const override {
    if (counts_.steps != 0) body_.leave(L_, q_, y_);   // the start is returned as given
    return y_;
  }

  void interpolate(double t, double* out) override {
    // At the end of a step, up to the rounding of its time, the state itself is returned.
    if (std::abs(t - t_) <= time_rounding(t_)) return body_.leave(L_, q_, out);
    evaluate_segment(segment(), fraction(t), out);
  }

  /// Divided differences at 0, 0, 1, 1 and the interior fractions.
  const double* segment() override {
    if (segment_ready_) return segment_;
    segment_ready_ = true;
    double rate[2][N];
    put_node(0, L_old_, q_old_);
    std::copy_n(segment_, N, segment_ + N);
    put_node(2, L_, q_);
    std::copy_n(segment_ + 2 * N, N, segment_ + 3 * N);
    compute_rates(t_old_, segment_, rate[0]);
    compute_rates(t_, segment_ + 2 * N, rate[1]);
    for (int k = 4; k < nodes; ++k) {
      double L[momenta], q[4];
      std::copy_n(L_old_, momenta, L);
      std::copy_n(q_old_, 4, q);
      Step step = earlier_;
      advance_body(step, t_old_, node(k) * h_taken(), L, q);
      put_node(k, L, q);
    }
    for (int level = 1; level < nodes; ++level) {
      for (int k = nodes; k-- > level;) {
        const double width = node(k) - node(k - level);
        for (int i = 0; i < N; ++i) {
          double& top = segment_[k * N + i];
          top = width == 0.0 ? h_taken() * rate[k == 1 ? 0 : 1][i] : (top - segment_[(k - 1) * N + i]) / width;
        }
      }
    }
    return segment_;
  }

  static void evaluate_segment(const double* c, double s, double* out) {
    double y[N];
    std::copy_n(c + (nodes - 1) * N, N, y);
    for (int k = nodes - 1; k-- > 0;) {
      for (int i = 0; i < N; ++i) y[i] = c[k * N + i] + (s - node(k)) * y[i];
    }
    std::copy_n(y, N, out);
  }

 private:
  static constexpr double node(int k) { return k < 2 ? 0.0 : (k < 4 ? 1.0 : (k - 3.0) / (Step::interior + 1.0)); }

  void put_node(int k, const double* L, const double* q) { body_.leave(L, q, segment_ + k * N); }

  /// y' by Euler's equations, in the scene's axes and units.
  void compute_rates(double t, const double* y, double* f) const {
    double L[3], q[4], tau[3] = {0, 0, 0}, w[3], gyro[3];
    body_.enter(y, L, q);
    if (body_.driven()) body_.compute_torque(t, L, q, tau);
    for (int i = 0; i < 3; ++i) w[i] = L[i] / body_.I[i];
    cross(L, w, gyro);
    double rate[3], q_rate[4];
    for (int i = 0; i < 3; ++i) rate[i] = tau[i] + gyro[i];
    q_rate[0] = 0.5 * (q[3] * w[0] + q[1] * w[2] - q[2] * w[1]);
    q_rate[1] = 0.5 * (q[3] * w[1] + q[2] * w[0] - q[0] * w[2]);
    q_rate[2] = 0.5 * (q[3] * w[2] + q[0] * w[1] - q[1] * w[0]);
    q_rate[3] = -0.5 * (q[0] * w[0] + q[1] * w[1] + q[2] * w[2]);
    body_.leave(rate, q_rate, f);   // linear in both
    for (int i = 0; i < N; ++i) f[i] = body_.to_scaled_time(f[i]);
  }

  ode::StepResult step(double t, double h) override {
    double L[momenta], q[4];
    std::copy_n(L_, momenta, L);
    std::copy_n(q_, 4, q);
    Step next = step_;
    if (!advance_body(next, t, h, L, q)) return ode::StepResult::no_solution;
    if (!std::isfinite(L[0] + L[1] + L[2]) || !std::isfinite(q[0] + q[1] + q[2] + q[3]))
      return ode::StepResult::not_finite;
    std::copy_n(L_, momenta, L_old_);
    std::copy_n(q_, 4, q_old_);
    std::copy_n(L, momenta, L_);
    std::copy_n(q, 4, q_);
    earlier_ = step_;
    step_ = next;
    segment_ready_ = false;
    return ode::StepResult::accepted;
  }

  bool advance_body(Step& step, double t, double h, double* L, double* q) {
    constexpr double none[3] = {0, 0, 0};
    const double scaled = body_.to_scaled_time(h);
    bool solved = true;
    if (!body_.driven()) {
      solved = step.advance(scaled, none, L, q);
    } else if constexpr (Step::kick_within) {
      double kick[3];
      compute_kick(t, scaled, L, q, kick);
      solved = step.advance(scaled, kick, L, q);
    } else if constexpr (requires { Step::kicks; }) {
      double at = 0.0;
      for (std::size_t k = 0; k < std::size(Step::kicks); ++k) {
        apply_kick(t + at * h, Step::kicks[k] * scaled, L, q);
        if (k == std::size(Step::drifts)) break;
        solved = solved && step.advance(Step::drifts[k] * scaled, none, L, q);
        at = k + 1 == std::size(Step::drifts) ? 1.0 : at + Step::drifts[k];
      }
    } else {
      apply_kick(t, 0.5 * scaled, L, q);
      solved = step.advance(scaled, none, L, q);
      apply_kick(t + h, 0.5 * scaled, L, q);
    }
    return solved;
  }

  void apply_kick(double t, double h, double* L, const double* q) {
    double kick[3];
    compute_kick(t, h, L, q, kick);
    for (int i = 0; i < 3; ++i) L[i] += kick[i];
    if constexpr (carries) step_.kick(kick, L + 3);
  }

  /// The change of L by the torque alone, over the scaled time h at time t. It is h tau, or the midpoint rule for a
  /// torque that depends on the rates, because half kicks would otherwise be of order 1.
  void compute_kick(double t, double h, const double* L, const double* q, double* kick) {
    double tau[3];
    body_.compute_torque(t, L, q, tau);
    ++counts_.derivatives;
    if (!Step::kick_within && body_.uses_rates()) {
      const double middle[3] = {L[0] + 0.5 * h * tau[0], L[1] + 0.5 * h * tau[1], L[2] + 0.5 * h * tau[2]};
      body_.compute_torque(t, middle, q, tau);
      ++counts_.derivatives;
    }
    for (int i = 0; i < 3; ++i) kick[i] = h * tau[i];
  }

  PrincipalBody body_;
  Step step_, earlier_;
  bool segment_ready_ = false;
  mutable double y_[N];
  double L_[momenta], q_[4], L_old_[momenta] = {}, q_old_[4] = {}, segment_[segment_size] = {};
};

/// Integrates a scene by a fixed-step method.
template <class Step>
Trajectory integrate_with(const Scene& scene, const RunOptions& options) {
  using Pack = EulerProblem<NoTorque, true, true>;
  double y0[7];
  Pack::pack(scene.start(), y0);
  const auto make = [&](const double* y, double) {
    return std::make_unique<BodyStepper<Step>>(scene, scene.t0(), y, options.tolerances);
  };
  Trajectory trajectory = integrate(scene, options, y0, by_rows<Pack::dimension>(&Pack::unpack), make);
  trajectory.model = "euler", trajectory.state = "angular momentum, attitude";
  return trajectory;
}

}  // namespace polhode
