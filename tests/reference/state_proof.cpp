// The truth of state_proof_reference.py, which puts the laws in: midpoint steps, extrapolated, in 113-bit numbers. Each
// switch keeps its branch until the step at whose end its guard is 0, found by bisection and secants.
#include <quadmath.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

using Q = __float128;
using State = std::vector<Q>;

static Q sqrt(Q x) { return sqrtq(x); }
static Q sin(Q x) { return sinq(x); }
static Q cos(Q x) { return cosq(x); }
static Q tanh(Q x) { return tanhq(x); }
static Q exp(Q x) { return expq(x); }
static Q log(Q x) { return logq(x); }
static Q atan2(Q y, Q x) { return atan2q(y, x); }
static Q power(Q x, Q p) { return powq(x, p); }
static Q cube(Q x) { return x * x * x; }

static void add_cross(const Q* a, const Q* b, Q* out) {
  for (int i = 0; i < 3; ++i) out[i] += a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}
/// Component y of R^T (0, a, 1), by two cross products.
static Q seen(const Q* q, Q a) {
  const Q v[3] = {0, a, 1}, p[3] = {-q[0], -q[1], -q[2]};
  Q u[3] = {0, 0, 0}, out[3] = {0, 0, 0};
  add_cross(p, v, u);
  for (Q& x : u) x *= 2;
  add_cross(p, u, out);
  return v[1] + q[3] * u[1] + out[1];
}
[[maybe_unused]] static Q keep_used(Q x) { return sqrt(exp(log(sin(cos(tanh(atan2(power(cube(x), x), seen(&x, x)))))))); }

/// The branches that switches have, and their guards as they come.
struct Switches {
  std::vector<int> sides;
  std::vector<Q> guards;
  std::size_t next = 0;

  Q pick(Q guard, Q yes, Q no) {
    if (guards.size() <= next) guards.push_back(0), sides.push_back(guard > 0 ? 1 : -1);
    guards[next] = guard;
    return sides[next++] > 0 ? yes : no;
  }
  Q abs(Q x) { return pick(x, x, -x); }
  Q sign(Q x) { return pick(x, 1, -1); }
  Q min(Q a, Q b) { return pick(a - b, b, a); }
  Q max(Q a, Q b) { return pick(a - b, a, b); }
  Q clip(Q x, Q low, Q high) {
    const Q least = max(x, low);
    return min(least, high);
  }
};

using Law = void (*)(Q t, const Q* w, const Q* q, const Q* h, Switches& s, Q* tau, Q* rates);

// LAWS

