/// A body on an orbit with magnets, plates and a driven wheel, as world_momentum.cpp and world_rates.cpp read it, and
/// the walk from switch to switch that both share. 113 bits, or 53 with -DFLOORS. worlds_reference.py writes the input.
#pragma once

#include <quadmath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#ifdef FLOORS
using Real = double;
inline Real read_number(const char* text) { return std::strtod(text, nullptr); }
inline void print_number(Real x) { std::printf("%.17e ", x); }
using std::sqrt, std::sin, std::cos, std::exp, std::sinh, std::cosh, std::log;
#else
using Real = __float128;
inline Real read_number(const char* text) { return strtoflt128(text, nullptr); }
inline void print_number(Real x) {
  char text[64];
  quadmath_snprintf(text, sizeof text, "%.36Qe", x);
  std::printf("%s ", text);
}
inline Real sqrt(Real x) { return sqrtq(x); }
inline Real sin(Real x) { return sinq(x); }
inline Real cos(Real x) { return cosq(x); }
inline Real exp(Real x) { return expq(x); }
inline Real sinh(Real x) { return sinhq(x); }
inline Real cosh(Real x) { return coshq(x); }
inline Real log(Real x) { return logq(x); }
#endif

inline Real absolute(Real x) { return x < 0 ? -x : x; }

using Vector = std::array<Real, 3>;
using State = std::vector<Real>;

inline Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator*(Real k, const Vector& a) { return {k * a[0], k * a[1], k * a[2]}; }
inline Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Plate {
  Real area;
  Vector normal, centre;
  Real specular, diffuse;
};

/// All numbers of a scene. What is absent is 0.
struct World {
  Vector moments{}, omega{}, r0{}, v0{}, moment{}, sun{};
  std::array<Real, 4> attitude{0, 0, 0, 1};
  Real mu = 0, q = 0, e = 0, inclination = 0, node = 0, periapsis = 0, mean = 0;   // the mean anomaly at time 0
  Real strength = 0, tilt = 0, field_spin = 0, phase = 0;
  Real coefficient = 0, density = 0, height_radius = 0, scale_height = 0, air_spin = 0, pressure = 0, shadow = 0;
  std::vector<Plate> air, light;
  Vector axis{};
  Real inertia = 0, viscous = 0, coulomb = 0, ramp = 0, max_torque = 0, max_speed = 0;
  std::vector<Real> options, times;

  static World read() {
    World w;
    const auto number = [] {
      std::string word;
      if (!(std::cin >> word)) std::exit((std::fputs("a number is missing\n", stderr), 1));
      return read_number(word.c_str());
    };
    const auto fill = [&](auto&&... x) { ((x = number()), ...); };
    const auto rows = [&](auto& list, auto&& one) {
      for (int left = static_cast<int>(number()); left > 0; --left) list.push_back(one());
    };
    const auto vector = [&] { return Vector{number(), number(), number()}; };
    const auto plate = [&] { return Plate{number(), vector(), vector(), number(), number()}; };
    for (std::string key; std::cin >> key;) {
      if (key == "body") w.moments = vector(), w.omega = vector(), fill(w.attitude[0], w.attitude[1], w.attitude[2],
                                                                        w.attitude[3]);
      else if (key == "orbit") fill(w.mu, w.q, w.e, w.inclination, w.node, w.periapsis, w.mean), w.r0 = vector(),
          w.v0 = vector();
      else if (key == "dipole") w.moment = vector(), fill(w.strength, w.tilt, w.field_spin, w.phase);
      else if (key == "drag") {
        fill(w.coefficient, w.density, w.height_radius, w.scale_height, w.air_spin), rows(w.air, plate);
      } else if (key == "solar_pressure") w.sun = vector(), fill(w.pressure, w.shadow), rows(w.light, plate);
      else if (key == "rotor") {
        w.axis = vector(), fill(w.inertia, w.viscous, w.coulomb, w.ramp, w.max_torque, w.max_speed);
      } else if (key == "options") rows(w.options, number);
      else if (key == "times") rows(w.times, number);
      else std::exit((std::fprintf(stderr, "unknown key: %s\n", key.c_str()), 1));
    }
    return w;
  }
};

enum class Wheel { kStuck, kSliding, kTop };

