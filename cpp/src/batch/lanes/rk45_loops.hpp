#pragma once

#include <utility>

#include "batch/lanes/pass.hpp"
#include "batch/lanes/rk45_block.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/sincos_unfused.hpp"
#include "polhode/ode/detail/step_control.hpp"
#include "polhode/ode/tableaus/dormand_prince54.hpp"
#include "polhode/method/euler_formulas.hpp"

// Steps of rk45 with a body in each lane, for one lane type `Wide`. Each file that is built for one instruction set
// includes this header once. The operations are those of ode::RungeKuttaStepper on EulerProblem, none of them fused:
// the bits are the same.
namespace polhode::POLHODE_ISA {

using Mask = math::Mask<Wide>;

POLHODE_INLINE bool any(Mask mask) { return bits(mask) != 0; }

/// The same as in GravityGradient: polynomials, and beyond their range one lane after another.
POLHODE_INLINE void sincos_lanes(Wide angle, Wide& sine, Wide& cosine) {
  math::sincos_unfused(angle, sine, cosine);
  const Mask within = abs(angle) <= Wide(math::most_unfused_angle);
  if (bits(within) == (1u << Wide::width) - 1) return;
  alignas(64) double a[Wide::width], s[Wide::width], c[Wide::width];
  angle.store(a);
  for (int i = 0; i < Wide::width; ++i) {
    const math::SinCosPair far = math::sincos(a[i]);
    s[i] = far.sin, c[i] = far.cos;
  }
  sine = select(within, sine, Wide::load(s)), cosine = select(within, cosine, Wide::load(c));
}

/// Adds all torques to tau.
template <bool diagonal>
POLHODE_INLINE void add_torques(const Rk45Block& b, Pass pass, Wide t, const Wide* w, const Wide* q, Wide* tau) {
  for (int k = 0; k < b.torque_count; ++k) {
    const LaneTorque& torque = b.torques[k];
    const auto values = [&]<int n>(Wide (&v)[n]) __attribute__((always_inline)) {
      for (int i = 0; i < n; ++i) v[i] = pass.load(torque.values[i]);
    };
    Wide v[3];
    values(v);
    switch (torque.kind) {
      case LaneTorque::Kind::body_constant:
        for (int i = 0; i < 3; ++i) tau[i] = tau[i] + v[i];
        break;
      case LaneTorque::Kind::space_constant: {
        Wide v_B[3];
        to_body(q, v, v_B);
        for (int i = 0; i < 3; ++i) tau[i] = tau[i] + v_B[i];
        break;
      }
      case LaneTorque::Kind::weight: add_weight(v, q, tau); break;
      case LaneTorque::Kind::rotors: add_rotors(v, w, tau); break;
      case LaneTorque::Kind::gradient: {
        Wide u[3], I[9], sine, cosine;   // v: mean motion, phase, strength
        sincos_lanes(v[0] * t + v[1], sine, cosine);
        compute_radial(cosine, sine, q, u);
        for (int i = 0; i < 9; ++i) I[i] = pass.load(b.inertia[i]);
        add_gradient<diagonal>(v[2], I, u, tau);
        break;
      }
      case LaneTorque::Kind::damping: {
        Wide C[9];
        values(C);
        add_damping(C, w, tau);
        break;
      }
    }
  }
}

/// ode::StepControl, lane by lane.
struct LaneControl {
  using Constants = ode::StepControl;

  /// log2(x) for 2^-1022 <= x < 2^1023; beyond, the factors below are at their bounds anyway.
  static POLHODE_INLINE Wide log2(Wide x) {
    const Wide exponent = exponent_of_power(power_of_two_below(x)), m = x * power_of_two(-exponent) - Wide(1.0);
    return exponent + m * (Wide(1.4249) + m * (Wide(-0.5797) + m * Wide(0.1548)));
  }

  static POLHODE_INLINE Wide exp2(Wide x) {
    const Wide low(-1000.0), high(1000.0), p = select(x < low, low, select(high < x, high, x));
    const Wide shifted = p + Wide(1024.0), near = rint(shifted),
               whole = select(shifted < near, near - Wide(1.0), near) - Wide(1024.0);
    const Wide f = p - whole;
    return power_of_two(whole) * (Wide(1.0) + f * (Wide(0.6951) + f * (Wide(0.2276) + f * Wide(0.0773))));
  }

  /// log2 of max(error, least_error).
  static POLHODE_INLINE Wide remember(Wide error, Wide log_error) {
    const Wide least(Constants::least_error);
    return select(error < least, log2(least), log_error);
  }
};

template <bool diagonal, bool attitude>
class Rk45Lanes {
  using Tableau = ode::tableaus::DormandPrince54;
  static constexpr int N = attitude ? 7 : 3, stages = Tableau::stages, last_stage = stages - 1;

