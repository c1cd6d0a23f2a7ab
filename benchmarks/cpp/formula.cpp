// A step's Taylor series by formulas that are interpreted, and by the kernels written for the built-in torques: a heavy
// body, and a gravity gradient. Both in one run, in turns, at each instruction set; least of many repeats, and the
// largest difference of the two series relative to their largest coefficient.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "method/series/body_series.hpp"
#include "method/series/lanes/levels.hpp"
#include "polhode/formula/parser.hpp"
#include "polhode/formula/table.hpp"

using namespace polhode;

namespace {

double now() {
  timespec ts;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &ts);
  return static_cast<double>(ts.tv_sec) * 1e9 + static_cast<double>(ts.tv_nsec);
}

/// Least time of one of 200 calls of each of two works, in ns, taken in turns.
template <class First, class Second>
void compare(const First& first, const Second& second, double& a, double& b) {
  a = b = 1e300;
  for (int i = 0; i < 400; ++i) {
    const double t0 = now();
    for (int k = 0; k < 50; ++k) first();
    const double t1 = now();
    for (int k = 0; k < 50; ++k) second();
    const double t2 = now();
    a = std::min(a, (t1 - t0) / 50), b = std::min(b, (t2 - t1) / 50);
  }
}

struct Scenery {
  const char* name;
  Vector3d moments, omega;
  AnyTorque torque;
  formula::Text text;
  double unit;
};

SeriesKernel kernel_of(SimdLevel level, const SeriesTerms& terms) {
  if (level == SimdLevel::avx512) return avx512_series_kernel(terms, true);
  return level == SimdLevel::avx2 ? avx2_series_kernel(terms, true) : baseline_series_kernel(terms, true);
}

}  // namespace

int main() {
  const double half = 0.5;
  const Scenery sceneries[] = {
      {"heavy body", {1.0, 2.0, 2.5}, {0.3, 0.2, 3.0}, torques::Gravity(2.0, Vector3d(0.3, 0.2, 0.5)),
       {"-cross([0.6, 0.4, 1], to_body([0, 0, 1]))", {}, {}, {}, {}}, 0.25},
      {"gravity gradient", {20, 40, 52}, {0.002, 0.004, 0.006}, torques::GravityGradient(1e-3),
       {"3e-6 * cross(u, [20, 40, 52] * u)", {}, {}, {}, {{"u", "to_body([cos(1e-3 * t), sin(1e-3 * t), 0])"}}},
       128.0}};
  std::printf("%-17s %-9s %6s %12s %12s %7s %10s %6s\n", "torque", "level", "order", "formula, ns", "built in, ns",
              "ratio", "difference", "picks");
  for (const Scenery& s : sceneries) {
    const Scene scene({.inertia_B = InertiaTensor(Matrix3d(s.moments.asDiagonal())), .omega = s.omega,
                       .attitude = {half, half, -half, half}, .torques = {s.torque}, .times = {1.0}});
    const BodySeries series(scene, true);
    const double begin = now();
    const formula::Table table(
        formula::Tape(formula::make_body_equations(formula::parse(s.text), s.moments.asDiagonal())));
    const double made = now() - begin;
    for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > simd_level()) continue;
      for (const int order : {8, 15, 21}) {
        alignas(64) static double rows[8 * 64], own[8 * 64];
        auto* workspace = static_cast<double*>(
            std::aligned_alloc(64, (8 * table.workspace_size(order) + 63) / 64 * 64));
        const double y[7] = {s.omega[0], s.omega[1], s.omega[2], half, half, -half, half};
        // What BodySeries::compute_series() does, by the kernel of this level.
        const SeriesKernel kernel = kernel_of(level, series.terms());
        double a, b;
        compare([&] { table.compute_series(level, 0.0, s.unit, y, order, rows, nullptr, workspace); },
                [&] {
                  alignas(64) double vectors[16] = {};
                  int n = 0;
                  for (; n < series.terms().fixed_vectors; ++n) {
                    const Vector3d seen = rotate({-y[3], -y[4], -y[5], y[6]}, series.fixed_vector(n));
                    std::copy_n(seen.data(), 3, vectors + 4 * n);
                  }
                  if (series.terms().gradient) {
                    const auto [radius, tangent] = series.compute_orbit_axes(0.0, series.start());
                    std::copy_n(radius.data(), 3, vectors + 4 * n);
                    std::copy_n(tangent.data(), 3, vectors + 4 * (n + 1));
                  }
                  kernel(series.terms(), {series.start(), vectors, s.unit}, order, own);
                },
                a, b);
        double difference = 0.0;
        for (int k = 0; k <= order; ++k) {
          double w[3], size = 0.0;
          series.compute_rates(own + 8 * k, w);
          for (int i = 0; i < 3; ++i) size = std::max(size, std::abs(rows[8 * k + i]));
          for (int i = 0; i < 3; ++i) difference = std::max(difference, std::abs(rows[8 * k + i] - w[i]) / size);
        }
        std::printf("%-17s %-9s %6d %12.1f %12.1f %7.2f %10.1e %6d\n", s.name, to_text(level), order, a, b, a / b,
                    difference, table.count_picks());
        std::free(workspace);
      }
    }
    std::printf("%-17s made in %.0f us\n", s.name, made * 1e-3);
  }
}