/// The sides of all guards, and how the wheel runs. A guard is positive on side 1.
struct Sides {
  std::vector<int> sides;
  std::vector<Real> guards;
  std::vector<bool> jumps;   // whether a torque jumps there: its time needs all digits, a kink's only half of them
  std::size_t next = 0;
  Wheel wheel = Wheel::kStuck;
  Real needed = 0, speed = 0;   // of a stuck wheel; at the top

  /// Notes a guard, and whether its side is the positive one.
  bool is_positive(Real guard, bool is_jump = false) {
    if (guards.size() <= next) guards.push_back(0), sides.push_back(guard > 0 ? 1 : -1), jumps.push_back(is_jump);
    guards[next] = guard;
    return sides[next++] > 0;
  }
  /// Begins a look at all guards. With a wheel the first one is that of its mode.
  void begin(bool has_wheel) { next = has_wheel ? 1 : 0; }
  void note_mode(Real guard) { guards[0] = guard; }
};

/// Walks to all times. A route has rate(t, y, sides), step(t, y, h, sides), which may refuse, and changed(y, sides),
/// which is called where the wheel's mode ended.
template <class Route>
class Walk {
 public:
  Walk(const Route& route, State start, Real longest) : route_(route), y_(std::move(start)), longest_(longest) {
    if (route_.world.inertia > 0) sides_.guards.push_back(1), sides_.sides.push_back(1), sides_.jumps.push_back(true);
    route_.rate(t_, y_, sides_);
  }

  void follow(Real end) {
    Real h = longest_;
    while (t_ < end) {
      if (end - t_ < h * Real(1.0000001L)) h = end - t_;
      const bool last = h == end - t_;
      State next;
      Real taken = h;
      if (!attempt(taken, next)) {
        h /= 2;
        if (h < longest_ * Real(1e-9L)) std::exit((std::fputs("no step is accepted\n", stderr), 1));
        continue;
      }
      if (is_back() && h > longest_ * Real(1e-8L)) {   // a guard left its new side within the step
        h /= 2;
        continue;
      }
      if (const Real dip = find_dip(taken, next); dip < taken) {
        taken = dip;
        if (!attempt(taken, next)) std::exit((std::fputs("a shorter step is refused\n", stderr), 1));
      }
      const std::size_t crossed = find_crossing(taken, next);
      t_ = last && taken == h ? end : t_ + taken, y_ = next;
      just_.assign(sides_.guards.size(), false);
      if (crossed < sides_.guards.size()) cross(crossed);
      h = longest_;
      ++steps;
    }
  }

  const State& state() const { return y_; }
  Sides& sides() { return sides_; }
  long steps = 0, crossings = 0;

 private:
  bool attempt(Real h, State& to) {
    to = y_;
    if (h != 0 && !route_.step(t_, to, h, sides_)) return false;
    route_.rate(t_ + h, to, sides_);
    return true;
  }

  bool is_back() const {
    for (std::size_t i = 0; i < just_.size(); ++i)
      if (just_[i] && !(sides_.guards[i] * sides_.sides[i] > 0)) return true;
    return false;
  }

  Real slope(Real t, const State& y, std::size_t i) {
    const Real small = longest_ * Real(1e-9L);
    const State f = route_.rate(t, y, sides_);
    State a = y, b = y;
    for (std::size_t k = 0; k < y.size(); ++k) a[k] -= small * f[k], b[k] += small * f[k];
    route_.rate(t + small, b, sides_);
    const Real up = sides_.guards[i];
    route_.rate(t - small, a, sides_);
    return (up - sides_.guards[i]) / (2 * small);
  }

  /// Where a guard comes near 0 within the step and leaves it again: the minimum of the cubic through both ends.
  Real find_dip(Real h, const State& to) {
    route_.rate(t_, y_, sides_);
    const std::vector<Real> begin = sides_.guards;
    route_.rate(t_ + h, to, sides_);
    const std::vector<Real> end = sides_.guards;
    Real found = h;
    for (std::size_t i = 0; i < end.size(); ++i) {
      const int side = sides_.sides[i];
      if (!(end[i] * side > 0) || (i < just_.size() && just_[i])) continue;
      const Real a = begin[i] * side, b = end[i] * side, da = slope(t_, y_, i) * side * h,
                 db = slope(t_ + h, to, i) * side * h;
      if (!(da < 0 && db > 0)) continue;
      for (int k = 1; k < 64; ++k) {
        const Real s = Real(k) / 64, m = 1 - s;
        const Real value = a * (1 + 2 * s) * m * m + da * s * m * m + b * s * s * (3 - 2 * s) - db * s * s * m;
        if (value < Real(0.02L) * std::max(a, b) && s * h < found && k > 2) found = s * h;
      }
    }
    route_.rate(t_ + h, to, sides_);
    return found;
  }