 public:
  static unsigned advance(Rk45Block& b, int rounds) {
    unsigned ready = 0;
    for (int round = 0; round < rounds && ready == 0; ++round) {
      for (int at = 0; at < LaneState::width; at += Wide::width) ready |= Rk45Lanes(b, Pass{at}).step() << at;
      ready &= b.active;
      ++b.rounds;
    }
    return ready;
  }

  static void sample(const Rk45Block& b, const double* fraction, double (*out)[LaneState::width]) {
    for (int at = 0; at < LaneState::width; at += Wide::width) {
      const Pass pass{at};
      const Wide s = Wide::load(fraction + at), r = Wide(1.0) - s;
      for (int i = 0; i < N; ++i) {
        Wide y = pass.load(b.segment[4][i]);
        for (int k = 4; k-- > 0;) y = pass.load(b.segment[k][i]) + (k % 2 == 0 ? s : r) * y;
        y.store(out[i] + at);
      }
    }
  }

 private:
  POLHODE_INLINE Rk45Lanes(Rk45Block& block, Pass pass) : b_(block), pass_(pass) {}

  POLHODE_INLINE Wide load(const Row& row) const { return pass_.load(row); }

  POLHODE_INLINE void derive(Wide t, const Wide* y, Wide* f) const {
    const Wide zero(0.0), still[4] = {zero, zero, zero, Wide(1.0)};
    const Wide* q = attitude ? y + 3 : still;
    Wide tau[3] = {zero, zero, zero};
    add_torques<diagonal>(b_, pass_, t, y, q, tau);
    if constexpr (diagonal) {
      const Wide difference[3] = {load(b_.difference[0]), load(b_.difference[1]), load(b_.difference[2])};
      const Wide inverse[3] = {load(b_.inverse_moment[0]), load(b_.inverse_moment[1]), load(b_.inverse_moment[2])};
      compute_rate_change(difference, inverse, y, tau, f);
    } else {
      Wide I[9], inverse[9];
      for (int i = 0; i < 9; ++i) I[i] = load(b_.inertia[i]), inverse[i] = load(b_.inverse[i]);
      compute_rate_change_skew(I, inverse, y, tau, f);
    }
    if constexpr (attitude) compute_attitude_rate(q, y, f + 3);
  }

  template <int S, int... J>
  POLHODE_INLINE void compute_stage(Wide t, Wide h, std::integer_sequence<int, J...>) {
    for (int i = 0; i < N; ++i) {
      Wide sum(0.0);
      ((Tableau::a[S][J] != 0.0 ? void(sum = sum + Wide(Tableau::a[S][J]) * k_[J][i]) : void()), ...);
      y_new_[i] = y_[i] + h * sum;
    }
    derive(t + Wide(Tableau::c[S]) * h, y_new_, k_[S]);
  }

  template <int... S>
  POLHODE_INLINE void compute_stages(Wide t, Wide h, std::integer_sequence<int, S...>) {
    (compute_stage<S + 1>(t, h, std::make_integer_sequence<int, S + 1>{}), ...);
  }

  POLHODE_INLINE Wide weigh(const double (&weights)[stages], int i) const {
    Wide sum(0.0);
    for (int s = 0; s < stages; ++s) sum = sum + Wide(weights[s]) * k_[s][i];
    return sum;
  }

