// Lagrange's top: what one state costs at any time, and what the set-up costs, each with its error against motions
// known to 50 digits (tests/reference/heavy_top_reference.py). One thread, processor time, least of many repeats.

#include "polhode/exact/heavy_top.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

using namespace polhode;

namespace {

struct Case {
  const char* name;
  Vector3d moments;
  double arm;
  Vector3d omega;
  Quat attitude;
  double t;          // where the truth is known
  Vector3d omega_t;
  Quat attitude_t;
};

double now() {
  timespec ts;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &ts);
  return static_cast<double>(ts.tv_sec) * 1e9 + static_cast<double>(ts.tv_nsec);
}

/// Least time of one call of `work` in ns.
template <class Work>
double least(int repeats, Work&& work) {
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const double begin = now();
    work();
    best = std::min(best, now() - begin);
  }
  return best;
}

}  // namespace

int main() {
  const Case cases[] = {
      {"looping, t = 1e9", {1, 1, 0.5}, 1.3, {0.1388933581299014, -0.4490044678086785, 5.0},
       {0.40859475377317545, 0.1491487279654302, 0.04500359814777627, 0.8993217779466289}, 1e9,
       {0.7182118944442735, -1.2257949894809614, 5.0},
       {0.04297524626580151, -0.7300837219763311, 0.670173709949369, 0.12648353887474822}},
      {"near homoclinic, t = 150", {1, 1, 1}, 12.5, {4.000004, 3, 3},
       {0.7071067811865476, 0, 0, 0.7071067811865476}, 150,
       {-0.3358829460635817, 0.5511333571293661, 3.0},
       {-0.09127248553436451, 0, 0.9901056162616942, 0.10658424851463685}}};
  constexpr std::size_t n = 4096;
  std::vector<double> times(n), omega(3 * n), attitude(4 * n);
  std::printf("%-26s %14s %14s %10s %10s\n", "top", "ns per state", "set-up, us", "angle", "omega");
  for (const Case& c : cases) {
    const HeavyTop top(c.moments, c.arm, c.omega, c.attitude);
    for (std::size_t i = 0; i < n; ++i) times[i] = 1e-3 * static_cast<double>((i * 2654435761u) % 1000003u);
    const double state = least(2000, [&] { top.at(times.data(), n, omega.data(), attitude.data()); }) / n;
    double kept = 0;
    const double set_up = least(2000,
                                [&] {
                                  for (int i = 0; i < 20; ++i)
                                    kept += HeavyTop(c.moments, c.arm, c.omega, c.attitude).constants().sum_k;
                                }) /
                          20;
    const State s = top.at(c.t);
    const Quat d = conjugate(s.attitude) * c.attitude_t;
    std::printf("%-26s %14.1f %14.2f %10.1e %10.1e%s\n", c.name, state, set_up * 1e-3, 2 * std::hypot(d.x, d.y, d.z),
                (s.omega - c.omega_t).norm() / c.omega_t.norm(), kept == 1.0 ? " " : "");
  }
}
