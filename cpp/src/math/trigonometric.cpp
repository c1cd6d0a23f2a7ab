#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "math/quarter_turns.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::math {
namespace {

constexpr double quarter = 0.7853981633974483;   // pi / 4
constexpr double tiny = 0x1p-27;                 // below it sin(x) = x and cos(x) = 1 to 0.51 ulp

/// c[0] + c[1] y + ... + c[6] y^6 in pairs that need not wait for one another.
double sum_of_seven(const double (&c)[7], double y) {
  const double y2 = y * y;
  return ((c[0] + c[1] * y) + (c[2] + c[3] * y) * y2) + ((c[4] + c[5] * y) + c[6] * y2) * (y2 * y2);
}

/// sin and cos of r + low on |r| <= pi / 4 by their Taylor series. The first terms are taken beyond double: `head` is r
/// to 9 bits, so that its powers are exact, and 1/6 and 1/24 have two parts.
struct Kernel {
  double r, low, head, head2, extra, y;

  Kernel(double rest, double below) : r(rest), low(below) {
    head = std::bit_cast<double>(std::bit_cast<std::uint64_t>(r) & ~((std::uint64_t{1} << 44) - 1));
    head2 = head * head;
    extra = (r - head) * (r + head);
    y = head2 + extra;
  }

  double sin() const {
    constexpr double c[] = {1.0 / 120,        -1.0 / 5040,          1.0 / 362880,        -1.0 / 39916800,
                            1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
    const double cube = head2 * head, main = cube * 0x1.555555p-3;   // r^3 / 6
    const double rest = cube * 0x1.5555555555555p-29 + (r - head) * (y + r * head + head2) * (1.0 / 6);
    const double s = r - main, lost = (r - s) - main;
    return s + (lost + ((r * (y * y)) * sum_of_seven(c, y) - rest + low * (1.0 - 0.5 * y)));
  }

  double cos() const {
    constexpr double c[] = {-1.0 / 720,         1.0 / 40320,          -1.0 / 3628800,     1.0 / 479001600,
                            -1.0 / 87178291200, 1.0 / 20922789888000, -1.0 / 6402373705728000};
    const double half = 0.5 * head2, first = 1.0 - half, lost = (1.0 - first) - half;
    const double quartic = head2 * head2, main = quartic * 0x1.5555p-5;   // r^4 / 24
    const double s = first + main, lost2 = main - (s - first);
    const double rest = quartic * 0x1.5555555555555p-23 + extra * (y + head2) * (1.0 / 24) - 0.5 * extra;
    return s + ((lost + lost2) + (rest + (y * y * y) * sum_of_seven(c, y) - low * r * (1.0 - (1.0 / 6) * y)));
  }
};

/// Whole quarter turns are taken from an angle.
POLHODE_INLINE QuarterTurns reduce(double angle) {
  const double size = abs(angle);
  if (size <= quarter) return {angle, 0.0, 0};
  if (size <= 1e5) {
    // pi / 2 in two parts of 33 bits, whose products with that many quarters are exact, and a rest: Cody & Waite 1980.
    const double shifted = angle * 0.6366197723675814 + 0x1.8p52, n = shifted - 0x1.8p52;
    const DD rest = two_diff(angle - n * 0x1.921fb544p+0, n * 0x1.0b4611a6p-34);
    if (abs(rest.hi) > 0x1p-40) {
      return {rest.hi, rest.lo - n * 0x1.3198a2e037073p-69,
              static_cast<unsigned>(std::bit_cast<std::uint64_t>(shifted)) & 3u};
    }
  }
  return reduce_exactly(angle);
}

double change_sign_if(bool mask, double a) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) ^ (std::uint64_t{mask} << 63));
}

double sine_of(const Kernel& kernel, unsigned quarters) {
  return change_sign_if((quarters & 2) != 0, (quarters & 1) != 0 ? kernel.cos() : kernel.sin());
}

