// The detumbling loop of a picosatellite stepped by RK4 with a fixed step, for benchmarks/detumble.py.
//
// Its numbers are those of the public simulator rfonod/detumbling-simulator (main_old.m, propag_att.m, dist_aer.m), with
// which Fonod and Gill 2018, IAC-18-C1.3.11, was computed: a tick each 0.25 s, in which RK4 takes `steps` steps.
//
//   detumble_rk4 FIELD BODIES STEPS DRAG > RESULTS
//
// FIELD: for each tick B [uT] and v [m/s] in space axes, six doubles. BODIES: for each body moments (3), largest dipoles
// (3), residual dipole (3), biases of two magnetometers (6) [uT]. RESULTS: for each body the time at which all rates are
// below 5 deg/s, the time at which the law says so, and the seconds that the coils were on until each (3 and 3).
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

using V = std::array<double, 3>;
constexpr double tick = 0.25, pi = 3.14159265358979323846;

V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double norm(const V& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

struct Body {
  V moments, most, residual, bias[2];
};

struct State {
  double q[4];
  V w;
};

V to_body(const double* q, const V& v) {
  const V p{q[0], q[1], q[2]}, c = cross(p, v), cc = cross(p, c);
  return {v[0] + 2 * cc[0] - 2 * q[3] * c[0], v[1] + 2 * cc[1] - 2 * q[3] * c[1], v[2] + 2 * cc[2] - 2 * q[3] * c[2]};
}
V to_space(const double* q, const V& v) {
  const double back[4] = {-q[0], -q[1], -q[2], q[3]};
  return to_body(back, v);
}

/// The drag of the simulator: face normals are rotated as vectors of space are.
V find_drag(const double* q, const V& v) {
  constexpr double rho = 2.005e-12, drag = 2.1, area[3] = {(0.05 + 0.0016) * 0.178 + (0.192 - 0.178) * 0.0016,
                                                           0.064 * 0.192, 0.05 * 0.05 + (0.064 - 0.05) * 0.0016};
  const double size = norm(v), pressure = 0.5 * drag * rho * size * size;
  const V unit{v[0] / size, v[1] / size, v[2] / size}, seen = to_body(q, unit), faces = to_space(q, unit);
  double force = 0.0;
  for (int i = 0; i < 3; ++i) force -= pressure * std::abs(faces[static_cast<std::size_t>(i)]) * area[i];
  const V arm = cross(seen, V{0.0054, 0.0020, -0.0082});
  return {force * arm[0], force * arm[1], force * arm[2]};
}

State find_rates(const State& s, const Body& body, const V& dipole, const V& field_T, const V& velocity, bool drag) {
  const V b = to_body(s.q, field_T), magnetic = cross(dipole, b);
  const V aero = drag ? find_drag(s.q, velocity) : V{};
  const V& J = body.moments;
  State d;
  const double *q = s.q, x = s.w[0], y = s.w[1], z = s.w[2];
  d.w = {(magnetic[0] + aero[0] + (J[1] - J[2]) * y * z) / J[0], (magnetic[1] + aero[1] + (J[2] - J[0]) * z * x) / J[1],
         (magnetic[2] + aero[2] + (J[0] - J[1]) * x * y) / J[2]};
  d.q[0] = 0.5 * (z * q[1] - y * q[2] + x * q[3]), d.q[1] = 0.5 * (-z * q[0] + x * q[2] + y * q[3]);
  d.q[2] = 0.5 * (y * q[0] - x * q[1] + z * q[3]), d.q[3] = 0.5 * (-x * q[0] - y * q[1] - z * q[2]);
  return d;
}

State add(const State& s, const State& d, double h) {
  State out;
  for (int i = 0; i < 4; ++i) out.q[i] = s.q[i] + h * d.q[i];
  for (std::size_t i = 0; i < 3; ++i) out.w[i] = s.w[i] + h * d.w[i];
  return out;
}

struct Result {
  double rates = NAN, law = NAN;
  V on_rates{}, on_law{};
};

Result run(const Body& body, const std::vector<double>& field, int steps, bool drag, unsigned seed) {
  constexpr double duty = 0.6, rise = 0.01, filter = 1.0 / 200, low = 0.065 / 8, high = 0.085 / 8, slow = 5 * pi / 180;
  const double n = std::sqrt(3.9860044181e14 / std::pow(6378137.0 + 350e3, 3)), inclination = 96.84895 * pi / 180,
               tilt = 11.44 * pi / 180, nominal = 0.00026386;
  const double gain = 2e6 * n * (1 + std::sin(std::acos(std::cos(inclination) * std::cos(tilt) + std::sin(inclination) * std::sin(tilt)))) * nominal;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  State s{{1, 0, 0, 0}, {pi, pi, pi}};
  V old{}, tumble{0.25, 0.25, 0.25}, on{};
  bool first = true, acting = true;
  int calm = 0, wild = 0;
  Result found;
  const std::size_t ticks = field.size() / 6;
  for (std::size_t k = 0; k < ticks; ++k) {
    const double* row = field.data() + 6 * k;
    const V B{row[0], row[1], row[2]}, b = to_body(s.q, B), velocity{row[3], row[4], row[5]};
    V seen{};
    for (const V& bias : body.bias)
      for (std::size_t i = 0; i < 3; ++i) seen[i] += 0.5 * 0.3 * std::round((b[i] + 0.5 * normal(random) + bias[i]) / 0.3);
    const double size = norm(seen);
    V unit{seen[0] / size, seen[1] / size, seen[2] / size}, slope{};
    if (!first) {
      for (std::size_t i = 0; i < 3; ++i) {
        slope[i] = (unit[i] - old[i]) / tick;
        tumble[i] = filter * std::abs(slope[i]) * tick / 2 + (1 - filter) * tumble[i];
      }
    }
    first = false, old = unit;
    calm = tumble[0] <= low && tumble[1] <= low && tumble[2] <= low ? calm + 1 : 0;
    wild = tumble[0] >= high || tumble[1] >= high || tumble[2] >= high ? wild + 1 : 0;
    const double t = static_cast<double>(k) * tick;
    if (std::isnan(found.rates) && std::abs(s.w[0]) <= slow && std::abs(s.w[1]) <= slow && std::abs(s.w[2]) <= slow)
      found.rates = t, found.on_rates = on;
    if (calm * tick >= 1800) {
      if (std::isnan(found.law)) found.law = t, found.on_law = on;
      acting = false;
    }
    if (wild * tick >= 120) acting = true;
    V dipole = body.residual;
    if (t > 0 && acting) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double wish = -gain * slope[i] / size, time = duty * tick * std::min(1.0, std::abs(wish) / body.most[i]);
        dipole[i] += (wish > 0 ? 1 : wish < 0 ? -1 : 0) * (time - rise) * body.most[i] / tick;
        on[i] += time;
      }
    }
    if (!std::isnan(found.rates) && !std::isnan(found.law)) break;
    const V tesla{B[0] * 1e-6, B[1] * 1e-6, B[2] * 1e-6};
    const double h = tick / steps;
    for (int i = 0; i < steps; ++i) {
      const State a = find_rates(s, body, dipole, tesla, velocity, drag),
                  c = find_rates(add(s, a, h / 2), body, dipole, tesla, velocity, drag),
                  d = find_rates(add(s, c, h / 2), body, dipole, tesla, velocity, drag),
                  e = find_rates(add(s, d, h), body, dipole, tesla, velocity, drag);
      s = add(add(add(add(s, a, h / 6), c, h / 3), d, h / 3), e, h / 6);
      const double length = std::sqrt(s.q[0] * s.q[0] + s.q[1] * s.q[1] + s.q[2] * s.q[2] + s.q[3] * s.q[3]);
      for (double& part : s.q) part /= length;
    }
  }
  return found;
}

std::vector<double> read(const char* path) {
  std::vector<double> all;
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) return all;
  double part[4096];
  for (std::size_t n; (n = std::fread(part, sizeof(double), 4096, file)) > 0;) all.insert(all.end(), part, part + n);
  std::fclose(file);
  return all;
}

}  // namespace

int main(int count, char** given) {
  if (count != 5) return 2;
  const std::vector<double> field = read(given[1]), bodies = read(given[2]);
  for (std::size_t i = 0; 15 * i < bodies.size(); ++i) {
    const double* b = bodies.data() + 15 * i;
    const Body body{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}, {b[6], b[7], b[8]},
                    {V{b[9], b[10], b[11]}, V{b[12], b[13], b[14]}}};
    const Result r = run(body, field, std::atoi(given[3]), std::atoi(given[4]) != 0, static_cast<unsigned>(i + 1));
    std::printf("%.17g %.17g %.9g %.9g %.9g %.9g %.9g %.9g\n", r.rates, r.law, r.on_rates[0], r.on_rates[1], r.on_rates[2],
                r.on_law[0], r.on_law[1], r.on_law[2]);
    std::fflush(stdout);
  }
}
