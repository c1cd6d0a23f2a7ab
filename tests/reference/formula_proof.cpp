// The truth of formula_proof_reference.py, which puts the laws in: midpoint steps, extrapolated, in 113-bit numbers.
#include <quadmath.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

using Q = __float128;
using State = std::vector<Q>;
using Law = void (*)(Q t, const Q* w, const Q* q, Q* tau);

static Q sqrt(Q x) { return sqrtq(x); }
static Q exp(Q x) { return expq(x); }
static Q log(Q x) { return logq(x); }
static Q sin(Q x) { return sinq(x); }
static Q cos(Q x) { return cosq(x); }
static Q tanh(Q x) { return tanhq(x); }
static Q atan2(Q y, Q x) { return atan2q(y, x); }
static Q power(Q x, Q p) { return powq(x, p); }
static Q cube(Q x) { return x * x * x; }

static void to_body(const Q* q, const Q* v, Q* out) {   // by two cross products
  const Q p[3] = {-q[0], -q[1], -q[2]};
  Q twice[3];
  for (int i = 0; i < 3; ++i) twice[i] = 2 * (p[(i + 1) % 3] * v[(i + 2) % 3] - p[(i + 2) % 3] * v[(i + 1) % 3]);
  for (int i = 0; i < 3; ++i)
    out[i] = v[i] + q[3] * twice[i] + p[(i + 1) % 3] * twice[(i + 2) % 3] - p[(i + 2) % 3] * twice[(i + 1) % 3];
}
static Q seen(const Q* q, Q a) {
  const Q v[3] = {0, a, 1};
  Q out[3];
  to_body(q, v, out);
  return out[1];
}

[[maybe_unused]] static Q keep_used(Q x) { return sqrt(exp(log(sin(cos(tanh(atan2(power(cube(x), x), seen(&x, x)))))))); }

// LAWS

struct Body {
  Law law;
  Q I[3][3], inverse[3][3], gravity[3], rotor;
  bool acts;

  State rate(Q t, const State& y) const {
    const Q *w = &y[0], *q = &y[3];
    Q tau[3] = {0, 0, 0}, up[3], h[3];
    if (acts) law(t, w, q, tau);
    const Q vertical[3] = {0, 0, 1};
    to_body(q, vertical, up);
    for (int i = 0; i < 3; ++i) h[i] = I[i][0] * w[0] + I[i][1] * w[1] + I[i][2] * w[2] + (i == 2 ? rotor : Q(0));
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      tau[i] += h[j] * w[k] - h[k] * w[j] - (gravity[j] * up[k] - gravity[k] * up[j]);
    }
    State d(7);
    for (int i = 0; i < 3; ++i) d[i] = inverse[i][0] * tau[0] + inverse[i][1] * tau[1] + inverse[i][2] * tau[2];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      d[3 + i] = (q[3] * w[i] + q[j] * w[k] - q[k] * w[j]) / 2;
    }
    d[6] = -(q[0] * w[0] + q[1] * w[1] + q[2] * w[2]) / 2;
    return d;
  }

  /// Gragg's midpoint rule with 2, 4, ..., extrapolated (Hairer, Norsett & Wanner 1993, II.9).
  bool step(Q t, State& y, Q H, Q tolerance) const {
    constexpr int columns = 16;
    std::vector<std::vector<State>> table;
    for (int j = 1; j <= columns; ++j) {
      const int n = 2 * j;
      const Q h = H / n;
      State before = y, now = y, d = rate(t, y);
      for (int i = 0; i < 7; ++i) now[i] += h * d[i];
      for (int k = 1; k < n; ++k) {
        d = rate(t + k * h, now);
        for (int i = 0; i < 7; ++i) {
          const Q next = before[i] + 2 * h * d[i];
          before[i] = now[i], now[i] = next;
        }
      }
      d = rate(t + H, now);
      std::vector<State> row(1, State(7));
      for (int i = 0; i < 7; ++i) row[0][i] = (now[i] + before[i] + h * d[i]) / 2;
      for (int k = 1; k < j; ++k) {
        const Q part = Q(j * j) / Q((j - k) * (j - k)) - 1;
        State better(7);
        for (int i = 0; i < 7; ++i) better[i] = row[k - 1][i] + (row[k - 1][i] - table[j - 2][k - 1][i]) / part;
        row.push_back(better);
      }
      table.push_back(row);
    }
    Q apart = 0;
    for (int i = 0; i < 7; ++i) {
      const Q gap = fabsq(table[columns - 1][columns - 1][i] - table[columns - 1][columns - 2][i]);
      apart = gap > apart ? gap : apart;
    }
    if (!(apart < tolerance)) return false;
    y = table[columns - 1][columns - 1];
    return true;
  }

  void follow(Q t, State& y, Q end, Q tolerance) const {
    Q H = end - t;
    if (fabsq(H) > Q(0.5)) H = H > 0 ? Q(0.5) : -Q(0.5);
    while (t != end) {
      if (fabsq(end - t) < fabsq(H) * Q(1.0000001)) H = end - t;
      const bool last = H == end - t;
      if (step(t, y, H, tolerance)) {
        t = last ? end : t + H;
        if (!last) H *= Q(1.3);
      } else {
        H /= 2;
        if (fabsq(H) < Q(1e-3)) std::exit(2);   // rounding alone exceeds the tolerance
      }
    }
  }
};

