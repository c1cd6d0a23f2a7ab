#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/spectrum/quadratics.hpp"

using namespace polhode::spectrum;

namespace {

constexpr std::size_t phases = 16, n = 40, shifts = 4;

struct Example {
  std::vector<double> axes, t, y, weight, functions;

  Example() {
    for (std::size_t curve = 0; curve < 3; ++curve) {
      for (std::size_t k = 0; k < phases; ++k) {
        const double p = 2.0 * std::numbers::pi * static_cast<double>(k) / phases;
        const double c = 0.3 + 0.2 * static_cast<double>(curve);
        for (const double x : {std::cos(p) * c, std::sin(p), c, -std::sin(2 * p), std::cos(3 * p), 0.4 * std::sin(p)})
          axes.push_back(x);
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      const double x = static_cast<double>(k);
      t.push_back(-11.0 + 0.61 * x + 0.2 * std::sin(3.0 * x));
      y.push_back(std::sin(1.3 * x * x) + 0.5);
      weight.push_back(0.5 + 0.1 * static_cast<double>(k % 4));
    }
    for (std::size_t k = 0; k < 5 * quadratic_numbers; ++k)
      functions.push_back(std::sin(2.1 * static_cast<double>(k * k)) + (k % quadratic_numbers == 0 ? 1.5 : 0.0));
  }

  /// The weighted values of one function along a curve, by its matrices.
  Eigen::VectorXd values(const Trial& trial, std::size_t shift, std::size_t function) const {
    Eigen::VectorXd out(n);
    const double* w = &functions[function * quadratic_numbers];
    for (std::size_t k = 0; k < n; ++k) {
      double place = trial.f * t[k] / (2 * std::numbers::pi) * phases;
      place += static_cast<double>(shift * phases / (2 * shifts));
      place -= phases * std::floor(place / phases);
      const std::size_t low = static_cast<std::size_t>(place) % phases, next = (low + 1) % phases;
      const double part = place - std::floor(place);
      double sum = w[0];
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double* a = &axes[(trial.curve * phases + low) * 6 + 3 * axis];
        const double* b = &axes[(trial.curve * phases + next) * 6 + 3 * axis];
        Eigen::Vector3d v = (1 - part) * Eigen::Map<const Eigen::Vector3d>(a);
        v += part * Eigen::Map<const Eigen::Vector3d>(b);
        v = Eigen::AngleAxisd(trial.g * t[k], Eigen::Vector3d::UnitZ()) * v;
        const double* m = w + 1 + 5 * axis;
        Eigen::Matrix3d W;
        W << m[0], m[2], m[3], m[2], m[1], m[4], m[3], m[4], -m[0] - m[1];
        sum += v.dot(W * v);
      }
      out[Eigen::Index(k)] = weight[k] * sum;
    }
    return out;
  }

  double cost(const Eigen::VectorXd& model, const Calibration& calibration) const {
    Eigen::VectorXd f = model, r = Eigen::Map<const Eigen::VectorXd>(y.data(), n);
    if (calibration.offset) {
      const Eigen::VectorXd one = Eigen::Map<const Eigen::VectorXd>(weight.data(), n).normalized();
      f -= one * one.dot(f), r -= one * one.dot(r);
    }
    const double scale = calibration.scale ? std::max(f.dot(r) / f.squaredNorm(), 0.0) : 1.0;
    return (r - scale * f).squaredNorm();
  }
};

}  // namespace

TEST_CASE("quadratic functions along curves leave what least squares leaves, for every phase") {
  const Example e;
  const std::vector<Trial> trials{{0, 0.7, 1.9}, {2, 0.31, -0.8}, {1, 1.1, 0.0}};
  for (const Calibration calibration : {Calibration{true, false}, Calibration{true, true}, Calibration{false, false},
                                        Calibration{false, true}}) {
    std::vector<double> cost(trials.size() * shifts), which(cost.size()), other(cost.size());
    match_quadratics({e.t, e.y, e.weight, 1}, {e.axes, phases}, trials, shifts, e.functions, calibration, cost.data(),
                     which.data(), 1);
    for (std::size_t k = 0; k < trials.size(); ++k) {
      for (std::size_t s = 0; s < shifts; ++s) {
        double least = 1e300;
        std::size_t best = 0;
        for (std::size_t a = 0; a < 5; ++a) {
          const double here = e.cost(e.values(trials[k], s, a), calibration);
          if (here < least) least = here, best = a;
        }
        CHECK(cost[k * shifts + s] == doctest::Approx(least).epsilon(1e-9));
        const double nothing = e.cost(Eigen::VectorXd::Zero(n), {false, calibration.offset});
        if (least < nothing - 1e-9)   // else no factor >= 0 helps, and all leave the same
          CHECK(which[k * shifts + s] == static_cast<double>(best));
      }
    }
    match_quadratics({e.t, e.y, e.weight, 1}, {e.axes, phases}, trials, shifts, e.functions, calibration, other.data(),
                     which.data(), 2);
    CHECK(cost == other);
  }
}

TEST_CASE("sizes of quadratic functions and curves are checked") {
  const Example e;
  double cost[shifts], which[shifts];
  const std::vector<Trial> beyond{{3, 1.0, 1.0}}, good{{0, 1.0, 1.0}};
  const std::vector<double> odd(12, 1.0);
  const Series series{e.t, e.y, e.weight, 1}, two{e.t, e.y, e.weight, 2};
  const Curves curves{e.axes, phases};
  CHECK_THROWS_AS(match_quadratics(series, curves, beyond, shifts, e.functions, {}, cost, which),
                  polhode::InvalidInput);
  CHECK_THROWS_AS(match_quadratics(series, curves, good, 3, e.functions, {}, cost, which),
                  polhode::InvalidInput);
  CHECK_THROWS_AS(match_quadratics(series, curves, good, shifts, odd, {}, cost, which),
                  polhode::InvalidInput);
  CHECK_THROWS_AS(match_quadratics(two, curves, good, shifts, e.functions, {}, cost, which),
                  polhode::InvalidInput);
}
