#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "error_range.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/free_motion.hpp"

using namespace polhode;

namespace {

const Vector3d block{0.20, 0.40, 0.52};
const Quat start = normalized({0.5, -0.1, 0.7, 0.5});

double angle_between(const Quat& a, const Quat& b) {
  const Quat d = conjugate(a) * b;
  return 2 * std::asin(std::min(1.0, std::hypot(d.x, d.y, d.z)));
}

/// Energy and angular momentum in space are constant, the attitude stays unit, and t = 0 gives the start.
struct InvariantErrors {
  ErrorRange norm{"|q|", 1.4e-16, 8.8e-16};                             // 4.4e-16
  ErrorRange momentum{"angular momentum in space", 7.2e-16, 4.4e-15};   // 2.2e-15 to 2.3e-15
  ErrorRange energy{"energy", 6.6e-16, 4.4e-15};                        // 2.0e-15
  ErrorRange omega{"omega at t = 0", 2.2e-16, 2.4e-15};                 // 6.7e-16 to 7.9e-16
  ErrorRange attitude{"attitude at t = 0", 1.2e-16, 1.5e-15};           // 3.9e-16 to 5.0e-16

  void add(const Vector3d& moments, const Vector3d& omega_0, double span) {
    const FreeMotion motion(moments, omega_0, start);
    const Vector3d L_W = motion.angular_momentum();
    for (int i = -20; i <= 20; ++i) {
      const State s = motion.at(span * (i / 20.0));
      const Vector3d L_B = moments.cwiseProduct(s.omega);
      norm.add(std::abs(polhode::norm(s.attitude) - 1));
      momentum.add((rotate(s.attitude, L_B) - L_W).norm() / L_W.norm());
      energy.compare(0.5 * L_B.dot(s.omega), motion.energy());
    }
    const State first = motion.at(0.0);
    omega.add((first.omega - omega_0).norm() / omega_0.norm());
    attitude.add(angle_between(first.attitude, start));
  }
};

}  // namespace

TEST_CASE("energy and momentum in space stay the start's, in every regime") {
  InvariantErrors errors;
  const Vector3d starts[] = {{1, 2, 3},     {3, 2, 1}, {-1, 2, -3},        {1e-4, 5, 1e-4}, {1e-9, 5, 1e-7},
                             {0, 5, 1e-12}, {1, 0, 0}, {0, 1, 0},          {0, 0, -1},      {1, 1, 0},
                             {0, 1, 1},     {1, 0, 1}, {1e-160, 1, 1e-150}};
  const Vector3d bodies[] = {block,           {0.52, 0.2, 0.4}, {0.4, 0.52, 0.2}, {1, 1, 1},      {1, 1, 2},
                             {2, 1, 2},       {1, 1, 1 + 1e-15}, {1, 1 + 1e-9, 1.5}, {1e-12, 1, 1}, {1, 2, 3}};
  for (const Vector3d& moments : bodies)
    for (const Vector3d& omega : starts) errors.add(moments, omega, 1e3);
  errors.add(block, Vector3d(1, 2, 3) * 1e150, 1e-140);
  errors.add(block, Vector3d(1, 2, 3) * 1e-150, 1e156);
}

TEST_CASE("the kind is decided at construction") {
  const auto kind = [](Vector3d moments, Vector3d omega) { return FreeMotion(moments, omega).kind(); };
  CHECK(kind(block, {0, 0, 0}) == FreeKind::rest);
  CHECK(kind({2, 2, 2}, {0, 1, 0}) == FreeKind::spherical);
  CHECK(kind(block, {0, 1, 0}) == FreeKind::steady);
  CHECK(kind(block, {0, 0, 1}) == FreeKind::steady);
  CHECK(kind({1, 1, 2}, {1, 1, 0}) == FreeKind::steady);
  CHECK(kind({1, 1, 2}, {1, 1, 1}) == FreeKind::oblate);
  CHECK(kind({2, 1, 2}, {1, 1, 1}) == FreeKind::prolate);
  CHECK(kind(block, {1, 0.1, 0.1}) == FreeKind::about_least);
  CHECK(kind({0.52, 0.2, 0.4}, {1, 0.1, 0.1}) == FreeKind::about_greatest);
  CHECK(kind({2, 5, 6}, {1, 7, -1}) == FreeKind::separatrix);
  CHECK(kind({2, 5, 6}, {1, 7, std::nextafter(1.0, 2)}) == FreeKind::about_greatest);
  CHECK(kind({2, 5, 6}, {std::nextafter(1.0, 2), 7, 1}) == FreeKind::about_least);
  CHECK(std::string(to_text(FreeKind::separatrix)) == "separatrix");
}

