#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cfenv>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "polhode/batch/step.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/step.hpp"

using namespace polhode;

namespace {

typedef float FourFloats __attribute__((vector_size(16)));
typedef double FourDoubles __attribute__((vector_size(32)));
template <class T>
struct FourOf {
  using type = FourFloats;
};
template <>
struct FourOf<double> {
  using type = FourDoubles;
};

template <class T>
constexpr double rounding = std::numeric_limits<T>::epsilon();

struct Case {
  std::string kind;
  double I[3], L[3], h, p[4];
};

/// tests/reference/free_step.csv: mpmath, 30 digits.
std::vector<Case> read_cases() {
  std::ifstream file(std::string(POLHODE_REFERENCE) + "/free_step.csv");
  std::vector<Case> cases;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    Case c;
    std::getline(cells, c.kind, ',');
    double numbers[11];
    for (double& x : numbers) {
      std::string cell;
      std::getline(cells, cell, ',');
      x = std::stod(cell);
    }
    std::copy_n(numbers, 3, c.I), std::copy_n(numbers + 3, 3, c.L), c.h = numbers[6], std::copy_n(numbers + 7, 4, c.p);
    cases.push_back(c);
  }
  return cases;
}

/// The angle between two attitudes, to rounding.
template <class T>
double compute_angle(const step::Quat<T>& p, const double* q) {
  const double v[4] = {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z),
                       static_cast<double>(p.w)};
  double near = 0.0, far = 0.0;
  for (int i = 0; i < 4; ++i) near += std::pow(v[i] - q[i], 2), far += std::pow(v[i] + q[i], 2);
  return 4 * std::asin(std::min(1.0, std::sqrt(std::min(near, far)) / 2));
}

template <class T>
step::Inertia<T> make(const double* I) {
  return step::make_inertia(static_cast<T>(I[0]), static_cast<T>(I[1]), static_cast<T>(I[2]));
}

template <int N, class T>
step::Quat<T> rotation(const double* I, const double* L, double h) {
  const auto body = make<T>(I);
  const T k = static_cast<T>(h / 4) * body.scale;
  return step::free_rotation<N>(body, step::Vec<T>{k * static_cast<T>(L[0]), k * static_cast<T>(L[1]),
                                               k * static_cast<T>(L[2])});
}

/// Random moments of a body, and L for a unit rate.
struct Random {
  std::mt19937 bits{15};
  double I[3], L[3];

  void draw() {
    std::uniform_real_distribution<double> even(0.1, 1.0);
    std::normal_distribution<double> normal;
    const double m[3] = {even(bits), even(bits), even(bits)};
    double w[3], size = 0.0;
    for (int i = 0; i < 3; ++i) {
      I[i] = m[(i + 1) % 3] + m[(i + 2) % 3];
      w[i] = normal(bits), size += w[i] * w[i];
    }
    for (int i = 0; i < 3; ++i) L[i] = I[i] * w[i] / std::sqrt(size);
  }
};

double energy(const double* I, double x, double y, double z) { return x * x / I[0] + y * y / I[1] + z * z / I[2]; }

template <int N>
double largest_error(double h) {
  Random body;
  double worst = 0.0;
  for (int k = 0; k < 40; ++k) {
    body.draw();
    const Vector3d w{body.L[0] / body.I[0], body.L[1] / body.I[1], body.L[2] / body.I[2]};
    const State end = FreeMotion(InertiaTensor::from_moments({body.I[0], body.I[1], body.I[2]}), w).at(h);
    const double q[4] = {end.attitude.x, end.attitude.y, end.attitude.z, end.attitude.w};
    worst = std::max(worst, compute_angle(rotation<N, double>(body.I, body.L, h), q));
  }
  return worst;
}

}  // namespace

TEST_CASE("free step: the rotation of stored bodies, float64 and float32, against mpmath") {
  for (const Case& c : read_cases()) {
    CAPTURE(c.kind);
    CAPTURE(c.h);
    const bool long_step = std::abs(c.h) > 0.9 && c.kind != "sphere" && c.kind != "principal" && c.kind != "racket";
    CHECK(compute_angle(rotation<5, double>(c.I, c.L, c.h), c.p) < (long_step ? 2e-11 : 4e-15));
    CHECK(compute_angle(rotation<3, float>(c.I, c.L, c.h), c.p) < (c.kind == "needle" ? 1e-5 : 2e-6));
  }
  CHECK(read_cases().size() == 33);
}

