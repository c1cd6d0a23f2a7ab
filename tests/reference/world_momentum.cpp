/// The first route of worlds_reference.py: the angular momentum of all in space axes, the quaternion and the wheel's
/// own momentum, by Gragg's midpoint rule with extrapolation (Hairer, Norsett & Wanner 1993, II.9). The orbit is the
/// classical anomaly of the elements, and plates are turned to space. One line "w q W" per sample.
/// options: longest step, tolerance.
#include "world.hpp"

namespace {

/// R_WB by rows, from a quaternion of any length.
struct Turn {
  Vector x, y, z;
  explicit Turn(const Real* q) {
    const Real xx = q[0] * q[0], yy = q[1] * q[1], zz = q[2] * q[2], ww = q[3] * q[3], k = 1 / (xx + yy + zz + ww);
    const Real xy = q[0] * q[1], xz = q[0] * q[2], yz = q[1] * q[2], xw = q[0] * q[3], yw = q[1] * q[3],
               zw = q[2] * q[3];
    x = k * Vector{ww + xx - yy - zz, 2 * (xy - zw), 2 * (xz + yw)};
    y = k * Vector{2 * (xy + zw), ww - xx + yy - zz, 2 * (yz - xw)};
    z = k * Vector{2 * (xz - yw), 2 * (yz + xw), ww - xx - yy + zz};
  }
  Vector to_space(const Vector& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  Vector to_body(const Vector& v) const { return v[0] * x + v[1] * y + v[2] * z; }
};

class Momentum {
 public:
  World world;
  explicit Momentum(World w) : world(std::move(w)) {
    const Vector pi{cos(world.periapsis), sin(world.periapsis), 0}, qu{-sin(world.periapsis), cos(world.periapsis), 0};
    const auto rotate = [&](const Vector& v) {
      const Real ci = cos(world.inclination), si = sin(world.inclination), cn = cos(world.node), sn = sin(world.node);
      const Vector tilted{v[0], ci * v[1], si * v[1]};
      return Vector{cn * tilted[0] - sn * tilted[1], sn * tilted[0] + cn * tilted[1], tilted[2]};
    };
    p_ = rotate(pi), q_ = rotate(qu);
    if (world.mu == 0) return;
    const Real size = world.q / absolute(1 - world.e);
    n_ = sqrt(world.mu / (size * size * size));
  }

  State start() const {
    const Vector body{world.moments[0] * world.omega[0], world.moments[1] * world.omega[1],
                      world.moments[2] * world.omega[2]};
    Real size = 0;
    for (const Real x : world.attitude) size += x * x;
    State y(8);
    for (std::size_t i = 0; i < 4; ++i) y[3 + i] = world.attitude[i] / sqrt(size);
    const Vector L = Turn(&y[3]).to_space(body);   // the wheel is at rest
    std::copy(L.begin(), L.end(), y.begin());
    y[7] = world.inertia * dot(world.axis, world.omega);
    return y;
  }

  State rate(Real t, const State& y, Sides& s) const {
    const bool has_wheel = world.inertia > 0;
    s.begin(has_wheel);
    const Real* q = &y[3];
    const Turn turn(q);
    const Vector H = turn.to_body({y[0], y[1], y[2]});
    Real push = 0;
    if (has_wheel) {
      const Real asked = world.ramp * t;
      push = s.is_positive(world.max_torque - asked) ? asked : world.max_torque;
    }
    const Vector w = rates(H, y[7], s);
    State d(8, 0);
    if (has_wheel) drive(H, w, y[7], push, s, d);
    const Vector tau = torque(t, turn, s);
    std::copy(tau.begin(), tau.end(), d.begin());
    d[3] = (q[3] * w[0] + q[1] * w[2] - q[2] * w[1]) / 2, d[4] = (q[3] * w[1] + q[2] * w[0] - q[0] * w[2]) / 2;
    d[5] = (q[3] * w[2] + q[0] * w[1] - q[1] * w[0]) / 2, d[6] = -(q[0] * w[0] + q[1] * w[1] + q[2] * w[2]) / 2;
    return d;
  }