int main() {
  const auto read = [] {
    std::string word;
    std::cin >> word;
    return std::strtod(word.c_str(), nullptr);
  };
  Body body{};
  body.law = laws[static_cast<int>(read())];
  const Q tolerance = read();
  for (auto& row : body.I)
    for (Q& x : row) x = read();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      body.inverse[i][j] = body.I[a][c] * body.I[b][d] - body.I[a][d] * body.I[b][c];
    }
  const Q determinant = body.I[0][0] * body.inverse[0][0] + body.I[0][1] * body.inverse[1][0] + body.I[0][2] * body.inverse[2][0];
  for (auto& row : body.inverse)
    for (Q& x : row) x /= determinant;
  State start(7);
  for (Q& x : start) x = read();
  const Q size = sqrtq(start[3] * start[3] + start[4] * start[4] + start[5] * start[5] + start[6] * start[6]);
  for (int i = 3; i < 7; ++i) start[i] /= size;
  const Q t0 = read();
  for (Q& x : body.gravity) x = read();
  body.rotor = read();
  std::vector<std::pair<Q, Q>> windows(static_cast<std::size_t>(read()));
  std::vector<Q> edges;
  for (auto& [begin, end] : windows) {
    begin = read(), end = read();
    edges.push_back(begin), edges.push_back(end);
  }
  std::vector<Q> times(static_cast<std::size_t>(read()));
  for (Q& t : times) t = read();
  std::vector<State> found(times.size());
  for (const int sign : {1, -1}) {
    State y = start;
    Q t = t0;
    std::vector<std::pair<Q, int>> stops;   // times, and edges without a sample
    for (std::size_t i = 0; i < times.size(); ++i)
      if (sign * (times[i] - t0) >= 0) stops.emplace_back(times[i], static_cast<int>(i));
    for (const Q edge : edges)
      if (sign * (edge - t0) > 0) stops.emplace_back(edge, -1);
    std::stable_sort(stops.begin(), stops.end(), [&](const auto& a, const auto& b) { return sign * a.first < sign * b.first; });
    for (const auto& [stop, sample] : stops) {
      const Q middle = (t + stop) / 2;
      body.acts = windows.empty();
      for (const auto& [begin, end] : windows) body.acts = body.acts || (begin < middle && middle < end);
      body.follow(t, y, stop, tolerance);
      t = stop;
      if (sample >= 0) found[static_cast<std::size_t>(sample)] = y;
    }
  }
  for (const State& y : found)
    for (const Q x : y) {
      const double high = static_cast<double>(x);
      std::printf("%a %a ", high, static_cast<double>(x - high));
    }
}