TEST_CASE("free step: the local error falls as h^(2 N + 3)") {
  const double two = std::log2(largest_error<2>(0.8) / largest_error<2>(0.4));
  const double three = std::log2(largest_error<3>(1.0) / largest_error<3>(0.5));
  const double five = std::log2(largest_error<5>(2.4) / largest_error<5>(1.2));
  CHECK(std::abs(two - 7) < 0.5);
  CHECK(std::abs(three - 9) < 0.7);
  CHECK(std::abs(five - 13) < 1.0);
  CHECK(largest_error<5>(0.5) < 2e-15);
  const double longest = largest_error<5>(2.0);   // of the order of the first term left out
  CHECK(longest > 5e-13);
  CHECK(longest < 1.5e-12);
}

TEST_CASE_TEMPLATE("free step: energy, |L| and L in space of each step, up to 1000 rad", T, float, double) {
  Random body;
  for (int k = 0; k < 300; ++k) {
    body.draw();
    for (const double h : {1e-3, 0.1, 1.0, 10.0, 1000.0}) {
      const auto inertia = make<T>(body.I);
      const step::Vec<T> L{static_cast<T>(body.L[0]), static_cast<T>(body.L[1]), static_cast<T>(body.L[2])};
      step::Vec<T> end = L;
      step::Quat<T> q{0, 0, 0, 1};
      step::drift_body(inertia, static_cast<T>(h), end, q);
      double sizes[2] = {0.0, 0.0}, energies[2] = {0.0, 0.0};
      const T* values[2] = {&L.x, &end.x};
      for (int i = 0; i < 2; ++i) {
        const double x = static_cast<double>(values[i][0]), y = static_cast<double>(values[i][1]);
        const double z = static_cast<double>(values[i][2]);
        sizes[i] = std::sqrt(x * x + y * y + z * z), energies[i] = energy(body.I, x, y, z);
      }
      // A long step rotates by |omega| h, whose own rounding is |omega| h eps: it moves L along the polhode alone.
      CHECK(std::abs(energies[1] / energies[0] - 1) < 20 * rounding<T>);
      CHECK(std::abs(sizes[1] / sizes[0] - 1) < 8 * rounding<T>);
      const step::Vec<T> back = step::rotate_back(step::Quat<T>{-q.x, -q.y, -q.z, q.w}, end);
      CHECK(std::abs(static_cast<double>(back.x - L.x)) < 8 * rounding<T> * sizes[0]);
      CHECK(std::abs(static_cast<double>(back.z - L.z)) < 8 * rounding<T> * sizes[0]);
    }
  }
}

TEST_CASE("free step: a step and its opposite are the identity; spheres, principal spins, symmetric bodies") {
  Random body;
  for (int k = 0; k < 200; ++k) {
    body.draw();
    for (const double h : {0.1, 1.0, 3.0}) {
      const auto inertia = step::make_inertia(body.I[0], body.I[1], body.I[2]);
      step::Vec<double> L{body.L[0], body.L[1], body.L[2]};
      step::Quat<double> q{0, 0, 0, 1};
      step::drift_body(inertia, h, L, q);
      step::drift_body(inertia, -h, L, q);
      const double start[4] = {0, 0, 0, 1};
      CHECK(compute_angle(q, start) < 5e-15);
    }
  }
  const double symmetric[3] = {0.4, 0.2, 0.4}, L[3] = {0.1, 0.15, -0.2};
  const FreeMotion truth(InertiaTensor::from_moments({0.4, 0.2, 0.4}), {0.25, 0.75, -0.5});
  const State end = truth.at(1.0);
  const double q[4] = {end.attitude.x, end.attitude.y, end.attitude.z, end.attitude.w};
  CHECK(compute_angle(rotation<5, double>(symmetric, L, 1.0), q) < 1e-14);
  for (int axis = 0; axis < 3; ++axis) {
    const double I[3] = {0.2, 0.4, 0.5};
    double spin[3] = {0, 0, 0}, half[4] = {0, 0, 0, std::cos(15.0)};
    spin[axis] = I[axis], half[axis] = std::sin(15.0);
    CHECK(compute_angle(rotation<5, double>(I, spin, 30.0), half) < 4e-14);
    CHECK(compute_angle(rotation<3, float>(I, spin, 30.0), half) < 2e-5);
  }
}

TEST_CASE_TEMPLATE("free step: never a number that is not finite, whatever the body and the step", T, float, double) {
  std::mt19937 bits(3);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::normal_distribution<double> normal;
  long wrong = 0;
  for (int k = 0; k < 100000; ++k) {
    double I[3], L[3];
    for (double& x : I) x = std::pow(10.0, -12 * even(bits) * (k % 2));
    for (double& x : L) x = normal(bits);
    if (k % 5 == 0) L[0] = 0;
    if (k % 11 == 0) L[1] = L[2] = 0;
    if (k % 101 == 0) L[0] = L[1] = L[2] = 0;
    if (k % 7 == 0) I[1] = I[0];
    const auto p = rotation<0, T>(I, L, std::pow(10.0, 4 - 30 * even(bits) * (k % 3 == 0)));
    const double zero[4] = {0, 0, 0, 0};
    wrong += !(std::abs(compute_angle(p, zero) - 4 * std::asin(0.5)) < 1e-5);   // |p| = 1
  }
  CHECK(wrong == 0);
}