/// atan(k / 16).
constexpr double base_angle[17][2] = {{0.0, 0.0},
                                      {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
                                      {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                      {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
                                      {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                      {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
                                      {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                      {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
                                      {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                      {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
                                      {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                      {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
                                      {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                      {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
                                      {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                      {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
                                      {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

/// a to 26 bits: products of two such numbers are exact.
double leading_bits(double a) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) & ~((std::uint64_t{1} << 27) - 1));
}

/// The angle of (x, y), 0 <= y <= x (1 + 1e-15), x > 0: a base angle, and of t = (y - k x / 16) / (x + k y / 16), with
/// |t| <= 1/32, the series. t has two parts, of 26 bits and of what is missing.
DD angle_in_octant(DD y, DD x) {
  const int k = static_cast<int>(16.0 * (y.hi / x.hi) + 0.5);
  const double slope = k * 0.0625, x_head = leading_bits(x.hi), y_head = leading_bits(y.hi);
  const DD n = two_diff(y.hi, slope * x_head), sum_d = fast_two_sum(x.hi, slope * y_head);
  const double n_low = n.lo + ((y.lo - slope * x.lo) - slope * (x.hi - x_head));
  const DD d = fast_two_sum(sum_d.hi, sum_d.lo + (slope * (y.hi - y_head) + (x.lo + slope * y.lo)));
  const double inverse = 1.0 / d.hi, t = leading_bits(n.hi * inverse), d_head = leading_bits(d.hi);
  const double t_low = (((n.hi - t * d_head) - t * (d.hi - d_head)) + (n_low - t * d.lo)) * inverse;
  const double whole = t + t_low, z = whole * whole, z2 = z * z;
  const double series =
      whole * z * (((-1.0 / 3) + (1.0 / 5) * z) + ((-1.0 / 7) + (1.0 / 9) * z + (-1.0 / 11) * z2) * z2);
  const DD sum = fast_two_sum(base_angle[k][0], t);
  return fast_two_sum(sum.hi, sum.lo + (base_angle[k][1] + (t_low + series)));
}

/// The angle of (x, y) or of (-x, y), x, y >= 0, not both 0: one of 0, pi / 2, pi plus or less an angle in an octant.
double angle_in_half_plane(DD y, DD x, bool left) {
  constexpr double base[4][3] = {{0.0, 0.0, 1.0},
                                 {1.5707963267948966, 6.123233995736766e-17, -1.0},
                                 {3.141592653589793, 1.2246467991473532e-16, -1.0},
                                 {1.5707963267948966, 6.123233995736766e-17, 1.0}};
  const bool steep = y.hi > x.hi;
  const DD angle = angle_in_octant(select(steep, x, y), select(steep, y, x));
  const double* from = base[2 * left + steep];
  const DD sum = fast_two_sum(from[0], from[2] * angle.hi);
  return sum.hi + (sum.lo + (from[1] + from[2] * angle.lo));
}

/// sqrt(1 - x^2), |x| <= 1.
DD other_leg(double x) { return sqrt(two_diff(1.0, x) * two_sum(1.0, x)); }

}  // namespace

SinCosPair sincos(double angle) {
  if (abs(angle) < tiny) return {angle, 1.0};
  if (!std::isfinite(angle)) return {angle - angle, angle - angle};
  const QuarterTurns q = reduce(angle);
  const Kernel kernel(q.rest, q.low);
  const double s = kernel.sin(), c = kernel.cos();
  const bool odd = (q.quarters & 1) != 0;
  return {change_sign_if((q.quarters & 2) != 0, select(odd, c, s)),
          change_sign_if(((q.quarters + 1) & 2) != 0, select(odd, s, c))};
}

double sin(double angle) {
  if (abs(angle) < tiny) return angle;
  if (!std::isfinite(angle)) return angle - angle;
  const QuarterTurns q = reduce(angle);
  return sine_of(Kernel(q.rest, q.low), q.quarters);
}

double cos(double angle) {
  if (abs(angle) < tiny) return 1.0;
  if (!std::isfinite(angle)) return angle - angle;
  const QuarterTurns q = reduce(angle);
  return sine_of(Kernel(q.rest, q.low), q.quarters + 1);
}

double atan2(double y, double x) {
  constexpr double least = 0x1p-500, largest = 0x1p500;
  double ay = abs(y), ax = abs(x);
  if (!(ay > least && ay < largest && ax > least && ax < largest)) {
    if (std::isnan(x) || std::isnan(y)) return x + y;
    if (ay == 0.0 || (std::isinf(ax) && !std::isinf(ay))) return copysign(std::signbit(x) ? pi<double>() : 0.0, y);
    if (std::isinf(ay)) {
      ax = std::isinf(ax) ? 1.0 : 0.0, ay = 1.0;
    } else {
      // Far below the x axis's length the angle is the quotient, which may be below the normal numbers.
      if (!std::signbit(x) && ay < 0x1p-28 * ax) return y / x;
      int exponent = 0;
      std::frexp(max(ax, ay), &exponent);
      ay = std::ldexp(ay, -exponent), ax = std::ldexp(ax, -exponent);
    }
  }
  return copysign(angle_in_half_plane(ay, ax, std::signbit(x)), y);
}

double atan(double x) { return atan2(x, 1.0); }

double asin(double x) {
  const double size = abs(x);
  if (size < tiny) return x;
  if (!(size <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  return copysign(angle_in_half_plane(size, other_leg(x), false), x);
}

double acos(double x) {
  const double size = abs(x);
  if (!(size <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  return angle_in_half_plane(other_leg(x), size, std::signbit(x));
}

double hypot(double a, double b, double c) {
  const double large = max(max(abs(a), abs(b)), abs(c));
  if (std::isinf(a) || std::isinf(b) || std::isinf(c)) return std::numeric_limits<double>::infinity();
  if (large == 0.0 || std::isnan(a + b + c)) return large + abs(a + b + c);
  if (large > 0x1p450 || large < 0x1p-450) {
    int exponent = 0;
    std::frexp(large, &exponent);
    return std::ldexp(hypot(std::ldexp(a, -exponent), std::ldexp(b, -exponent), std::ldexp(c, -exponent)), exponent);
  }
  return sqrt(plus(plus(two_prod(a, a), two_prod(b, b)), two_prod(c, c))).hi;
}

double hypot(double a, double b) { return hypot(a, b, 0.0); }

}  // namespace polhode::math