static Q dot(const Q* a, const Q* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
struct Body {
  Law law;
  int own;   // states of the law, then a rotor's momentum, then a damper's
  Q I[3][3], inverse[3][3];
  Q axis[3], rotor_inertia, rotor_viscous, rotor_torque, rotor_speed;   // no rotor: 0
  Q damper_inertia, damper_viscous, damper_rates[3];

  int size() const { return 7 + own + 4; }

  State rate(Q t, const State& y, Switches& s) const {
    s.next = 0;
    const Q *w = &y[0], *q = &y[3], *h = &y[7], *momentum = h + own, *p = momentum + 1;
    State d(y.size());
    Q tau[3] = {0, 0, 0}, L[3];
    law(t, w, q, h, s, tau, &d[7]);
    for (int i = 0; i < 3; ++i) L[i] = dot(I[i], w);
    if (rotor_inertia > 0) {
      const Q speed = *momentum / rotor_inertia - dot(axis, w), effort = rotor_torque - rotor_viscous * speed;
      for (int i = 0; i < 3; ++i) L[i] += *momentum * axis[i], tau[i] -= effort * axis[i];
      d[7 + static_cast<std::size_t>(own)] = effort;
    }
    if (damper_inertia > 0) {
      Q force[3], rates[3] = {0, 0, 0};
      for (int i = 0; i < 3; ++i) force[i] = damper_viscous * (p[i] / damper_inertia - w[i]);
      add_cross(p, w, rates);
      for (int i = 0; i < 3; ++i) tau[i] += force[i], d[8 + static_cast<std::size_t>(own + i)] = rates[i] - force[i];
    }
    add_cross(L, w, tau);
    for (int i = 0; i < 3; ++i) d[static_cast<std::size_t>(i)] = dot(inverse[i], tau);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      d[3 + static_cast<std::size_t>(i)] = (q[3] * w[i] + q[j] * w[k] - q[k] * w[j]) / 2;
    }
    d[6] = -dot(q, w) / 2;
    return d;
  }

  /// Gragg's midpoint rule with 2, 4, ..., extrapolated (Hairer, Norsett & Wanner 1993, II.9).
  bool step(Q t, State& y, Q H, Q tolerance, Switches& s) const {
    constexpr int columns = 16;
    const std::size_t n = y.size();
    std::vector<std::vector<State>> table;
    for (int j = 1; j <= columns; ++j) {
      const Q h = H / (2 * j);
      State before = y, now = y, d = rate(t, y, s);
      for (std::size_t i = 0; i < n; ++i) now[i] += h * d[i];
      for (int k = 1; k < 2 * j; ++k) {
        d = rate(t + k * h, now, s);
        for (std::size_t i = 0; i < n; ++i) {
          const Q next = before[i] + 2 * h * d[i];
          before[i] = now[i], now[i] = next;
        }
      }
      d = rate(t + H, now, s);
      std::vector<State> row(1, State(n));
      for (std::size_t i = 0; i < n; ++i) row[0][i] = (now[i] + before[i] + h * d[i]) / 2;
      for (int k = 1; k < j; ++k) {
        const Q part = Q(j * j) / Q((j - k) * (j - k)) - 1;
        State better(n);
        for (std::size_t i = 0; i < n; ++i) {
          const Q old = table[static_cast<std::size_t>(j - 2)][static_cast<std::size_t>(k - 1)][i];
          better[i] = row[static_cast<std::size_t>(k - 1)][i] + (row[static_cast<std::size_t>(k - 1)][i] - old) / part;
        }
        row.push_back(better);
      }
      table.push_back(row);
    }
    Q apart = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Q gap = fabsq(table[columns - 1][columns - 1][i] - table[columns - 1][columns - 2][i]);
      apart = gap > apart ? gap : apart;
    }
    if (!(apart < tolerance)) return false;
    y = table[columns - 1][columns - 1];
    return true;
  }
};

/// Guards at the end of a step of given length; false where its error is too large.
static bool try_step(const Body& body, Q t, const State& from, Q H, Q tolerance, Switches& s, State& to) {
  to = from;
  if (H != 0 && !body.step(t, to, H, tolerance, s)) return false;
  body.rate(t + H, to, s);
  return true;
}

struct Run {
  const Body& body;
  Switches s;
  Q tolerance, longest;
  std::vector<Q> crossings;
  std::vector<bool> just = {};   // the guards that were crossed where the step begins

  void follow(Q t, State& y, Q end) {
    Q H = end > t ? longest : -longest;
    while (t != end) {
      if (fabsq(end - t) < fabsq(H) * Q(1.0000001)) H = end - t;
      const bool last = H == end - t;
      State next;
      if (!try_step(body, t, y, H, tolerance, s, next)) {
        H /= 2;
        if (fabsq(H) < Q(1e-4)) std::exit(2);   // rounding alone exceeds the tolerance
        continue;
      }
      Q first = H;
      int crossed = -1;
      for (std::size_t i = 0; i < s.guards.size(); ++i) {
        const std::vector<Q> end_guards = s.guards;
        if (end_guards[i] * s.sides[i] > 0) continue;
        if (i < just.size() && just[i]) std::exit(2);   // it slides, or comes back at once
        const Q root = find_root(t, y, i, H);
        if (fabsq(root) <= fabsq(first)) first = root, crossed = static_cast<int>(i);
        s.guards = end_guards;
      }
      if (crossed >= 0) {
        if (!try_step(body, t, y, first, tolerance, s, next)) std::exit(2);
        t += first, y = next;
        crossings.push_back(t);
        if (crossings.size() > 60) std::exit(2);
        // The same expression may stand in several switches.
        const Q size = fabsq(s.guards[static_cast<std::size_t>(crossed)]);
        just.assign(s.guards.size(), false);
        for (std::size_t i = 0; i < s.guards.size(); ++i)
          if (static_cast<int>(i) == crossed || fabsq(s.guards[i]) == size) s.sides[i] *= -1, just[i] = true;
        continue;
      }
      just.clear();
      t = last ? end : t + H, y = next;
      if (fabsq(H) < longest) H *= Q(1.3);
    }
  }

