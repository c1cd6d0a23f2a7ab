#include <algorithm>
#include <cmath>

#include "core/choose_level.hpp"
#include "batch/lane_method.hpp"
#include "batch/lanes/taylor_block.hpp"
#include "method/series/formula_series.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode {
namespace {

using Row = LaneState::Row;

TaylorKernels find_kernels(const SeriesTerms& terms, bool attitude) {
  return choose_level(simd_level(), baseline_taylor_lanes, avx2_taylor_lanes, avx512_taylor_lanes, terms, attitude);
}

/// One order for all lanes, fitted to measured times: in lanes the cost of a step grows as about its order squared.
int choose_lane_order(double tolerance) {
  const int order = static_cast<int>(std::ceil(1.0 - 0.65 * math::fast_log(tolerance)));
  return std::clamp(order, ode::Taylor::least_order, ode::most_series_order - 2);
}

void put_rows(Row* rows, int lane, const double* values, int n) {
  for (int i = 0; i < n; ++i) rows[i][lane] = values[i];
}

class TaylorLaneProblem final : public LaneProblem {
 public:
  explicit TaylorLaneProblem(const Scene& scene) : series_(scene, scene.want().attitude) {}

  const BodySeries& series() const { return series_; }

  std::string kind() const override {
    const SeriesTerms& terms = series_.terms();
    const bool flags[] = {terms.variables == RateVariables::separatrix,
                          series_.has_attitude(),
                          terms.gradient,
                          terms.damped,
                          series_.keeps_balance(),
                          terms.fixed_vectors > 0,
                          terms.fixed_vectors > 1};
    return std::string(std::begin(flags), std::end(flags));
  }

  std::string describe_state() const override { return series_.describe_state(); }
  void unpack(const double* y, double* omega, double* attitude) const override {
    series_.unpack(y, 1, omega, attitude);
  }
  std::unique_ptr<LaneIntegrator> make_integrator(const ode::Tolerances& tolerances) const override;

 private:
  BodySeries series_;
};

class TaylorIntegrator final : public LaneIntegrator {
 public:
  TaylorIntegrator(const BodySeries& first, const ode::Tolerances& tolerances)
      : kernels_(find_kernels(first.terms(), first.has_attitude())), gradient_(first.terms().gradient) {
    b_.order = choose_lane_order(tolerances.rtol + tolerances.atol);
    b_.rtol = tolerances.rtol, b_.atol = tolerances.atol;
    b_.damped = first.terms().damped, b_.balanced = first.keeps_balance();
  }

  LaneState& state() override { return b_; }

  void load(int lane, const LaneProblem& problem) override {
    const BodySeries& series = static_cast<const TaylorLaneProblem&>(problem).series();
    put_constants(lane, series);
    double carry[8];
    series.start_carry(carry);
    put_rows(b_.y, lane, series.start(), 8), put_rows(b_.carry, lane, carry, 8);
    const double t0 = b_.time[lane];
    b_.time_low[lane] = 0.0, phase_[lane] = series.orbit_phase(), attempts_[lane] = 0;
    const double unit = std::min(series.compute_time_scale(t0, series.start()), std::abs(b_.t_end[lane] - t0));
    b_.unit[lane] = math::power_of_two_below(std::clamp(unit, 0x1p-900, 0x1p900));
  }

  void clear(int lane) override {
    for (int i = 0; i < 8; ++i) b_.y[i][lane] = b_.carry[i][lane] = 0.0;
    b_.t_end[lane] = b_.time[lane] = b_.time_low[lane] = 0.0, b_.unit[lane] = 1.0;
  }

  unsigned advance(int rounds) override {
    unsigned ready = 0;
    for (int round = 0; round < rounds && ready == 0; ++round, ++b_.rounds) {
      for (int lane = 0; lane < width && gradient_; ++lane) put_orbit(lane);
      kernels_.step(b_);
      for (int lane = 0; lane < width; ++lane)
        if ((b_.active >> lane & 1u) != 0 && needs_host(lane)) ready |= 1u << lane;
    }
    return ready;
  }

  double find_position(int lane, double t) const override {
    return ((t - b_.time_old[lane]) - b_.time_old_low[lane]) / b_.unit_old[lane];
  }

  void sample(const double* positions, double (*y)[width]) override { kernels_.sample(b_, positions, y); }

 private:
  static constexpr int most_attempts = 8;   // each in a smaller unit of time

  /// After a step of the lane; counts it if it was accepted.
  bool needs_host(int lane) {
    if (b_.outcome[lane] == double{lane_not_finite}) return ++attempts_[lane] > most_attempts;
    if (b_.outcome[lane] == double{lane_underflow}) return true;
    attempts_[lane] = 0;
    const double reached = b_.time[lane], next = b_.next_sample[lane];
    const bool due = b_.t_end[lane] >= b_.time_old[lane] ? next <= reached : next >= reached;
    return ++b_.steps[lane] >= b_.max_steps || due;
  }

  void put_constants(int lane, const BodySeries& series) {
    const SeriesTerms& terms = series.terms();
    b_.to_rates[lane] = terms.to_rates[0], b_.orbit_rate[lane] = terms.orbit_rate;
    put_rows(b_.product, lane, terms.product, 3), put_rows(b_.product_low, lane, terms.product_low, 3),
        put_rows(b_.torque, lane, terms.torque, 3);
    for (int j = 0; j < 3; ++j) put_rows(b_.damping[j], lane, terms.damping[j], 3);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 3; ++j) put_rows(b_.pull[i][j], lane, terms.pull[i][j], 3);
      put_rows(b_.tidal[i], lane, terms.tidal[i], 3), put_rows(b_.space[i], lane, series.fixed_vector(i).data(), 3);
      b_.kept[i][lane] = series.kept(i).hi, b_.kept_low[i][lane] = series.kept(i).lo;
    }
    b_.balance[lane] = series.balance();
  }

  /// Sine and cosine of the orbit's angle n t + phase, with n t in two parts (as BodySeries::compute_series).
  void put_orbit(int lane) {
    const double rate = b_.orbit_rate[lane];
    const math::DD product = math::two_prod(rate, b_.time[lane]), angle = math::two_sum(product.hi, phase_[lane]);
    const double low = angle.lo + product.lo + rate * b_.time_low[lane];
    const auto [s, c] = math::sincos(angle.hi);
    b_.orbit_sin[lane] = s + c * low, b_.orbit_cos[lane] = c - s * low;
  }

  TaylorBlock b_;
  TaylorKernels kernels_;
  bool gradient_;
  double phase_[width] = {};
  int attempts_[width] = {};
};

std::unique_ptr<LaneIntegrator> TaylorLaneProblem::make_integrator(const ode::Tolerances& tolerances) const {
  return std::make_unique<TaylorIntegrator>(series_, tolerances);
}

}  // namespace

const LaneMethod taylor_lanes{
    ode::Taylor::record,
    [](const Scene& scene) { return !needs_formula_series(scene) && compute_series_refusal(scene).empty(); },
    [](const Scene& scene) -> std::unique_ptr<LaneProblem> { return std::make_unique<TaylorLaneProblem>(scene); }};

}  // namespace polhode
