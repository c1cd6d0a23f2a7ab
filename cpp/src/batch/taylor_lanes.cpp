#include "core/choose_level.hpp"
#include "batch/formula_lanes.hpp"
#include "batch/lanes/taylor_block.hpp"
#include "batch/series_integrator.hpp"
#include "method/series/switched_series.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

TaylorKernels find_kernels(const SeriesTerms& terms, bool attitude) {
  return choose_level(simd_level(), baseline_taylor_lanes, avx2_taylor_lanes, avx512_taylor_lanes, terms, attitude);
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

class TaylorIntegrator final : public SeriesIntegrator {
 public:
  TaylorIntegrator(const BodySeries& first, const ode::Tolerances& tolerances)
      : SeriesIntegrator(b_), kernels_(find_kernels(first.terms(), first.has_attitude())),
        gradient_(first.terms().gradient) {
    put_tolerances(tolerances);
    b_.damped = first.terms().damped, b_.balanced = first.keeps_balance();
  }

  void load(int lane, const LaneProblem& problem) override {
    const BodySeries& series = static_cast<const TaylorLaneProblem&>(problem).series();
    put_constants(lane, series);
    double carry[8];
    series.start_carry(carry);
    phase_[lane] = series.orbit_phase();
    put_start(lane, series.start(), carry, series.compute_time_scale(b_.time[lane], series.start()));
  }

  void sample(const double* positions, double (*y)[width]) override { kernels_.sample(b_, positions, y); }

 private:
  void step() override {
    for (int lane = 0; lane < width && gradient_; ++lane) put_orbit(lane);
    kernels_.step(b_);
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
};

std::unique_ptr<LaneIntegrator> TaylorLaneProblem::make_integrator(const ode::Tolerances& tolerances) const {
  return std::make_unique<TaylorIntegrator>(series_, tolerances);
}

}  // namespace

const LaneMethod taylor_lanes{
    ode::Taylor::record,
    [](const Scene& scene) {
      return compute_series_refusal(scene).empty() && scene.states().empty() && !has_switches(scene);
    },
    [](const Scene& scene, const LaneProblem* before) -> std::unique_ptr<LaneProblem> {
      if (needs_formula_series(scene)) return make_formula_lane(scene, before);
      return std::make_unique<TaylorLaneProblem>(scene);
    }};

}  // namespace polhode