  /// Tries one step in each lane. Returns the bits of the lanes that need the host.
  POLHODE_INLINE unsigned step() {
    const Wide zero(0.0), one(1.0), t = load(b_.time), t_end = load(b_.t_end), tried = load(b_.step);
    const Wide rest = t_end - t;
    const Mask last = abs(rest) <= abs(tried) * Wide(1.01);
    const Wide h = select(last, rest, (t + tried) - t);   // ode::representable_step
    const Mask moves = ((abs(h) > Wide(8 * 0x1p-52) * abs(t)) | last) & (Wide(0x1p-1022) <= abs(h));

    for (int i = 0; i < N; ++i) y_[i] = load(b_.y[i]), k_[0][i] = load(b_.f[i]);
    compute_stages(t, h, std::make_integer_sequence<int, last_stage>{});
    Wide error[N];
    for (int i = 0; i < N; ++i) error[i] = h * weigh(Tableau::error, i);
    const Wide norm = compute_error_norm<attitude>(error, y_, y_new_, Wide(b_.rtol), Wide(b_.atol));
    const Mask accepted = (norm <= one) & moves;

    const Wide reached = select(accepted, select(last, t_end, t + h), t),
               steps = load(b_.steps) + select(accepted, one, zero);
    const Wide next_sample = load(b_.next_sample);
    const Mask due =
        accepted & (((next_sample <= reached) & (zero <= rest)) | ((reached <= next_sample) & (rest < zero)));
    const Wide stuck = select(load(b_.not_finite) == zero, Wide(lane_underflow), Wide(lane_not_finite));
    choose_step(norm, h, tried, rest, last, accepted);
    pass_.store(b_.time, reached), pass_.store(b_.steps, steps);
    pass_.store(b_.outcome, select(moves, select(reached == t_end, Wide(lane_arrived), Wide(lane_stepped)), stuck));

    const unsigned all = (1u << Wide::width) - 1;
    const unsigned ready = (bits(due) | (all & ~bits(moves)) | (bits(accepted) & bits(Wide(b_.max_steps) <= steps)));
    if (ready != 0) put_segment(t, h);
    // The next step starts from the last stage and from |q| = 1; one factor scales both (EulerProblem::restore).
    if constexpr (attitude) {
      const Wide scale = compute_unit_scale(y_new_ + 3);
      for (int i = 3; i < 7; ++i) y_new_[i] = y_new_[i] * scale, k_[last_stage][i] = k_[last_stage][i] * scale;
    }
    for (int i = 0; i < N; ++i) {
      pass_.store(b_.y[i], select(accepted, y_new_[i], y_[i]));
      pass_.store(b_.f[i], select(accepted, k_[last_stage][i], k_[0][i]));
    }
    return ready;
  }

  /// Chooses the next step to try, as ode::StepControl does.
  POLHODE_INLINE void choose_step(Wide norm, Wide h, Wide tried, Wide rest, Mask last, Mask accepted) {
    using Control = ode::StepControl;
    constexpr double integral = Control::integral(Tableau::error_order);
    const Wide zero(0.0), one(1.0), smallest(Control::smallest), largest(Control::largest);
    const Mask finite = norm - norm == zero, was_rejected = load(b_.rejected) > zero;
    const Wide log_norm = LaneControl::log2(norm), log_previous = load(b_.log_previous);
    const Wide plain = Wide(Control::safety) * LaneControl::exp2(Wide(-integral) * log_norm);
    const Wide smoothed = plain * LaneControl::exp2(Wide(Control::proportional) * log_previous);

    const Wide wish = select(norm > zero, smoothed, largest), most = select(was_rejected, one, largest);
    const Wide next = h * select(wish < smallest, smallest, select(most < wish, most, wish));
    const Wide longer = select(abs(next) < abs(tried), abs(tried), abs(next));
    const Wide again = h * select(finite, select(smallest < plain, plain, smallest), Wide(0.1));
    pass_.store(b_.step, select(accepted, select(last, copysign(longer, rest), next), again));
    pass_.store(b_.log_previous, select(accepted, LaneControl::remember(norm, log_norm), log_previous));
    pass_.store(b_.rejected, select(accepted, zero, one));
    pass_.store(b_.not_finite, select(accepted, zero, select(finite, zero, one)));
  }

  /// The continuous extension (RungeKuttaStepper::prepare_segment).
  POLHODE_INLINE void put_segment(Wide t, Wide h) {
    pass_.store(b_.time_old, t), pass_.store(b_.step_taken, h);
    for (int i = 0; i < N; ++i) {
      const Wide c1 = y_new_[i] - y_[i], c2 = h * k_[0][i] - c1;
      pass_.store(b_.segment[0][i], y_[i]), pass_.store(b_.segment[1][i], c1), pass_.store(b_.segment[2][i], c2);
      pass_.store(b_.segment[3][i], c1 - h * k_[last_stage][i] - c2);
      pass_.store(b_.segment[4][i], h * weigh(Tableau::dense[0], i));
    }
  }

  Rk45Block& b_;
  Pass pass_;
  Wide y_[N], y_new_[N], k_[stages][N];
};

template <bool diagonal, bool attitude>
Rk45Kernels make_rk45() {
  return {&Rk45Lanes<diagonal, attitude>::advance, &Rk45Lanes<diagonal, attitude>::sample};
}

inline Rk45Kernels choose_rk45(bool diagonal, bool attitude) {
  if (diagonal) return attitude ? make_rk45<true, true>() : make_rk45<true, false>();
  return attitude ? make_rk45<false, true>() : make_rk45<false, false>();
}

}  // namespace polhode::POLHODE_ISA