TEST_CASE("a symmetric body precesses at L / I1 and spins at the textbook rate") {
  // Landau & Lifshitz, Mechanics, section 33: phi' = L / I1, psi' = L cos(theta) (1 / I3 - 1 / I1).
  ErrorRange rates{"precession and spin rates", 7e-17, 1e-15};   // 2.1e-16
  ErrorRange angles{"Euler's angles", 1.5e-16, 2e-15};           // 5.6e-16
  for (const double axial : {0.2, 0.7}) {
    const Vector3d moments{0.4, 0.4, axial}, omega{0.5, 0, 4};
    const FreeMotion motion(moments, omega);
    const Vector3d L_B = moments.cwiseProduct(omega);
    rates.compare(motion.precession_rate(), L_B.norm() / 0.4);
    const double spin = L_B[2] * (1 / axial - 1 / 0.4);
    rates.compare(motion.period(), 2 * std::numbers::pi / std::abs(spin));
    const Vector3d a = motion.euler_angles(0), b = motion.euler_angles(0.25);
    angles.add(std::abs(b[1] - std::acos(L_B[2] / L_B.norm())));
    angles.add(std::abs(std::remainder(b[0] - a[0] - 0.25 * L_B.norm() / 0.4, 2 * std::numbers::pi)));
    angles.add(std::abs(std::remainder(b[2] - a[2] - 0.25 * spin, 2 * std::numbers::pi)));
  }
}

TEST_CASE("the exact separatrix is the hyperbolic solution: one flip, both ways in time") {
  // I = (2, 5, 6), w1 = w3: I1 (I2 - I1) w1^2 = I3 (I3 - I2) w3^2. Then w2 = W tanh(s (t - t0)).
  const Vector3d moments{2, 5, 6}, omega{1, -0.75, 1};
  const FreeMotion motion(moments, omega);
  REQUIRE(motion.kind() == FreeKind::separatrix);
  CHECK(std::isinf(motion.period()));
  const double T2 = moments.cwiseProduct(omega).dot(omega), W = std::sqrt(T2 / 5);
  const double slope = (6.0 - 2.0) / 5.0 / (W * (1 - 0.75 * 0.75 / W / W));  // from w2' = (I3 - I1) / I2 w1 w3
  const auto flips = motion.flip_times(-1e3, 1e3);
  REQUIRE(flips.size() == 1);
  ErrorRange times{"time of the flip", 0, 1e-15};   // 1.5e-16
  ErrorRange rates{"omega", 1e-16, 3.2e-15};        // 3.4e-16 to 1.0e-15
  ErrorRange angles{"angle", 0, 3e-15};             // 4.5e-16 to 7.6e-16
  times.compare(flips[0], std::atanh(0.75 / W) / slope);
  for (const double t : {-30.0, -1.0, 0.3, 2.0, 40.0}) {
    rates.compare(motion.at(t).omega[1], W * std::tanh(slope * (t - flips[0])));
  }
  // Long after, it turns steadily about the intermediate axis.
  rates.compare(motion.precession_rate(), W);
  const double turn = angle_between(motion.at(200.0).attitude, motion.at(200.5).attitude);
  angles.compare(turn, 0.5 * W);
}

TEST_CASE("the racket flips at equal intervals, half a period apart") {
  const FreeMotion motion(block, {1e-4, 5, 1e-4});
  const auto flips = motion.flip_times(0, 200);
  REQUIRE(flips.size() == 19);
  ErrorRange intervals{"interval of flips", 6e-16, 6e-15};   // 1.9e-15
  ErrorRange rates{"omega at a flip", 4e-14, 4e-13};         // 1.3e-13
  for (std::size_t i = 0; i + 1 < flips.size(); ++i) intervals.compare(flips[i + 1] - flips[i], motion.period() / 2);
  for (const double t : flips) rates.add(std::abs(motion.at(t).omega[1]));
  CHECK(motion.flip_times(-200, 0).size() == 19);
  CHECK(FreeMotion({1, 1, 2}, {1, 1, 1}).flip_times(0, 100).empty());
}