  void changed(State& y, Sides& s) const {
    if (s.wheel == Wheel::kSliding) {
      const Vector w = rates(Turn(&y[3]).to_body({y[0], y[1], y[2]}), y[7], s);
      s.speed = y[7] / world.inertia - dot(world.axis, w), s.wheel = Wheel::kTop;
      return;
    }
    const Vector w = rates(Turn(&y[3]).to_body({y[0], y[1], y[2]}), y[7], s);
    y[7] = world.inertia * (s.speed + dot(world.axis, w));
    s.needed = s.needed > 0 ? 1 : -1, s.wheel = Wheel::kSliding;
  }

  std::vector<Real> output(Real t, const State& y, Sides& s) const {
    rate(t, y, s);
    const Vector w = rates(Turn(&y[3]).to_body({y[0], y[1], y[2]}), y[7], s);
    std::vector<Real> row{w[0], w[1], w[2], y[3], y[4], y[5], y[6]};
    if (world.inertia > 0)
      row.push_back(s.wheel == Wheel::kSliding ? y[7] / world.inertia - dot(world.axis, w) : s.speed);
    return row;
  }

  bool step(Real t, State& y, Real H, Sides& s) const {
    constexpr std::size_t columns = 14;
    std::vector<std::vector<State>> table;
    for (std::size_t j = 1; j <= columns; ++j) {
      const Real h = H / static_cast<Real>(2 * j);
      State before = y, now = y, d = rate(t, y, s);
      for (std::size_t i = 0; i < 8; ++i) now[i] += h * d[i];
      for (std::size_t k = 1; k < 2 * j; ++k) {
        d = rate(t + static_cast<Real>(k) * h, now, s);
        for (std::size_t i = 0; i < 8; ++i) {
          const Real next = before[i] + 2 * h * d[i];
          before[i] = now[i], now[i] = next;
        }
      }
      d = rate(t + H, now, s);
      std::vector<State> row(1, State(8));
      for (std::size_t i = 0; i < 8; ++i) row[0][i] = (now[i] + before[i] + h * d[i]) / 2;
      for (std::size_t k = 1; k < j; ++k) {
        const Real part = static_cast<Real>(j * j) / static_cast<Real>((j - k) * (j - k)) - 1;
        State better(8);
        for (std::size_t i = 0; i < 8; ++i) better[i] = row[k - 1][i] + (row[k - 1][i] - table[j - 2][k - 1][i]) / part;
        row.push_back(better);
      }
      table.push_back(row);
    }
    Real apart = 0, size = 0;
    for (std::size_t i = 0; i < 3; ++i) size = std::max(size, absolute(y[i]));
    for (std::size_t i = 0; i < 8; ++i) {
      const Real gap = absolute(table[columns - 1][columns - 1][i] - table[columns - 1][columns - 2][i]);
      apart = std::max(apart, i < 3 || i == 7 ? gap / size : gap);
    }
    if (!(apart < world.options[1])) return false;
    y = table[columns - 1][columns - 1];
    return true;
  }

 private:
  /// J w + Ji W a = H: the speed W is known, or the momentum Ji (W + a.w) is.
  Vector rates(const Vector& H, Real own, const Sides& s) const {
    const Vector& a = world.axis;
    const bool is_free = world.inertia > 0 && s.wheel == Wheel::kSliding;
    const Vector rest = H - (is_free ? own : world.inertia * s.speed) * a;
    return is_free ? without_wheel(rest) : Vector{rest[0] / world.moments[0], rest[1] / world.moments[1],
                                                  rest[2] / world.moments[2]};
  }
  /// (J - Ji a a^T)^-1 by Sherman and Morrison.
  Vector without_wheel(const Vector& x) const {
    const Vector &J = world.moments, &a = world.axis;
    const Vector u{x[0] / J[0], x[1] / J[1], x[2] / J[2]}, c{a[0] / J[0], a[1] / J[1], a[2] / J[2]};
    return u + (world.inertia * dot(a, u) / (1 - world.inertia * dot(a, c))) * c;
  }

  void drive(const Vector& H, const Vector& w, Real own, Real push, Sides& s, State& d) const {
    const Vector &J = world.moments, &a = world.axis, spin = cross(H, w);
    const Real along = dot(a, {spin[0] / J[0], spin[1] / J[1], spin[2] / J[2]});   // a.w' of the locked body
    if (s.wheel == Wheel::kSliding) {
      const Real speed = own / world.inertia - dot(a, w);
      d[7] = push - world.viscous * speed - world.coulomb * s.needed;
      s.note_mode(world.max_speed - absolute(speed));
      return;
    }
    const Real free = push - world.viscous * s.speed - world.inertia * along;
    if (s.wheel == Wheel::kStuck) s.needed = free, s.note_mode(world.coulomb - absolute(free));
    else s.note_mode(s.speed > 0 ? free - world.coulomb : -free - world.coulomb);
  }

