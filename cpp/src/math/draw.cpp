#include "polhode/math/draw.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/math/detail/dd_functions.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/normal.hpp"
#include "polhode/math/detail/philox.hpp"

namespace polhode {
namespace {

using math::DD;

constexpr std::uint64_t most_bodies = std::uint64_t{1} << 62;

/// (n + 1/2) / 2^52 of the 52 upper bits: in (0, 1), and 1 minus it is exact.
double fraction_of(std::uint64_t word) { return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52; }

/// A standard normal number: the lowest bit is its sign, the 52 upper bits the probability beyond it.
double normal_of(std::uint64_t word) {
  const double z = math::upper_normal_quantile(0.5 * fraction_of(word));
  return (word & 1) != 0 ? -z : z;
}

/// sin and cos of 2 pi f, 0 <= f <= 1, to a rounding of 2 pi r with |r| <= 1/8.
math::SinCosPair sincos_of_turns(double f) {
  const double quarters = math::rint(4.0 * f), r = f - 0.25 * quarters;
  const math::SinCosPair a = math::sincos(6.283185307179586 * r);
  switch (static_cast<int>(quarters) & 3) {
    case 0: return a;
    case 1: return {a.cos, -a.sin};
    case 2: return {-a.sin, -a.cos};
    default: return {-a.cos, a.sin};
  }
}

void draw_direction(const std::array<std::uint64_t, DrawStream::words>& words, double* v) {
  // The height is uniform (Archimedes).
  const double height = 2.0 * fraction_of(words[0]) - 1.0, radius = std::sqrt((1.0 - height) * (1.0 + height));
  const math::SinCosPair unit = sincos_of_turns(fraction_of(words[1]));
  v[0] = radius * unit.cos, v[1] = radius * unit.sin, v[2] = height;
}

/// Shoemake 1992, Graphics Gems III, 124.
void draw_attitude(const std::array<std::uint64_t, DrawStream::words>& words, double* q) {
  const double u = fraction_of(words[0]), a = std::sqrt(1.0 - u), b = std::sqrt(u);
  const math::SinCosPair first = sincos_of_turns(fraction_of(words[1]));
  const math::SinCosPair second = sincos_of_turns(fraction_of(words[2]));
  q[0] = a * first.sin, q[1] = a * first.cos, q[2] = b * second.sin, q[3] = b * second.cos;
}

void draw_rotation(const double* deviation, const std::array<std::uint64_t, DrawStream::words>& words, double* q) {
  double v[3], square = 0.0;
  for (std::size_t i = 0; i < 3; ++i) v[i] = deviation[i] * normal_of(words[i]), square = square + v[i] * v[i];
  const double angle = std::sqrt(square);
  const math::SinCosPair half = math::sincos(0.5 * angle);
  const double slope = angle < 1e-8 ? 0.5 : half.sin / angle;   // (angle / 2)^2 / 6 is below rounding
  for (std::size_t i = 0; i < 3; ++i) q[i] = slope * v[i];
  q[3] = half.cos;
}

std::size_t columns_of(Distribution distribution) {
  constexpr std::size_t columns[] = {2, 2, 2, 4, 0, 0, 3};
  return columns[static_cast<std::size_t>(distribution)];
}

[[noreturn]] void refuse_draw(std::size_t row, const char* what, const std::string& got) {
  throw InvalidInput("parameters[" + std::to_string(row) + "]", what, got);
}

}  // namespace

std::uint64_t draw_key(std::string_view quantity) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char letter : quantity) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  return hash;
}

std::array<std::uint64_t, DrawStream::words> DrawStream::operator()(std::uint64_t body) const {
  // NumPy counts up before it takes four words.
  const auto a = math::philox({2 * body + 1, attempt, 0, 0}, {seed, key});
  const auto b = math::philox({2 * body + 2, attempt, 0, 0}, {seed, key});
  return {a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]};
}