  Q find_root(Q t, const State& y, std::size_t i, Q H) {
    State to;
    const auto value = [&](Q h) {
      if (!try_step(body, t, y, h, tolerance, s, to)) std::exit(2);
      return s.guards[i] * s.sides[i];
    };
    Q a = 0, b = H, at_a = value(0), at_b = value(H);
    if (!(at_a > 0)) std::exit(2);
    for (int k = 0; k < 200 && fabsq(b - a) > fabsq(H) * Q(1e-33); ++k) {
      Q middle = k % 3 == 2 ? (a + b) / 2 : b - at_b * (b - a) / (at_b - at_a);
      const Q least = a < b ? a : b, most = a < b ? b : a;
      if (!(least < middle && middle < most)) middle = (a + b) / 2;
      if (middle == a || middle == b) break;
      const Q found = value(middle);
      if (found > 0) a = middle, at_a = found;
      else b = middle, at_b = found;
    }
    return fabsq(at_a) < fabsq(at_b) ? a : b;
  }
};

int main() {
  const auto read = [] {
    std::string word;
    std::cin >> word;
    return Q(std::strtod(word.c_str(), nullptr));
  };
  Body body{};
  body.law = laws[static_cast<int>(read())];
  const Q tolerance = read(), longest = read();
  for (auto& row : body.I)
    for (Q& x : row) x = read();
  State start(7);
  for (Q& x : start) x = read();
  const Q size = sqrtq(start[3] * start[3] + start[4] * start[4] + start[5] * start[5] + start[6] * start[6]);
  for (int i = 3; i < 7; ++i) start[static_cast<std::size_t>(i)] /= size;
  const Q t0 = read();
  body.own = static_cast<int>(read());
  for (int i = 0; i < body.own; ++i) start.push_back(read());
  for (Q& x : body.axis) x = read();
  const Q length = sqrtq(dot(body.axis, body.axis));
  for (Q& x : body.axis) x /= length;
  body.rotor_inertia = read(), body.rotor_viscous = read(), body.rotor_torque = read(), body.rotor_speed = read();
  start.push_back(body.rotor_inertia * (body.rotor_speed + dot(body.axis, &start[0])));
  body.damper_inertia = read(), body.damper_viscous = read();
  for (Q& x : body.damper_rates) x = read();
  for (std::size_t i = 0; i < 3; ++i) start.push_back(body.damper_inertia * (start[i] + body.damper_rates[i]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      body.I[i][j] -= body.rotor_inertia * body.axis[i] * body.axis[j] + (i == j ? body.damper_inertia : Q(0));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      body.inverse[i][j] = body.I[a][c] * body.I[b][d] - body.I[a][d] * body.I[b][c];
    }
  Q determinant = 0;
  for (int i = 0; i < 3; ++i) determinant += body.I[0][i] * body.inverse[i][0];
  for (auto& row : body.inverse)
    for (Q& x : row) x /= determinant;
  std::vector<Q> times(static_cast<std::size_t>(read()));
  for (Q& t : times) t = read();
  std::vector<State> found(times.size());
  std::vector<Q> crossings;
  for (const int sign : {1, -1}) {
    State y = start;
    Q t = t0;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (sign * (times[i] - t0) >= 0) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return sign * times[a] < sign * times[b]; });
    Run run{body, {}, tolerance, longest, {}, {}};
    body.rate(t, y, run.s);   // the sides at the start
    for (const std::size_t i : order) {
      run.follow(t, y, times[i]);
      t = times[i];
      found[i] = y;
    }
    crossings.insert(crossings.end(), run.crossings.begin(), run.crossings.end());
  }
  std::printf("%d ", static_cast<int>(crossings.size()));
  for (const Q t : crossings) std::printf("%a ", static_cast<double>(t));
  for (const State& y : found)
    for (const Q x : y) {
      const double high = static_cast<double>(x);
      std::printf("%a %a ", high, static_cast<double>(x - high));
    }
}
