#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "error_range.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/exact/detail/heavy_top_kernels.hpp"

using namespace polhode;

namespace {

constexpr double e = 2.2e-16;
constexpr double pi = std::numbers::pi;
const Quat level{std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, up{}, down{1, 0, 0, 0};
const Quat tilted = normalized({0.3, 0.1, 0.2, 0.9});

double angle_between(const Quat& a, const Quat& b) {
  const Quat d = conjugate(a) * b;
  return 2 * std::asin(std::min(1.0, std::hypot(d.x, d.y, d.z)));
}

/// Largest difference in angle and in omega (relative to `speed`) between two tops over some times.
double largest_difference(const HeavyTop& a, const HeavyTop& b, const std::vector<double>& times, double speed) {
  double worst = 0;
  for (const double t : times) {
    const State s = a.at(t), r = b.at(t);
    worst = std::max({worst, angle_between(s.attitude, r.attitude), (s.omega - r.omega).norm() / speed});
  }
  return worst;
}

double ratio(double error, double size) { return error == 0 ? 0 : error / size; }

/// Energy and both momenta are constant, the attitude stays unit, and t = 0 gives the start.
struct InvariantErrors {
  /// @param part  of the lower sides, for few motions, which meet smaller errors
  explicit InvariantErrors(double part = 1)
      : norm("|q|", 1.1e-16 * part, 8.8e-16),                      // 3.3e-16 to 4.4e-16
        energy("energy", 5.2e-16 * part, 4.4e-15),                 // 1.6e-15 to 1.7e-15
        momentum("p_phi", 3.8e-16 * part, 4e-15),                  // 1.2e-15 to 1.3e-15
        omega("omega at t = 0", 2.2e-16 * part, 2.7e-15),          // 6.7e-16 to 8.9e-16
        attitude("attitude at t = 0", 1.8e-16 * part, 1.8e-15) {}  // 5.7e-16

  ErrorRange norm, energy, momentum, omega, attitude;

  void add(const Vector3d& moments, double arm, const Vector3d& omega_0, const Quat& q, double span) {
    const HeavyTop top(moments, arm, omega_0, q);
    if (std::isfinite(top.nutation_period())) span = std::max(span, 2 * top.nutation_period());  // to meet the fastest
    double L = 0, T = 0;  // the largest: at times it is much smaller
    for (int i = -20; i <= 20; ++i) {
      const Vector3d w = top.at(span * (i / 20.0)).omega;
      L = std::max(L, moments.cwiseProduct(w).norm());
      T = std::max(T, 0.5 * moments.dot(w.cwiseAbs2()));
    }
    for (int i = -20; i <= 20; ++i) {
      const State s = top.at(span * (i / 20.0));
      const Vector3d L_B = moments.cwiseProduct(s.omega);
      const Vector3d up_B = rotate(conjugate(s.attitude), Vector3d::UnitZ());
      norm.add(std::abs(polhode::norm(s.attitude) - 1));
      energy.add(ratio(std::abs(0.5 * L_B.dot(s.omega) + arm * up_B[2] - top.energy()), T + std::abs(arm)));
      momentum.add(ratio(std::abs(L_B.dot(up_B) - top.p_phi()), L));
      CHECK(s.omega[2] == omega_0[2]);
    }
    const State first = top.at(0.0);
    const double speed = std::max(omega_0.norm(), std::sqrt(std::abs(arm) / moments[0]));
    omega.add(ratio((first.omega - omega_0).norm(), speed));
    attitude.add(angle_between(first.attitude, q));
  }
};

}  // namespace

TEST_CASE("energy and the two momenta stay the start's, in every regime of the top") {
  InvariantErrors errors;
  const Vector3d bodies[] = {{1, 1, 0.5}, {1, 1, 1}, {1, 1, 1.9}, {1, 1, 1e-9}};
  const Vector3d starts[] = {{0, 0, 5},    {0.1, 0.2, 5},  {1, -2, 3}, {2, 0, 0},
                             {1e-8, 0, 1}, {0, 1e-4, 3.9}, {0, 0, 0},  {1e-60, 0, 8}};
  for (const Vector3d& moments : bodies)
    for (const Vector3d& omega : starts)
      for (const double arm : {1.0, -1.0, 0.0, 1e-12, 30.0})
        for (const Quat& q : {up, down, level, tilted, normalized({1e-8, 0, 0.3, 1}), normalized({1, 0, 1e-12, 0})})
          errors.add(moments, arm, omega, q, 40.0);
}

TEST_CASE("powers of two scale out exactly, and 1e-150 to 1e150 are ordinary") {
  InvariantErrors errors(0.04);
  const Vector3d moments{1, 1, 0.5}, omega{0.1, 0.2, 5};
  const HeavyTop top(moments, 1.3, omega, tilted);
  for (const int k : {-480, -50, 50, 480}) {
    const double s = std::ldexp(1.0, k);
    const HeavyTop faster(moments, 1.3 * s * s, omega * s, tilted), heavier(moments * s, 1.3 * s, omega, tilted);
    const State a = top.at(7.7), b = faster.at(7.7 / s), c = heavier.at(7.7);
    CHECK(a.omega * s == b.omega);
    CHECK(a.attitude == b.attitude);
    CHECK(a.omega == c.omega);
    CHECK(a.attitude == c.attitude);
    CHECK(faster.nutation_period() == top.nutation_period() / s);
  }
  errors.add(moments, 1e300, Vector3d(0.1e150, 0.2e150, 5e150), tilted, 1e-148);
  errors.add(moments * 1e40, 1e-260, omega * 1e-150, tilted, 1e152);
}

TEST_CASE("without weight the top is the free symmetric body") {
  ErrorRange rates{"omega", 8e-17, 1e-15};           // 2.5e-16 to 3.1e-16
  ErrorRange angles{"attitude", 2.6e-16, 2.5e-15};   // 7.9e-16 to 8.0e-16
  for (const double C : {0.3, 1.0, 1.7}) {
    const Vector3d moments{1, 1, C}, omega{0.3, -0.7, 2.0};
    const FreeMotion free(moments, omega, tilted);
    for (const double arm : {0.0, 1e-300, -1e-300, 1e-40}) {
      const HeavyTop top(moments, arm, omega, tilted);
      for (const double t : {0.0, 0.7, -3.0, 1e3, 1e6, 1e9}) {
        const State a = top.at(t), b = free.at(t);
        rates.add((a.omega - b.omega).norm() / omega.norm());
        angles.add(angle_between(a.attitude, b.attitude));
      }
    }
  }
}

TEST_CASE("the two forms of the series agree where one takes over from the other") {
  // Level starts about the homoclinic motion, w1^2 + w3^2 = 2 bt; w1 is closed in on the double where the form changes.
  ErrorRange jumps{"jump, in steps of neighbouring starts", 0.3, 3.3};   // 1.0
  ErrorRange periods{"period", 3.2e-16, 3e-15};                          // 9.7e-16
  ErrorRange precessions{"precession", 1.7e-16, 1.7e-15};                // 5.4e-16
  for (const double spin : {0.0, 0.4, 1.5, 3.0}) {
    for (const double side : {1.0, -1.0}) {
      const auto make = [&](double w1) {
        const Vector3d omega{w1, spin * side, spin * side};
        return HeavyTop(Vector3d(1, 1, 1), 12.5 * side, omega, {side * level.x, 0, 0, level.w});
      };
      double low = 1.0, high = std::sqrt(25 - spin * spin);
      CHECK(make(high).constants().hyper);
      while (std::nextafter(low, high) < high) {
        const double middle = low + (high - low) / 2;
        (make(middle).constants().hyper == make(low).constants().hyper ? low : high) = middle;
      }
      const std::vector<double> times{0.0, 0.1, 1.0, 3.0, 10.0, 100.0};
      const HeavyTop a = make(low), b = make(high), before = make(std::nextafter(low, 0.0));
      CHECK(a.constants().hyper != b.constants().hyper);
      const double jump = largest_difference(a, b, times, 5.0), step = largest_difference(before, a, times, 5.0);
      jumps.add(jump / (step + 4 * e));
      periods.compare(b.nutation_period(), a.nutation_period());
      precessions.add(std::abs(a.precession_rate() - b.precession_rate()) / (1 + std::abs(a.precession_rate())));
    }
  }
}

TEST_CASE("every compiled level answers alike: avx2 and avx512 to the bit, a row wherever it stands") {
  std::vector<double> times;
  for (int i = 0; i < 37; ++i) times.push_back(0.37 * i - 3);
  const std::size_t n = times.size();
  const HeavyTop tops[] = {{Vector3d(1, 1, 0.5), 1.3, {0.1, 0.2, 5}, tilted},
                           {Vector3d(1, 0.5, 1), -1.3, {0.1, 0.2, 5}, tilted},
                           {Vector3d(1, 1, 1), 12.5, {4.000004, 3, 3}, level},
                           {Vector3d(1, 1, 1), -12.5, {4, -3, -3}, {-level.x, 0, 0, level.w}}};
  ErrorRange differences{"baseline and the widest level", 0, 1.7e-15};   // 0 (of itself) to 5.3e-16
  for (const HeavyTop& top : tops) {
    std::vector<std::vector<double>> answers;
    for (int of = 0; of <= static_cast<int>(simd_level()); ++of) {
      std::vector<double> rows(7 * n), alone(7);
      const auto at = exact::heavy_top_kernels(static_cast<SimdLevel>(of)).at;
      const auto loop = [at](const exact::HeavyTopConstants& c, const double* t, std::size_t count, double* w,
                             double* q) { at(c, exact::TimeGrid(t, count), w, q); };
      loop(top.constants(), times.data(), n, rows.data(), rows.data() + 3 * n);
      for (const std::size_t i : {std::size_t{0}, std::size_t{5}, n - 1}) {
        loop(top.constants(), &times[i], 1, alone.data(), alone.data() + 3);
        CHECK(std::equal(alone.begin(), alone.begin() + 3, rows.begin() + static_cast<std::ptrdiff_t>(3 * i)));
        CHECK(std::equal(alone.begin() + 3, alone.end(), rows.begin() + static_cast<std::ptrdiff_t>(3 * n + 4 * i)));
        loop(top.constants(), &times[i], 1, nullptr, alone.data());
        CHECK(std::equal(alone.begin(), alone.begin() + 4, rows.begin() + static_cast<std::ptrdiff_t>(3 * n + 4 * i)));
      }
      answers.push_back(rows);
    }
    if (answers.size() == 3) CHECK(answers[1] == answers[2]);
    for (std::size_t i = 0; i < 7 * n; ++i) {
      differences.add(std::abs(answers[0][i] - answers.back()[i]) / (i < 3 * n ? 5 : 1));
    }
  }
}

TEST_CASE("the kind is decided at construction") {
  const auto kind = [](double arm, Vector3d omega, Quat q) {
    return HeavyTop(Vector3d(1, 1, 0.5), arm, omega, q).kind();
  };
  CHECK(kind(0, {1, 2, 3}, tilted) == TopKind::free);
  CHECK(kind(1, {0, 0, 9}, up) == TopKind::sleeping);
  CHECK(kind(1, {0, 0, 1}, up) == TopKind::sleeping);
  CHECK(kind(1, {0, 0, 1}, down) == TopKind::hanging);
  CHECK(kind(-1, {0, 0, 1}, down) == TopKind::sleeping);
  CHECK(kind(-1, {0, 0, 1}, up) == TopKind::hanging);
  CHECK(kind(1, {0, 1, 2}, level) == TopKind::steady_precession);
  CHECK(kind(1, {0.3, 0, 0}, level) == TopKind::planar_pendulum);
  CHECK(kind(1, {0.3, 0.1, 0}, level) == TopKind::spherical_pendulum);
  CHECK(kind(1, {2, 0, 0}, down) == TopKind::homoclinic);
  CHECK(kind(1, {0, 0, 6}, tilted) == TopKind::cuspidal);
  CHECK(kind(1, {0, 3, 5}, level) == TopKind::monotone);
  CHECK(kind(1, {0, -0.2, 5}, level) == TopKind::looping);
  CHECK(kind(1, {0.1, 0, 5}, up) == TopKind::monotone);
  CHECK(std::string(to_text(TopKind::steady_precession)) == "steady_precession");
  CHECK(std::string(to_text(TopKind::monotone)) == "monotone");
}

TEST_CASE("period, bounds of the tilt and mean precession are those of the motion itself") {
  const double K_half = 1.8540746773013719;  // K(m = 1/2): a pendulum let go level, its tilt twice a swing
  const HeavyTop pendulum(Vector3d(1, 1, 0.5), 1.0, {0, 0, 0}, level);
  ErrorRange closed{"closed forms", 0, 1e-15};                // 0
  ErrorRange tilts{"sampled tilts", 4.5e-8, 4.5e-7};          // 1.5e-7
  ErrorRange rates{"sampled precession", 1.5e-15, 1e-13};     // 9.4e-15 to 1.4e-14
  closed.compare(pendulum.nutation_period(), 2 * K_half);
  closed.compare(pendulum.tilt_min(), pi / 2);
  closed.compare(pendulum.tilt_max(), pi);
  CHECK(std::abs(pendulum.precession_rate()) <= 1e-30);

  for (const double arm : {1.0, -1.0, 0.2}) {
    for (const Vector3d& omega :
         {Vector3d(0.4, -0.3, 5), Vector3d(0.1, 0.02, 0.3), Vector3d(1, 2, 0), Vector3d(0.2, 0.1, 4.0)}) {
      const HeavyTop top(Vector3d(1, 1, 0.5), arm, omega, tilted);
      const int steps = 40000;
      double least = 10, most = -10, angle = 0, last = 0;
      for (int i = 0; i <= steps; ++i) {
        const Vector3d axis = rotate(top.at(top.nutation_period() * i / steps).attitude, Vector3d::UnitZ());
        const double tilt = std::atan2(std::hypot(axis[0], axis[1]), axis[2]), azimuth = std::atan2(axis[1], axis[0]);
        least = std::min(least, tilt), most = std::max(most, tilt);
        if (i > 0) angle += std::remainder(azimuth - last, 2 * pi);
        last = azimuth;
      }
      tilts.compare(least, top.tilt_min());
      tilts.compare(most, top.tilt_max());
      rates.compare(angle / top.nutation_period(), top.precession_rate());
    }
  }
  closed.compare(HeavyTop(Vector3d(1, 1, 0.5), 1.0, {0, 1, 2}, level).precession_rate(), 1.0);
  CHECK(std::isinf(HeavyTop(Vector3d(1, 1, 0.5), 1.0, {2, 0, 0}, down).nutation_period()));
}

TEST_CASE("a pendulum with just the energy of the top follows its tanh, and stays up") {
  // The library's cosh and tanh are good to an ulp or two, and differ between libraries.
  ErrorRange rates{"omega", 0, 2e-15};         // 2.2e-16 to 6.7e-16
  ErrorRange angles{"attitude", 0, 8.8e-16};   // 1.1e-16
  const HeavyTop top(Vector3d(1, 1, 0.5), 1.0, {2, 0, 0}, down);
  for (const double t : {0.0, 1e-9, 0.5, 2.0, 10.0, 100.0, 1e9}) {
    const State s = top.at(t);
    const Quat expected{1 / std::cosh(t), 0, 0, -std::tanh(t)};
    angles.add(angle_between(s.attitude, expected));
    rates.add((s.omega - Vector3d(2 / std::cosh(t), 0, 0)).norm());
  }
}

TEST_CASE("a kick of 1e-150 to a hanging or a sleeping top stays in proportion") {
  const auto kicked = [](double kick, double spin, const Quat& q) {
    return HeavyTop(Vector3d(1, 1, 0.5), 1.0, {kick, -kick / 3, spin}, q);
  };
  ErrorRange differences{"omega over its kick", 0, 2.2e-16};   // 0
  for (const Quat& q : {up, down}) {
    const HeavyTop small = kicked(std::ldexp(1.0, -500), 9.0, q), larger = kicked(std::ldexp(1.0, -60), 9.0, q);
    for (const double t : {0.0, 0.4, 3.0, 50.0}) {
      const State a = small.at(t), b = larger.at(t);
      for (const int i : {0, 1}) differences.add(std::ldexp(std::abs(std::ldexp(a.omega[i], 440) - b.omega[i]), 60));
    }
  }
  CHECK_THROWS_AS(kicked(1e-100, 1.0, up), InvalidInput);
  CHECK_NOTHROW(kicked(1e-60, 1.0, up));
}

TEST_CASE("the axis is the third moment's: permuted moments and turned tensors are the same top") {
  const Vector3d omega{0.4, -0.3, 5};
  const HeavyTop top(Vector3d(1, 1, 0.5), 1.3, omega, tilted);
  const Quat x_first{-0.5, -0.5, -0.5, 0.5};  // body axes (x, y, z) of the permuted top are (y, z, x) of the first
  const HeavyTop about_x(Vector3d(0.5, 1, 1), 1.3, {omega[2], omega[0], omega[1]}, tilted * x_first);
  CHECK(about_x.axis() == Vector3d::UnitX());
  const HeavyTop about_y(Vector3d(1, 0.5, 1), 1.3, {omega[1], omega[2], omega[0]}, tilted * conjugate(x_first));
  CHECK(about_y.axis() == Vector3d::UnitY());
  const Quat q_NB = normalized({0.2, -0.1, 0.3, 0.9});
  const Matrix3d I = to_matrix(q_NB) * Vector3d(1, 1, 0.5).asDiagonal() * to_matrix(q_NB).transpose();
  const HeavyTop rotated(InertiaTensor((I + I.transpose()) / 2), 1.3, rotate(q_NB, omega), tilted * conjugate(q_NB));
  ErrorRange axis{"axis", 0, 8.8e-16};                           // 1.2e-16
  ErrorRange permuted{"permuted moments", 1.6e-16, 8.8e-16};     // 4.8e-16 to 5.6e-16
  ErrorRange tensor{"rotated tensor", 2.2e-15, 2.2e-14};         // 6.6e-15 to 6.7e-15
  axis.add((rotated.axis() - rotate(q_NB, Vector3d::UnitZ())).norm());
  for (const double t : {0.0, 0.5, -2.0, 30.0}) {
    const State s = top.at(t), x = about_x.at(t), y = about_y.at(t), n = rotated.at(t);
    permuted.add(angle_between(x.attitude, s.attitude * x_first));
    permuted.add((x.omega - Vector3d(s.omega[2], s.omega[0], s.omega[1])).norm() / 5);
    permuted.add(angle_between(y.attitude, s.attitude * conjugate(x_first)));
    permuted.add((y.omega - Vector3d(s.omega[1], s.omega[2], s.omega[0])).norm() / 5);
    tensor.add(angle_between(n.attitude, s.attitude * conjugate(q_NB)));
    tensor.add((n.omega - rotate(q_NB, s.omega)).norm() / 5);
  }
}

TEST_CASE("what is no symmetric top, or beyond float64, is refused with its name") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Vector3d fine{1, 1, 0.5}, omega{0.1, 0.2, 3};
  const auto refusal = [](auto&& make) {
    try {
      make();
    } catch (const InvalidInput& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  const auto starts = [](const std::string& text, const char* with) { return text.rfind(with, 0) == 0; };
  CHECK(starts(refusal([&] { HeavyTop(Vector3d(1, 2, 2.5), 1, omega); }), "inertia:"));
  CHECK(starts(refusal([&] { HeavyTop(Vector3d(1, 1 + 1e-9, 0.5), 1, omega); }), "inertia:"));
  CHECK(starts(refusal([&] { HeavyTop(Vector3d(1, 1, 0), 1, omega); }), "inertia:"));
  CHECK(starts(refusal([&] { HeavyTop(Vector3d(0, 0, 0), 1, omega); }), "inertia:"));
  CHECK(starts(refusal([&] { HeavyTop(fine, nan, omega); }), "weight_arm:"));
  CHECK(starts(refusal([&] { HeavyTop(fine, inf, omega); }), "weight_arm:"));
  CHECK(starts(refusal([&] { HeavyTop(fine, 1, Vector3d(0, nan, 0)); }), "omega:"));
  CHECK(starts(refusal([&] { HeavyTop(fine, 1, omega, {0, 0, 0, 2}); }), "attitude:"));
  CHECK(starts(refusal([&] { HeavyTop(fine, 1, omega).at(nan); }), "t:"));
  CHECK(starts(refusal([&] { HeavyTop(fine, 1, omega).at(1e26); }), "t:"));
  const HeavyTop large(fine * 1e100, 1e100, omega * 1e150);
  CHECK(starts(refusal([&] { large.energy(); }), "energy:"));
  CHECK(std::isfinite(large.p_phi()));
  CHECK(refusal([&] { HeavyTop(Vector3d(1, 1, 0), 1, {0.3, 0, 0}); }).empty());  // a point on a rod may swing
  CHECK(refusal([&] { HeavyTop(fine, 0, {0, 0, 0}).at(1e20); }).empty());        // at rest
}

TEST_CASE("heavy tops: no weight, and a start with numbers next to the smallest") {
  struct Start {
    Vector3d moments, omega;
    Quat attitude;
    double weight_arm;
  };
  const Start starts[] = {
      {{1.03, 1.03, 1.1}, {4.9e-311, 0, 0.089}, {0, -0.6, 0, 0.8}, 0.0},
      {{0.73, 1.03, 1.03}, {-5e-311, -1.1e-321, 0.91}, {1.5e-308, 0, 5.5e-281, 1}, 0.0},
      {{1.78, 1.03, 1.03}, {0, 0, 0.055}, {0, 9.4e-321, -7.9e-308, 1}, -3.4e-321},
      {{0.49, 1.03, 1.03}, {2.1e-306, 0, 6.6e-11}, {8.6e-321, 1.3e-311, -7e-309, 1}, 0.0},
      {{0.45, 1.03, 1.03}, {7.8e-311, 0, 0.41}, {3.1e-306, -5.8e-301, -0.6, 0.8}, -1.6e-291},
  };
  for (const Start& start : starts) {
    CAPTURE(start.omega.transpose());
    const HeavyTop top(start.moments, start.weight_arm, start.omega, start.attitude);
    for (const double t : {0.0, 1.0, 1e3}) {
      const State state = top.at(t);
      // The rate about the axis stays, and nothing else rotates the body.
      CHECK((state.omega - start.omega).norm() <= 1e-15 * start.omega.norm());
      const Quat& q = state.attitude;
      CHECK(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w == doctest::Approx(1.0).epsilon(1e-15));
    }
  }
}
