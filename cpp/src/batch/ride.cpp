#include "batch/ride.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/core/simd.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode {
namespace {

constexpr int width = LaneBlock::width;

/// One order for all lanes, by measured time: with bodies side by side a step costs nearly the square of its order.
int choose_lane_order(double tolerance) {
  const int order = static_cast<int>(std::ceil(1.0 - 0.65 * std::log(tolerance)));
  return std::clamp(order, ode::Taylor::least_order, ode::most_series_order - 2);
}

/// Where the orbit stands, without the rounding of n t (BodySeries::compute_series).
void put_orbit(LaneBlock& b, int lane, double phase) {
  const double rate = b.orbit_rate[lane];
  const math::DD product = math::two_prod(rate, b.time[lane]), angle = math::two_sum(product.hi, phase);
  const double low = angle.lo + product.lo + rate * b.time_low[lane];
  const double s = std::sin(angle.hi), c = std::cos(angle.hi);
  b.orbit_sin[lane] = s + c * low, b.orbit_cos[lane] = c - s * low;
}

/// Nothing that could be slow or not finite in a lane without a rider.
void leave_empty(LaneBlock& b, int lane) {
  for (int i = 0; i < 8; ++i) b.y[i][lane] = b.carry[i][lane] = 0.0;
  b.t_end[lane] = b.time[lane] = b.time_low[lane] = 0.0, b.unit[lane] = 1.0;
}

void ride_together(const std::vector<Rider*>& riders, const ode::Tolerances& tolerances, long max_steps,
                   const std::function<bool()>& stopped) {
  const BodySeries& first = riders.front()->series();
  const LaneKernels kernels = find_lane_kernels(first.terms(), first.has_attitude());
  const auto block = std::make_unique<LaneBlock>();
  LaneBlock& b = *block;
  b.order = choose_lane_order(tolerances.rtol + tolerances.atol);
  b.rtol = tolerances.rtol, b.atol = tolerances.atol;
  b.damped = first.terms().damped, b.balanced = first.keeps_balance();

  Rider* in[width] = {};
  std::size_t waiting = 0;
  int riding = 0;
  const auto fill = [&](int lane) {
    while (in[lane] != nullptr || waiting < riders.size()) {
      if (in[lane] == nullptr) in[lane] = riders[waiting++];
      if (in[lane]->board(b, lane)) return;
      in[lane] = nullptr;
    }
    leave_empty(b, lane);
    --riding;
  };
  riding = width;
  for (int lane = 0; lane < width; ++lane) fill(lane);

  alignas(64) double s[width], y[8][width];
  for (unsigned round = 1; riding > 0; ++round) {
    if (round % 256 == 0 && stopped()) {
      for (Rider* rider : in)
        if (rider != nullptr) rider->stop();
      for (; waiting < riders.size(); ++waiting) riders[waiting]->stop();
      return;
    }
    for (int lane = 0; lane < width && first.terms().gradient; ++lane)
      if (in[lane] != nullptr) put_orbit(b, lane, in[lane]->series().orbit_phase());
    kernels.step(b);
    for (bool any = true; any;) {
      bool has[width] = {};
      any = false;
      for (int lane = 0; lane < width; ++lane) {
        s[lane] = 0.0;
        const bool moved = in[lane] != nullptr && b.outcome[lane] <= double{lane_arrived};
        has[lane] = moved && in[lane]->has_sample(b, lane, s[lane]);
        any = any || has[lane];
      }
      if (!any) break;
      kernels.sample(b, s, y);
      for (int lane = 0; lane < width; ++lane) {
        if (!has[lane]) continue;
        double column[8];
        for (int i = 0; i < 8; ++i) column[i] = y[i][lane];
        in[lane]->take_sample(column);
      }
    }
    for (int lane = 0; lane < width; ++lane) {
      if (in[lane] == nullptr) continue;
      const auto outcome = static_cast<LaneOutcome>(static_cast<int>(b.outcome[lane]));
      if (!in[lane]->step(outcome, b.time[lane], max_steps)) fill(lane);
    }
  }
}

}  // namespace

LaneKernels find_lane_kernels(const SeriesTerms& terms, bool attitude) {
  LaneKernels found = {nullptr, nullptr};
  const SimdLevel level = simd_level();
  if (level == SimdLevel::avx512) found = avx512_lane_kernels(terms, attitude);
  if (found.step == nullptr && level != SimdLevel::baseline) found = avx2_lane_kernels(terms, attitude);
  return found.step != nullptr ? found : baseline_lane_kernels(terms, attitude);
}

void ride(const std::vector<std::unique_ptr<Rider>>& riders, const ode::Tolerances& tolerances, long max_steps,
          const std::function<bool()>& stopped) {
  std::vector<Rider*> order;
  for (const auto& rider : riders) order.push_back(rider.get());
  std::stable_sort(order.begin(), order.end(), [](const Rider* a, const Rider* b) { return a->kind() < b->kind(); });
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin, order.end(), [&](const Rider* r) { return r->kind() != (*begin)->kind(); });
    ride_together({begin, end}, tolerances, max_steps, stopped);
    begin = end;
  }
  for (const auto& rider : riders) rider->finish();
}

}  // namespace polhode