Draw::Draw(Distribution distribution, const double* parameters, std::size_t rows, std::size_t columns)
    : distribution_(distribution), width_(rows) {
  using enum Distribution;
  const std::size_t needed = columns_of(distribution);
  if (distribution == sphere) width_ = 3;
  if (distribution == attitude || distribution == rotation) width_ = 4;
  const bool own = needed == 0 || distribution == rotation;
  if (own ? rows * columns != needed : columns != needed || rows == 0 || rows > DrawStream::words) {
    throw InvalidInput("parameters", "of shape (" + std::string(own ? "1" : "components up to 8") + ", " +
                                         std::to_string(needed) + ") for this distribution",
                       "(" + std::to_string(rows) + ", " + std::to_string(columns) + ")");
  }
  for (std::size_t i = 0; i < (needed == 0 ? 0 : rows); ++i) {
    const double* p = parameters + needed * i;
    for (std::size_t j = 0; j < needed; ++j) {
      if (std::isnan(p[j]) || (std::isinf(p[j]) && !(distribution == truncated_normal && j >= 2)))
        refuse_draw(i, "finite", to_text(p[j]));
    }
    Component c{};
    c.a = p[0], c.b = p[1], c.low = p[0], c.high = p[1];
    if ((distribution == uniform || distribution == log_uniform) && !(c.low <= c.high))
      refuse_draw(i, "low <= high", to_text(c.low) + ", " + to_text(c.high));
    if ((distribution == normal || distribution == truncated_normal) && !(c.b >= 0.0))
      refuse_draw(i, "a standard deviation of 0 or more", to_text(c.b));
    if (distribution == log_uniform) {
      if (!(c.low > 1e-290 && c.high < 1e290 && c.high / c.low < 1e300))
        refuse_draw(i, "positive bounds within 1e-290 and 1e290, at most 1e300 apart",
                    to_text(c.low) + ", " + to_text(c.high));
      const DD ratio = math::log_dd(DD(c.high)) - math::log_dd(DD(c.low));
      c.log_ratio[0] = ratio.hi, c.log_ratio[1] = ratio.lo;
    }
    if (distribution == truncated_normal) {
      c.low = p[2], c.high = p[3];
      if (!(c.low <= c.high)) refuse_draw(i, "low <= high", to_text(c.low) + ", " + to_text(c.high));
      const double bounds[] = {(c.low - c.a) / c.b, (c.high - c.a) / c.b};
      if (c.b > 0.0 ? !(bounds[0] < 37.0 && bounds[1] > -37.0) : !(c.low <= c.a && c.a <= c.high))
        refuse_draw(i, "bounds within 37 standard deviations of the mean", to_text(c.low) + ", " + to_text(c.high));
      for (std::size_t j = 0; j < 2 && c.b > 0.0; ++j)
        c.lower[j] = math::upper_normal_tail(-bounds[j]), c.upper[j] = math::upper_normal_tail(bounds[j]);
    }
    if (distribution == rotation) {
      for (std::size_t j = 0; j < 3; ++j)
        if (!(p[j] >= 0.0)) refuse_draw(i, "standard deviations of 0 or more", to_text(p[j]));
      c.low = p[2];
    }
    components_.push_back(c);
  }
}

double Draw::component(const Component& c, std::uint64_t word) const {
  switch (distribution_) {
    case Distribution::uniform: {
      const double u = fraction_of(word);
      return std::clamp(c.low * (1.0 - u) + c.high * u, c.low, c.high);
    }
    case Distribution::normal:
      return c.a + c.b * normal_of(word);
    case Distribution::log_uniform: {
      const DD power = math::exp_dd(DD(c.log_ratio[0], c.log_ratio[1]) * DD(fraction_of(word)));
      return std::clamp((power * DD(c.low)).hi, c.low, c.high);
    }
    default: {
      if (c.b == 0.0) return c.a;
      // The probabilities below and above, each without a difference: the smaller gives the number.
      const double u = fraction_of(word), below = c.lower[0] * (1.0 - u) + c.lower[1] * u;
      const double above = c.upper[0] * (1.0 - u) + c.upper[1] * u;
      const double z = math::upper_normal_quantile(std::min({below, above, 0.5}));
      return std::clamp(c.a + c.b * (below < above ? -z : z), c.low, c.high);
    }
  }
}

void Draw::operator()(const DrawStream& stream, std::uint64_t first, std::size_t count, double* values) const {
  if (first > most_bodies || count > most_bodies - first) {
    throw InvalidInput("first", "such that bodies are below 2^62", std::to_string(first));
  }
  for (std::size_t i = 0; i < count; ++i, values += width_) {
    if (i % 4096 == 0) check_interrupt();
    const auto words = stream(first + i);
    if (distribution_ == Distribution::sphere) {
      draw_direction(words, values);
    } else if (distribution_ == Distribution::attitude) {
      draw_attitude(words, values);
    } else if (distribution_ == Distribution::rotation) {
      const double deviation[] = {components_[0].a, components_[0].b, components_[0].low};
      draw_rotation(deviation, words, values);
    } else {
      for (std::size_t k = 0; k < width_; ++k) values[k] = component(components_[k], words[k]);
    }
  }
}

}  // namespace polhode