  /// Shortens the step to the first crossing, if there is one.
  std::size_t find_crossing(Real& h, State& to) {
    const std::vector<Real> end = sides_.guards;
    route_.rate(t_, y_, sides_);
    const std::vector<Real> begin = sides_.guards;
    std::size_t crossed = end.size();
    const Real whole = h;
    for (std::size_t i = 0; i < end.size(); ++i) {
      // One that begins on the wrong side was crossed just now, and rounding left it there.
      if (end[i] * sides_.sides[i] > 0 || !(begin[i] * sides_.sides[i] > 0)) continue;
      const Real root = find_root(i, whole);
      if (root <= h) h = root, crossed = i;
    }
    attempt(h, to);
    return crossed;
  }

  /// By the inverse polynomial through the last points within a bracket, or by its middle.
  Real find_root(std::size_t i, Real whole) {
    State to;
    std::vector<Real> at, values;
    const auto look = [&](Real h) {
      if (!attempt(h, to)) std::exit((std::fputs("a shorter step is refused\n", stderr), 1));
      at.push_back(h), values.push_back(sides_.guards[i] * sides_.sides[i]);
      return values.back();
    };
    const Real fine = whole * (sides_.jumps[i] ? kFine : kHalfFine);
    Real a = 0, b = whole;
    if (!(look(0) > 0)) std::exit((std::fputs("a guard starts on the wrong side\n", stderr), 1));
    look(whole);
    for (int k = 0; k < 200; ++k) {
      Real next = predict(at, values);
      if (!(a < next && next < b) || k % 12 == 11) next = (a + b) / 2;
      if (b - a <= fine || absolute(next - at.back()) <= fine) return next;
      if (look(next) > 0) a = next;
      else b = next;
    }
    return b;
  }

  static Real predict(const std::vector<Real>& at, const std::vector<Real>& values) {
    const std::size_t count = std::min<std::size_t>(at.size(), 6), from = at.size() - count;
    std::vector<Real> row(at.begin() + static_cast<long>(from), at.end());   // Neville's rows, at value 0
    for (std::size_t k = 1; k < count; ++k)
      for (std::size_t j = 0; j + k < count; ++j) {
        const Real low = values[from + j], high = values[from + j + k];
        row[j] = (high * row[j] - low * row[j + 1]) / (high - low);
      }
    return row[0];
  }

  void cross(std::size_t i) {
    ++crossings;
    if (route_.world.inertia > 0 && i == 0) {
      route_.changed(y_, sides_);
      route_.rate(t_, y_, sides_);
      return;
    }
    // The same expression stands in several switches: opposite plates.
    const Real size = absolute(sides_.guards[i]);
    for (std::size_t k = 0; k < sides_.guards.size(); ++k)
      if (k == i || (absolute(sides_.guards[k]) == size && size > 0)) sides_.sides[k] *= -1, just_[k] = true;
    for (std::size_t k = 0; k < sides_.guards.size(); ++k)
      if (size == 0 && sides_.guards[k] == 0 && k != i) sides_.sides[k] *= -1, just_[k] = true;
  }

#ifdef FLOORS
  static constexpr Real kFine = 1e-15, kHalfFine = 1e-9;
#else
  static constexpr Real kFine = Real(1e-30L), kHalfFine = Real(1e-17L);
#endif
  const Route& route_;
  State y_;
  Sides sides_;
  Real t_ = 0, longest_;
  std::vector<bool> just_;
};

/// Prints rows of all sample times: omega, then the attitude as the route has it, then the wheel's speed.
template <class Route>
void run(const Route& route, Real longest) {
  Walk<Route> walk(route, route.start(), longest);
  for (const Real t : route.world.times) {
    walk.follow(t);
    for (const Real x : route.output(t, walk.state(), walk.sides())) print_number(x);
    std::puts("");
  }
  std::fprintf(stderr, "%ld steps, %ld crossings\n", walk.steps, walk.crossings);
}
