#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "error_range.hpp"
#include "polhode/batch/gyrostat.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/detail/gyrostat_kernels.hpp"
#include "polhode/exact/gyrostat.hpp"
#include "polhode/exact/heavy_top.hpp"

using namespace polhode;

namespace {

const Quat gyrostat_start = normalized({0.3, 0.1, 0.2, 0.9});

double gyrostat_angle(const Quat& a, const Quat& b) {
  const Quat d = conjugate(a) * b;
  return 2 * std::asin(std::min(1.0, std::hypot(d.x, d.y, d.z)));
}

}  // namespace

TEST_CASE("the gyrostat's momentum in space and its energy are the start's") {
  ErrorRange momentum{"momentum", 2e-16, 3e-15}, energy{"energy", 2e-16, 6e-15}, norm{"|q|", 1e-16, 9e-16};
  const Vector3d bodies[] = {{1, 2, 2.5}, {0.2, 0.4, 0.52}, {1, 1, 1.6}, {1, 1, 1}, {1e-6, 1, 1}};
  const Vector3d rotors[] = {{0, 0, 0.3}, {0.1, 0, 0}, {0, 0.02, 0}, {0.3, -0.2, 0.1}, {3, 2, -1}, {0, 1e-9, 1e-9}};
  const Vector3d starts[] = {{1, 2, 3}, {1e-4, 5, 1e-4}, {0, 1, 0}, {0, 0, 1e-12}, {-0.5, 0.2, 1e-3}};
  for (const Vector3d& J : bodies)
    for (const Vector3d& h : rotors)
      for (const Vector3d& w : starts) {
        const Gyrostat motion(J, h, w, gyrostat_start);
        const Vector3d M = motion.angular_momentum();
        double rates = 0;
        for (int i = -20; i <= 20; ++i) rates = std::max(rates, motion.at(0.7 * i).omega.norm());
        const double size = h.norm() + J.maxCoeff() * rates;
        for (int i = -20; i <= 20; ++i) {
          const State s = motion.at(0.7 * i);
          const Vector3d L = J.cwiseProduct(s.omega);
          momentum.add((rotate(s.attitude, Vector3d(L + h)) - M).norm() / size);
          energy.add(std::abs(0.5 * L.dot(s.omega) - motion.energy()) / (J.maxCoeff() * rates * rates));
          norm.add(std::abs(polhode::norm(s.attitude) - 1));
        }
      }
}

TEST_CASE("a wheel on the axis of a symmetric body: the top without weight, turned back") {
  ErrorRange rates{"omega", 5e-17, 4e-15}, angles{"attitude", 5e-17, 4e-15};
  const Vector3d J{1, 1, 0.6}, w{0.3, -0.7, 2.0};
  const double h = 0.45;
  const Gyrostat motion(J, {0, 0, h}, w, gyrostat_start);
  const HeavyTop plain(J, 0.0, w + Vector3d(0, 0, h / J[2]), gyrostat_start);
  CHECK(motion.kind() == GyrostatKind::precession);
  for (const double t : {0.0, 0.5, -1.0, 2.0}) {
    const State a = motion.at(t), b = plain.at(t);
    const double angle = h * t / J[2], c = std::cos(angle), s = std::sin(angle);
    const Vector3d turned{c * b.omega[0] - s * b.omega[1], s * b.omega[0] + c * b.omega[1], b.omega[2] - h / J[2]};
    rates.add((a.omega - turned).norm() / w.norm());
    angles.add(gyrostat_angle(a.attitude, b.attitude * Quat{0, 0, -std::sin(angle / 2), std::cos(angle / 2)}));
  }
}

TEST_CASE("every regime of the gyrostat has its name and period") {
  const auto kind = [](const Vector3d& J, const Vector3d& h, const Vector3d& w) { return Gyrostat(J, h, w).kind(); };
  CHECK(kind({2, 3, 4}, {3, -4, 5}, {-1, 1, -1}) == GyrostatKind::steady);
  CHECK(kind({2, 3, 4}, {3, -4, 5}, {0, 0, 0}) == GyrostatKind::rest);
  CHECK(kind({1, 1, 1}, {1, 0, 0}, {0, 1, 0}) == GyrostatKind::precession);
  CHECK(kind({1, 2, 2.5}, {0.01, 0, 0.01}, {0, 1, 2}) == GyrostatKind::paired);
  CHECK(kind({1, 2, 2.5}, {5, 3, 1}, {0.1, 0.2, 0.3}) == GyrostatKind::single);
  // M = (3, 6, 6) has the energy of the saddle M = (0, 9, 0).
  const Gyrostat flip({3, 4, 6}, {0, 1.5, 0}, {1, 1.125, 1});
  CHECK(flip.kind() == GyrostatKind::separatrix);
  CHECK(flip.period() == std::numeric_limits<double>::infinity());
  CHECK((flip.polhode(200.0) - Vector3d(0, 9, 0)).norm() < 1e-13);
  CHECK((flip.polhode(-200.0) - Vector3d(0, 9, 0)).norm() < 1e-13);
}

TEST_CASE("the same gyrostats at AVX2 and AVX-512 have the same bits") {
  const exact::GyrostatKernels &a = exact::gyrostat_kernels(SimdLevel::avx2),
                               &b = exact::gyrostat_kernels(SimdLevel::avx512);
  if (&a == &b || simd_level() != SimdLevel::avx512) return;
  std::vector<double> t(301), w1(903), w2(903), q1(1204), q2(1204);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = 0.37 * static_cast<double>(i * i % 97);
  exact::GyrostatSeries trig, hyper;
  exact::FreeFrame frame{};
  frame.time_scale = 1.0;
  for (int c = 0; c < 3; ++c) frame.omega[4 * c] = 1.0;
  for (int c = 0; c < 4; ++c) frame.attitude[5 * c] = 1.0;
  trig.nu_hi = 0.1, trig.kappa_hi = 0.03, hyper.hyper = true, hyper.nu_hi = 0.02, hyper.v_rate_hi = 0.12;
  hyper.v_passage_hi = 6.0, hyper.nome = 0.0024788, hyper.alternates = 1.0;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) trig.spinor[i].even_cos[k] = trig.spinor[i].odd_sin[k] = 1.0 / (1 + i + 3 * k);
    for (int k = 0; k < 9; ++k) hyper.hyper_spinor[i][k] = 0.3 + 0.1 * i - 0.05 * k;
    for (int k = 0; k < 9 && i < 3; ++k) hyper.hyper_rate[i][k] = 0.2 * i + 0.01 * k;
  }
  for (const exact::GyrostatSeries& series : {trig, hyper}) {
    a.at(series, frame, exact::TimeGrid(t.data(), t.size()), w1.data(), q1.data());
    b.at(series, frame, exact::TimeGrid(t.data(), t.size()), w2.data(), q2.data());
    CHECK(w1 == w2);
    CHECK(q1 == q2);
  }
}
