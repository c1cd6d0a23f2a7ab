#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/spectrum/lines.hpp"

using polhode::spectrum::Grid;
using polhode::spectrum::Line;
using polhode::spectrum::Series;

namespace {

constexpr std::size_t n = 23, count = 4;

/// Times, series and weights without any order in them.
struct Samples {
  std::vector<double> t, y, weight;

  Samples() {
    for (std::size_t k = 0; k < n; ++k) {
      const double x = static_cast<double>(k);
      t.push_back(7.3 * x + 3.0 * std::sin(5.0 * x));
      weight.push_back(0.5 + 0.1 * static_cast<double>(k % 5));
      for (std::size_t j = 0; j < count; ++j) y.push_back(std::sin(1.7 * x * x + 2.3 * static_cast<double>(j)));
    }
  }
};

/// Y^T P Y by the singular values of the columns.
Eigen::MatrixXd project_by_svd(const Samples& s, const std::vector<Line>& lines, double f, double g) {
  Eigen::MatrixXd columns(n, 2 * lines.size()), y(n, count);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < lines.size(); ++j) {
      const double phase = (lines[j].a * f + lines[j].b * g) * s.t[k];
      columns(Eigen::Index(k), Eigen::Index(2 * j)) = s.weight[k] * std::cos(phase);
      columns(Eigen::Index(k), Eigen::Index(2 * j + 1)) = s.weight[k] * std::sin(phase);
    }
    for (std::size_t j = 0; j < count; ++j) y(Eigen::Index(k), Eigen::Index(j)) = s.y[count * k + j];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeThinU);
  const Eigen::Index rank = (svd.singularValues().array() > 1e-6 * svd.singularValues()[0]).count();
  const Eigen::MatrixXd seen = svd.matrixU().leftCols(rank).transpose() * y;
  return seen.transpose() * seen;
}

}  // namespace

TEST_CASE("lines of two frequencies take away what their columns span, at every trial of both grids") {
  const Samples s;
  const std::vector<Line> lines{{0, 0}, {1, 0}, {1, -1}, {1, 1}, {0, 2}};
  const Grid f{0.31, 0.017, 3}, g{0.05, 0.009, 200};
  std::vector<double> out(f.count * g.count * 2 * 4);   // two blocks of 2 x 2 a trial
  polhode::spectrum::project({s.t, s.y, s.weight, count}, lines, f, g, 2, out.data());
  for (std::size_t i = 0; i < f.count; ++i) {
    for (const std::size_t j : {std::size_t{0}, std::size_t{77}, g.count - 1}) {
      const Eigen::MatrixXd expected = project_by_svd(s, lines, f.first + f.step * static_cast<double>(i),
                                                      g.first + g.step * static_cast<double>(j));
      const double* found = &out[(i * g.count + j) * 8];
      for (int block = 0; block < 2; ++block) {
        for (int a = 0; a < 2; ++a) {
          for (int b = 0; b < 2; ++b) {
            CHECK(found[4 * block + 2 * a + b] == doctest::Approx(expected(2 * block + a, 2 * block + b)).epsilon(1e-9));
          }
        }
      }
    }
  }
}

TEST_CASE("columns that are sums of others add nothing") {
  const Samples s;
  std::vector<double> out(count), constant(count);
  const std::vector<Line> lines{{0, 0}, {0, 1}, {0, 2}};
  polhode::spectrum::project({s.t, s.y, s.weight, count}, lines, {}, {0.0, 0.0, 1}, 1, out.data());
  polhode::spectrum::project({s.t, s.y, s.weight, count}, std::vector<Line>{{0, 0}}, {}, {}, 1, constant.data());
  for (std::size_t j = 0; j < count; ++j) CHECK(out[j] == doctest::Approx(constant[j]).epsilon(1e-12));
}

TEST_CASE("a periodogram is the square of a Fourier sum, after many turns of its phases too") {
  const Samples s;
  std::vector<double> power(5000);
  const Grid f{-3.0, 0.0012, power.size()};
  polhode::spectrum::periodogram(s.t, s.y, count / 2, f, power.data());
  for (const std::size_t trial : {std::size_t{0}, std::size_t{2500}, power.size() - 1}) {
    double expected = 0.0;
    for (std::size_t j = 0; j < count / 2; ++j) {
      std::complex<double> sum;
      for (std::size_t k = 0; k < n; ++k) {
        const std::complex<double> z(s.y[count * k + 2 * j], s.y[count * k + 2 * j + 1]);
        sum += z * std::polar(1.0, -(f.first + f.step * static_cast<double>(trial)) * s.t[k]);
      }
      expected += std::norm(sum);
    }
    CHECK(power[trial] == doctest::Approx(expected).epsilon(1e-10));
  }
}

TEST_CASE("series of other sizes than the times are refused") {
  const Samples s;
  std::vector<double> out(64);
  CHECK_THROWS_AS(polhode::spectrum::project({s.t, s.y, s.weight, 3}, std::vector<Line>{{0, 0}}, {}, {}, 1, out.data()),
                  polhode::InvalidInput);
  CHECK_THROWS_AS(
      polhode::spectrum::project({s.t, s.y, s.weight, count}, std::vector<Line>{{0, 0}}, {}, {}, 3, out.data()),
      polhode::InvalidInput);
  CHECK_THROWS_AS(polhode::spectrum::periodogram(s.t, s.y, 3, {}, out.data()), polhode::InvalidInput);
}
