#include <cmath>

#include "polhode/formula/detail/functions.hpp"
#include "polhode/formula/tape.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::formula {

RecurrenceStart start_recurrence(const Recurrence& operation, double a, double b) {
  switch (operation.rule) {
    case Rule::product: return {a * b, 1.0, b, a};
    case Rule::quotient: {
      const double inverse = 1.0 / b, z = a / b;
      return {z, -inverse, inverse, -z * inverse};
    }
    case Rule::root: {
      const double z = std::sqrt(a), half = 0.5 / z;
      return {z, -half, half, 0.0};
    }
    case Rule::exponential: {
      const double z = compute_exp(a);
      return {z, 1.0, z, 0.0};
    }
    case Rule::logarithm: return {math::log(a), -1.0 / a, 1.0 / a, 0.0};
    case Rule::sine: {
      const auto [s, c] = math::sincos(a);
      return {s, 1.0, c, 0.0};
    }
    case Rule::cosine: {
      const auto [s, c] = math::sincos(a);
      return {c, -1.0, -s, 0.0};
    }
    case Rule::tanh: {
      const TanhPair pair = compute_tanh(a);
      return {pair.value, -1.0, pair.slope, 0.0};
    }
    case Rule::integral: return {0.0, 1.0, b, 0.0};
    case Rule::power_helper: return {0.0, 1.0, 0.0, 0.0};
    case Rule::power: {
      const double z = math::pow(a, operation.constant), slope = operation.constant / a;
      return {z, -1.0 / a, slope * z, slope};
    }
    case Rule::angle: {
      const double inverse = 1.0 / (a * a + b * b);
      return {math::atan2(a, b), -inverse, inverse, -inverse};
    }
  }
  return {};
}

void fill_wave(const Wave& wave, math::DD t, double unit, int order, double* rows, int stride) {
  // In double-double, because the error of a rounded angle would grow with the number of revolutions.
  const math::DD product = math::two_prod(wave.rate, t.hi), angle = math::two_sum(product.hi, wave.phase);
  const double low = angle.lo + product.lo + wave.rate * t.lo;
  const auto [s0, c0] = math::sincos(angle.hi);
  // The square counts from some 1e7 revolutions on.
  const double square = 0.5 * low * low, step = wave.rate * unit;
  const double s = s0 + (c0 * low - s0 * square), c = c0 - (s0 * low + c0 * square);
  const double cycle[4] = {s, c, -s, -c};
  double factor = 1.0;
  for (int n = 0; n <= order; ++n) {
    if (n > 0) factor = factor * step / n;
    rows[n * stride] = factor * cycle[(n + (wave.cosine ? 1 : 0)) % 4];
  }
}

void Tape::fill_waves(math::DD t, double unit, int order, const std::vector<std::ptrdiff_t>& places, double* rows,
                      std::ptrdiff_t stride) const {
  const auto for_each = [&](int first, int end, const auto& use) {
    for (std::size_t i = 0; i < waves_.size(); ++i)
      if (places[i] >= 0 && waves_[i].seen >= first && waves_[i].seen < end) use(waves_[i], rows + places[i]);
  };
  for_each(-1, 0, [&](const Wave& wave, double* to) { fill_wave(wave, t, unit, order, to, static_cast<int>(stride)); });
  std::vector<double> known;
  for (int i = 0; i < static_cast<int>(ephemerides_.size()); ++i) {
    const int first = Ephemeris::size * i;
    bool is_used = false;
    for_each(first, first + Ephemeris::size, [&](const Wave&, double*) { is_used = true; });
    if (!is_used) continue;
    known.resize(static_cast<std::size_t>(Ephemeris::size * (order + 1)));
    ephemerides_[static_cast<std::size_t>(i)].path()->expand(t, unit, order, known.data());
    for_each(first, first + Ephemeris::size, [&](const Wave& wave, double* to) {
      const double* from = known.data() + (wave.seen - first);
      for (int n = 0; n <= order; ++n) to[stride * n] = from[Ephemeris::size * n];
    });
  }
}

}  // namespace polhode::formula