TEST_CASE_TEMPLATE("free step in lanes: bodies at rest or nearly so make no subnormal number", T, float, double) {
  if (simd_level() == SimdLevel::baseline) return;
  constexpr std::size_t n = 64;
  T I[3 * n], L[3 * n], q[4 * n] = {};
  Random body;
  for (std::size_t i = 0; i < n; ++i) {
    body.draw();
    for (std::size_t k = 0; k < 3; ++k) {
      I[3 * i + k] = static_cast<T>(i % 4 == 0 ? 1.0 : i % 4 == 1 ? (k == 2 ? 0.5 : 1.0) : body.I[k]);
      const double slow = std::pow(10.0, (sizeof(T) == 4 ? -0.12 : -0.9) * static_cast<double>(i));
      L[3 * i + k] = i % 8 == 7 ? T(0) : static_cast<T>(slow * body.L[k]);
    }
    q[4 * i + 3] = 1;
  }
  StepBatch<T> batch;
  batch.bodies = n, batch.moments = I, batch.momentum = L, batch.attitude = q, batch.step = T(0.01), batch.count = 10;
  for (const bool space : {true, false}) {
    batch.space = space;
    std::feclearexcept(FE_ALL_EXCEPT);
    step_bodies(batch, 1);
    CHECK_FALSE(std::fetestexcept(FE_UNDERFLOW));
  }
}

TEST_CASE_TEMPLATE("free step: full tensors, vectors of lanes", T, float, double) {
  using Four = typename FourOf<T>::type;
  Random body;
  for (int k = 0; k < 50; ++k) {
    body.draw();
    const auto inertia = make<T>(body.I);
    const Four none = {};
    const step::Inertia<Four> wide{{none + inertia.a[0], none + inertia.a[1], none + inertia.a[2]},
                                   none + inertia.scale};
    step::Vec<T> L{static_cast<T>(body.L[0]), static_cast<T>(body.L[1]), static_cast<T>(body.L[2])};
    step::Vec<Four> wide_L{none + L.x, none + L.y, none + L.z};
    step::Quat<T> q{0, 0, 0, 1};
    step::Quat<Four> wide_q{none, none, none, none + T(1)};
    step::drift_body(inertia, T(0.7), L, q);
    step::drift_body(wide, none + T(0.7), wide_L, wide_q);
    const double lane[4] = {static_cast<double>(wide_q.x[2]), static_cast<double>(wide_q.y[2]),
                            static_cast<double>(wide_q.z[2]), static_cast<double>(wide_q.w[2])};
    CHECK(compute_angle(q, lane) < 20 * rounding<T>);
    CHECK(std::abs(static_cast<double>(L.y - wide_L.y[2])) < 10 * rounding<T>);

    // The same body in axes rotated by b: its tensor is R diag(I) R^T.
    const step::Quat<double> b{0.1, -0.3, 0.5, std::sqrt(1 - 0.35)};
    double M[3][3] = {};
    for (int i = 0; i < 3; ++i) {
      const step::Vec<double> axis{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
      const step::Vec<double> e = step::rotate_back(step::Quat<double>{-b.x, -b.y, -b.z, b.w}, axis);
      const double v[3] = {e.x, e.y, e.z};
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) M[r][c] += body.I[i] * v[r] * v[c];
    }
    const auto full = step::make_principal(static_cast<T>(M[0][0]), static_cast<T>(M[1][1]), static_cast<T>(M[2][2]),
                                           static_cast<T>(M[0][1]), static_cast<T>(M[0][2]), static_cast<T>(M[1][2]));
    const Matrix3d tensor = Eigen::Map<Matrix3d>(&M[0][0]);
    const Vector3d L_W{0.3, -0.2, 0.4};
    const State end = FreeMotion(InertiaTensor(tensor), tensor.inverse() * L_W).at(0.7);
    step::Quat<T> q_WB{0, 0, 0, 1};
    step::drift_space(full, T(0.7), step::Vec<T>{T(0.3), T(-0.2), T(0.4)}, q_WB);
    const double truth[4] = {end.attitude.x, end.attitude.y, end.attitude.z, end.attitude.w};
    CHECK(compute_angle(q_WB, truth) < 100 * rounding<T>);
  }
}
