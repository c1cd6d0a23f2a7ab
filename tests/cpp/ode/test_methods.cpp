#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/ode/drive.hpp"
#include "polhode/ode/methods.hpp"
#include "polhode/ode/taylor.hpp"

using namespace polhode;
using namespace polhode::ode;

namespace {

/// What a problem adds to be stepped by its Taylor series; `Self` gives the next row of coefficients in its own time.
template <class Self>
struct WithSeries {
  static constexpr int blocks = 1;
  static constexpr int heads[blocks] = {3};
  void compute_series(math::DD, double unit, const double* y, const double*, int order, double* rows) const {
    const auto& self = static_cast<const Self&>(*this);
    std::fill_n(rows, series_width * (order + 1), 0.0);
    std::copy_n(y, Self::dimension, rows);
    for (int n = 0; n < order; ++n) {
      double* next = rows + series_width * (n + 1);
      self.compute_row(rows, n, next);
      for (int i = 0; i < Self::dimension; ++i) next[i] *= unit / (n + 1);
    }
  }
  void compute_sizes(const double* row, double* sizes) const {
    sizes[0] = 0.0;
    for (int i = 0; i < Self::dimension; ++i) sizes[0] += std::abs(row[i]);
  }
  double compute_time_scale(math::DD, const double*) const { return 1.0; }
  void start_carry(double*) const {}
  void correct(math::DD, long, double*, double*) const {}
};

/// y'' = -y with y(0) = (1, 0), or y' = y^2 when it should blow up.
struct Oscillator : WithSeries<Oscillator> {
  static constexpr int dimension = 2;
  void compute_row(const double* rows, int n, double* f) const { compute_derivative(0.0, rows + series_width * n, f); }
  void compute_derivative(double, const double* y, double* f) const { f[0] = y[1], f[1] = -y[0]; }
  double error_norm(const double* e, const double*, const double*, double rtol, double atol) const {
    return (std::abs(e[0]) + std::abs(e[1])) / (rtol + atol);
  }
  void restore(double*, double*) const {}
};

struct Blowup : WithSeries<Blowup> {
  static constexpr int dimension = 1;
  void compute_row(const double* rows, int n, double* f) const {
    for (int j = 0; j <= n; ++j) f[0] += rows[series_width * j] * rows[series_width * (n - j)];
  }
  void compute_derivative(double, const double* y, double* f) const { f[0] = y[0] * y[0]; }
  double error_norm(const double* e, const double* y0, const double* y1, double rtol, double atol) const {
    const double size = std::fmax(std::abs(y0[0]), std::abs(y1[0]));
    return std::abs(e[0]) / (rtol * size + atol);
  }
  void restore(double*, double*) const {}
};

struct Scaled : WithSeries<Scaled> {
  static constexpr int dimension = 2;
  double rate;
  explicit Scaled(double r) : rate(r) {}
  void compute_row(const double* rows, int n, double* f) const { compute_derivative(0.0, rows + series_width * n, f); }
  double compute_time_scale(math::DD, const double*) const { return 1.0 / rate; }
  void compute_derivative(double, const double* v, double* f) const { f[0] = rate * v[1], f[1] = -rate * v[0]; }
  double error_norm(const double* e, const double* a, const double* b, double rtol, double atol) const {
    const double size = std::fmax(std::abs(a[0]) + std::abs(a[1]), std::abs(b[0]) + std::abs(b[1]));
    return (std::abs(e[0]) + std::abs(e[1])) / (rtol * size + atol);
  }
  void restore(double*, double*) const {}
};

struct Clock {
  static constexpr int dimension = 1;
  void compute_derivative(double, const double*, double* f) const { f[0] = 1.0; }
  double error_norm(const double* e, const double*, const double*, double rtol, double) const {
    return std::abs(e[0]) / rtol;
  }
  void restore(double*, double*) const {}
};

/// The tolerance, or for a fixed step the step whose error per turn of a rate of 1 is of that order.
template <class Method>
Tolerances at_accuracy(double accuracy, double rate = 1.0) {
  return {accuracy, 0.0, Method::record.adaptive ? 0.0 : std::pow(accuracy, 1.0 / Method::record.order) / rate};
}

template <class Method, class P>
DriveResult run(const P& problem, std::vector<double> y0, std::vector<double> times, Tolerances tolerances,
                std::vector<double>& out, DriveOptions options = {}, Counts* counts = nullptr, double t0 = 0.0) {
  typename Method::template Stepper<P> stepper(problem, t0, y0.data(), times.back(), tolerances);
  out.clear();
  const DriveResult result = drive(stepper, times, [&](std::size_t, std::span<const double> at, const double* rows) {
    out.insert(out.end(), rows, rows + P::dimension * at.size());
  }, options);
  if (counts) *counts = stepper.counts();
  return result;
}

template <class Method>
void conform() {
  const MethodRecord& record = Method::record;
  const std::string name(record.name);
  CAPTURE(name);
  constexpr auto within = [](double accuracy) { return at_accuracy<Method>(accuracy); };
  std::vector<double> y;
  const Oscillator oscillator;

  SUBCASE("the error falls as the power of the order, and stays near the tolerance") {
    double error[2], steps[2];
    for (int k = 0; k < 2; ++k) {
      Counts counts;
      const double rtol = k == 0 ? 1e-7 : 1e-10;
      run<Method>(oscillator, {1, 0}, {10}, within(rtol), y, {}, &counts);
      error[k] = std::hypot(y[0] - std::cos(10.0), y[1] + std::sin(10.0));
      steps[k] = static_cast<double>(counts.steps);
      CHECK(error[k] < 100 * rtol);
      CHECK(error[k] > 0.01 * rtol);
    }
    if (record.adaptive_order) {
      CHECK(steps[1] < 1.5 * steps[0]);   // a finer tolerance is met by a higher order
    } else {
      const double slope = std::log(error[0] / error[1]) / std::log(steps[1] / steps[0]);
      CHECK(slope > record.order - 0.4);
      CHECK(slope < record.order + 1.2);
    }
  }

  SUBCASE("samples between the steps have the order of the continuous extension") {
    std::vector<double> times;
    for (int i = 1; i <= 200; ++i) times.push_back(0.05 * i);
    double error[2], steps[2];
    for (int k = 0; k < 2; ++k) {
      Counts counts;
      run<Method>(oscillator, {1, 0}, times, within(k == 0 ? 1e-5 : 1e-8), y, {}, &counts);
      error[k] = 0.0;
      steps[k] = static_cast<double>(counts.steps);
      for (std::size_t i = 0; i < times.size(); ++i) {
        error[k] = std::fmax(error[k], std::hypot(y[2 * i] - std::cos(times[i]), y[2 * i + 1] + std::sin(times[i])));
      }
    }
    if (record.adaptive_order) {
      CHECK(error[1] < 1e-7);
    } else {
      CHECK(std::log(error[0] / error[1]) / std::log(steps[1] / steps[0]) > record.dense_order - 0.3);
    }
  }

  SUBCASE("backwards, and a span of zero") {
    run<Method>(oscillator, {1, 0}, {0.0, -3.0, -10.0}, within(1e-11), y);
    CHECK(y[0] == 1.0);
    CHECK(std::abs(y[2] - std::cos(3.0)) < 1e-9);
    CHECK(std::abs(y[5] - std::sin(10.0)) < 1e-9);
    Counts counts;
    const DriveResult none = run<Method>(oscillator, {1, 0}, {0.0, 0.0}, within(1e-9), y, {}, &counts);
    CHECK(none.samples == 2);
    CHECK(counts.steps == 0);
  }

  SUBCASE("dense output is what the samples are") {
    DriveOptions options;
    options.dense = true;
    std::vector<double> times{0.3, 1.7, 6.0};
    const DriveResult result = run<Method>(oscillator, {1, 0}, times, within(1e-8), y, options);
    double at[2];
    for (std::size_t i = 0; i < times.size(); ++i) {
      result.dense(times[i], at);
      CHECK(std::abs(at[0] - y[2 * i]) < 1e-13);
    }
  }

  SUBCASE("events: once each, by direction, terminal, and at a common zero") {
    std::vector<Event> events{{[](double, const double* v) { return v[0]; }, 0, false},
                              {[](double, const double* v) { return v[0]; }, 1, false},
                              {[](double t, const double*) { return t - 7.0; }, 0, true}};
    DriveOptions options;
    options.events = events;
    const DriveResult result = run<Method>(oscillator, {1, 0}, {20}, within(1e-11), y, options);
    CHECK(result.ending == Ending::event);
    CHECK(result.t == doctest::Approx(7.0).epsilon(1e-14));
    REQUIRE(result.hits.size() == 4);   // pi/2, 3 pi/2 twice (rising), 7
    CHECK(result.hits[0].t == doctest::Approx(M_PI / 2).epsilon(1e-9));
    CHECK(result.hits[1].t == doctest::Approx(3 * M_PI / 2).epsilon(1e-9));
    CHECK(result.hits[2].t == result.hits[1].t);
    CHECK(result.hits[1].event == 0);   // at the same time, in the order in which they were given
    CHECK(result.hits[2].event == 1);
    CHECK(y.empty());
  }

  SUBCASE("a solution that blows up ends with the time reached") {
    const DriveResult result = run<Method>(Blowup{}, {1.0}, {0.5, 2.0}, within(1e-9), y);
    CHECK((result.ending == Ending::underflow || result.ending == Ending::not_finite));
    // A fixed step walks over the pole and needs a few more to leave the numbers.
    CHECK(std::abs(result.t - 1.0) < 1e-6 + 20 * within(1e-9).step);
    REQUIRE(y.size() == 1);
    CHECK(std::abs(y[0] - 2.0) < 1e-7);
  }

  SUBCASE("limits are kept: steps, and a progress that says stop") {
    DriveOptions options;
    options.max_steps = 5;
    Counts counts;
    CHECK(run<Method>(oscillator, {1, 0}, {1e3}, within(1e-9), y, options, &counts).ending == Ending::max_steps);
    CHECK(counts.steps == 5);
  }

  SUBCASE("scales of y and of time change nothing") {
    std::vector<double> z;
    run<Method>(Scaled{1.0}, {1, 0}, {10}, within(1e-9), y);
    for (const int power : {-40, 40}) {
      const double s = std::ldexp(1.0, power);
      run<Method>(Scaled{s}, {s, 0}, {10 / s}, at_accuracy<Method>(1e-9, s), z);
      CHECK(z[0] == y[0] * s);
      CHECK(z[1] == y[1] * s);
    }
  }
}

template <class... M>
void conform_all(std::tuple<M...>*) {
  (conform<M>(), ...);
}

}  // namespace