TEST_CASE("k^2 = 0.97, where the form of the series changes, shows no seam") {
  // I = (1, 2, 3), w = (x, 1, 0): k^2 goes through 0.97; neighbours on both sides differ only as their starts do.
  ErrorRange differences{"omega between neighbours", 1.1e-5, 1.1e-4};   // 3.5e-5
  double before = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = 0.16 + 1e-5 * i;
    const State s = FreeMotion({1, 2, 3}, {x, 1, 0}).at(7.0);
    if (i > 0) differences.add(std::abs(s.omega[1] - before));
    before = s.omega[1];
  }
}

TEST_CASE("a full tensor moves as its principal body does") {
  const Quat q_BP = normalized({0.1, 0.7, -0.3, 0.6});
  const Matrix3d R_BP = to_matrix(q_BP);
  const InertiaTensor tensor = InertiaTensor::from_moments(block).rotated(q_BP);
  const Vector3d w_P{1, 2, 3};
  const FreeMotion full(tensor, R_BP * w_P, start), principal(block, w_P, start * q_BP);
  CHECK(full.kind() == principal.kind());
  ErrorRange rates{"omega", 3.8e-14, 3.8e-13};    // 1.2e-13
  ErrorRange angles{"attitude", 2e-14, 2e-13};    // 6.6e-14
  for (const double t : {0.0, 1.0, -7.5, 100.0}) {
    const State a = full.at(t), b = principal.at(t);
    rates.add((a.omega - R_BP * b.omega).norm());
    angles.add(angle_between(a.attitude * q_BP, b.attitude));
  }
}

TEST_CASE("powers of two change no bit; the array is the scalar, row by row") {
  const FreeMotion a(block, {1, 2, 3}, start), b(block * 0x1p-40, Vector3d(1, 2, 3) * 0x1p100, start);
  const double times[] = {0, 1.5, -1000, 1e9};
  double omega[12], attitude[16];
  a.at(times, 4, omega, attitude);
  for (std::size_t i = 0; i < 4; ++i) {
    const State s = a.at(times[i]), scaled = b.at(times[i] * 0x1p-100);
    CHECK(scaled.omega == s.omega * 0x1p100);
    CHECK(scaled.attitude == s.attitude);
    CHECK(omega[3 * i + 1] == s.omega[1]);
    CHECK(attitude[4 * i + 3] == s.attitude.w);
  }
  a.at(times, 4, nullptr, attitude);
  a.at(times, 4, omega, nullptr);
}

TEST_CASE("the polhode stays on the inertia ellipsoid, the herpolhode in its plane") {
  const FreeMotion motion(block, {1, 2, 3}, start);
  const Vector3d L = motion.angular_momentum();
  ErrorRange ellipsoid{"inertia ellipsoid", 2.9e-16, 3.7e-15};   // 8.9e-16 to 1.2e-15
  ErrorRange plane{"invariable plane", 2.3e-16, 2.7e-15};        // 7.0e-16 to 8.7e-16
  for (const double t : {0.0, 0.7, 12.0}) {
    const Vector3d p = motion.polhode(t);
    ellipsoid.compare(block.cwiseProduct(p).dot(p), 1);
    plane.compare(L.dot(motion.herpolhode(t)), std::sqrt(2 * motion.energy()));
  }
}

TEST_CASE("what float64 cannot represent is refused") {
  CHECK_THROWS_AS(FreeMotion(block, {1, NAN, 0}), InvalidInput);
  CHECK_THROWS_AS(FreeMotion(Vector3d(0, 1, 1), {1, 0, 0}), InvalidInput);
  CHECK_THROWS_AS(FreeMotion(Vector3d(1, 1, 3), {1, 0, 0}), InvalidInput);
  const FreeMotion motion(block, {1, 2, 3});
  CHECK_THROWS_AS(motion.at(NAN), InvalidInput);
  CHECK_THROWS_AS(motion.at(1e26), InvalidInput);
  CHECK_THROWS_AS(motion.at(std::numeric_limits<double>::infinity()), InvalidInput);
  CHECK_NOTHROW(motion.at(1e24));
  CHECK_THROWS_AS(FreeMotion(block, {1e160, 0, 1}).energy(), InvalidInput);
  CHECK_THROWS_AS(FreeMotion(block, {0, 0, 0}).polhode(0), InvalidInput);
  CHECK(FreeMotion(block, {0, 0, 0}, start).at(1e300).attitude == start);
}