  void place(Real t, Vector& r, Vector& v) const {
    const Real e = world.e, a = world.q / absolute(1 - e), M = world.mean + n_ * t;
    if (e < 1) {
      Real E = M;
      for (int k = 0; k < 60; ++k) {
        const Real change = (E - e * sin(E) - M) / (1 - e * cos(E));
        E -= change;
        if (absolute(change) < Real(1e-22L)) break;   // Newton doubles the digits
      }
      const Real c = cos(E), s = sin(E), b = sqrt((1 - e) * (1 + e)), slope = n_ / (1 - e * c);
      r = (a * (c - e)) * p_ + (a * b * s) * q_, v = (-a * s * slope) * p_ + (a * b * c * slope) * q_;
      return;
    }
    Real F = M > 0 ? log(2 * M / e + Real(1.8L)) : -log(-2 * M / e + Real(1.8L));
    for (int k = 0; k < 60; ++k) {
      const Real change = (e * sinh(F) - F - M) / (e * cosh(F) - 1);
      F -= change;
      if (absolute(change) < Real(1e-22L)) break;
    }
    const Real c = cosh(F), s = sinh(F), b = sqrt((e - 1) * (e + 1)), slope = n_ / (e * c - 1);
    r = (a * (e - c)) * p_ + (a * b * s) * q_, v = (-a * s * slope) * p_ + (a * b * c * slope) * q_;
  }

  Vector torque(Real t, const Turn& turn, Sides& s) const {
    if (world.mu == 0) return {0, 0, 0};
    Vector r, v;
    place(t, r, v);
    const Real size2 = dot(r, r), size = sqrt(size2);
    const Vector seen = turn.to_body(r);
    const Vector& J = world.moments;
    const Vector pulled = turn.to_space({J[0] * seen[0], J[1] * seen[1], J[2] * seen[2]});
    Vector tau = (3 * world.mu / (size2 * size2 * size)) * cross(r, pulled);
    if (world.strength != 0) {
      const Real angle = world.field_spin * t + world.phase;
      const Vector m{sin(world.tilt) * cos(angle), sin(world.tilt) * sin(angle), cos(world.tilt)};
      const Vector B = (world.strength / (size2 * size)) * ((3 * dot(m, r) / size2) * r - m);
      tau = tau + cross(turn.to_space(world.moment), B);
    }
    if (!world.air.empty()) {
      const Real density = world.density * exp((world.height_radius - size) / world.scale_height);
      const Vector u{v[0] + world.air_spin * r[1], v[1] - world.air_spin * r[0], v[2]};
      for (const Plate& plate : world.air) {
        const Real met = dot(turn.to_space(plate.normal), u);
        if (!s.is_positive(met)) continue;
        const Vector force = (-world.coefficient * plate.area * density * met / 2) * u;
        tau = tau + cross(turn.to_space(plate.centre), force);
      }
    }
    if (world.light.empty()) return tau;
    const Real ahead = dot(r, world.sun), off = size2 - ahead * ahead - world.shadow * world.shadow;
    bool dark = false;
    if (world.shadow > 0) {
      const bool before = s.is_positive(ahead, true), beside = s.is_positive(off, true);
      dark = !before && !beside;
    }
    for (const Plate& plate : world.light) {
      const Vector n = turn.to_space(plate.normal);
      const Real c = dot(n, world.sun);
      if (!s.is_positive(c) || dark) continue;
      const Vector force = (-world.pressure * plate.area * c) *
                           ((1 - plate.specular) * world.sun + (2 * (plate.specular * c + plate.diffuse / 3)) * n);
      tau = tau + cross(turn.to_space(plate.centre), force);
    }
    return tau;
  }

  Vector p_{}, q_{};
  Real n_ = 0;
};

}  // namespace

int main() {
  const Momentum route(World::read());
  run(route, route.world.options[0]);
}