TEST_CASE("every method of the list conforms") {
  conform_all(static_cast<Methods*>(nullptr));
  conform<Taylor>();   // of problems with recurrences, as those of bodies are
}

TEST_CASE("the series kernels of every level agree, and avx2 and avx512 bit for bit") {
  double rows[series_width * 21], base[series_width], rest[series_width], s[7];
  unsigned seed = 1;
  const auto random = [&] {
    return static_cast<double>((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0 - 0.5;
  };
  for (double& x : rows) x = random();
  for (double& x : base) x = random();
  for (double& x : rest) x = 1e-16 * random();
  for (double& x : s) x = random();
  for (const int order : {1, 2, 3, 19, 20}) {
    double out[3][7 * series_width];
    for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > simd_level()) continue;
      double* mine = out[static_cast<int>(level)];
      series_kernels(level).evaluate(rows, order, series_width, base, rest, s, 7, mine);
      for (int p = 0; p < 7; ++p) {
        double alone[series_width];
        series_kernels(level).evaluate(rows, order, series_width, base, rest, s + p, 1, alone);
        for (int i = 0; i < series_width; ++i) {
          double sum = 0.0;
          for (int k = order; k >= 1; --k) sum = s[p] * (rows[series_width * k + i] + sum);
          CHECK(std::abs(mine[series_width * p + i] - (base[i] + sum)) < 1e-15);
          CHECK(mine[series_width * p + i] == alone[i]);
        }
      }
    }
    if (simd_level() == SimdLevel::avx512) CHECK(std::equal(out[1], out[1] + 7 * series_width, out[2]));
  }
}

TEST_CASE("two zeros within one step are both found, and a touch is met once") {
  std::vector<Event> events{{[](double, const double* y) { return (y[0] - 4.0) * (y[0] - 6.5); }, 0, false}};
  DriveOptions options;
  options.events = events;
  std::vector<double> y;
  Counts counts;
  const DriveResult result = run<Rk45>(Clock{}, {0.0}, {10.0}, {1e-3}, y, options, &counts);
  CHECK(counts.steps <= 8);
  REQUIRE(result.hits.size() == 2);
  CHECK(result.hits[0].t == doctest::Approx(4.0).epsilon(1e-14));
  CHECK(result.hits[1].t == doctest::Approx(6.5).epsilon(1e-14));
}

TEST_CASE("taylor has an order for any tolerance, and for none") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int last = 100;
  for (const double tolerance : {1e-300, 1e-16, 1e-9, 1e-3, 1.0, 1e9, nan}) {
    const int order = Taylor::choose_order(tolerance);
    CHECK(order >= Taylor::least_order);
    CHECK(order <= last);
    last = order;
  }
  CHECK(last == Taylor::least_order);
}
