#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "polhode/formula/parser.hpp"
#include "polhode/reference/reference.hpp"
#include "solve/proof/enclose.hpp"
#include "solve/proof/error_set.hpp"

using namespace polhode;
using namespace polhode::proof;

namespace {

/// Numbers between -1 and 1, the same on every machine.
class Dice {
 public:
  double roll() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(static_cast<std::int64_t>(state_)) * 0x1p-63;
  }

 private:
  std::uint64_t state_ = 1;
};

Scene make_heavy_body() {
  std::vector<double> times;
  for (int i = 1; i <= 20; ++i) times.push_back(0.5 * i);
  return Scene({.inertia_B = InertiaTensor::from_moments({1.0, 2.0, 2.5}),
                .omega = {0.3, 0.2, 3.0},
                .torques = {torques::Gravity(2.0, {0.3, 0.2, 0.5})},
                .times = times});
}

/// How many numbers of the series in long double lie outside of the enclosure. Its own rounding is below 1e-16.
int count_outside(const Scene& scene, const EncloseOptions& options, double& widest) {
  const Reference truth = compute_reference(scene, {});
  const Enclosure found = enclose(scene, cut(scene), options);
  int outside = 0;
  widest = 0.0;
  const auto compare = [&](const std::vector<Interval>& sets, const std::vector<double>& values) {
    for (std::size_t i = 0; i < sets.size(); ++i) {
      outside += values[i] < sets[i].lower() - 1e-15 || values[i] > sets[i].upper() + 1e-15;
      widest = std::max(widest, sets[i].radius);
    }
  };
  compare(found.omega, truth.omega);
  compare(found.attitude, truth.attitude);
  return outside;
}

/// A rotation by an angle in the plane of two axes.
std::vector<double> make_rotation(int n, int a, int b, double angle) {
  std::vector<double> M(static_cast<std::size_t>(n * n), 0.0);
  for (int i = 0; i < n; ++i) M[static_cast<std::size_t>(i * n + i)] = 1.0;
  const double c = std::sqrt(1.0 - angle * angle);
  M[static_cast<std::size_t>(a * n + a)] = M[static_cast<std::size_t>(b * n + b)] = c;
  M[static_cast<std::size_t>(a * n + b)] = -angle, M[static_cast<std::size_t>(b * n + a)] = angle;
  return M;
}

}  // namespace

TEST_CASE("enclosures hold the series in long double, and a wrong remainder is caught") {
  const Scene scene = make_heavy_body();
  EncloseOptions options;
  double widest = 0.0;
  for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-20}) {
    options.step = {.tolerance = tolerance};
    CHECK(count_outside(scene, options, widest) == 0);
    CHECK(widest < 1e7 * tolerance + 1e-15);
  }
  // Without what the series leave out, or with a thousandth of it, the sets miss the motion.
  for (const double factor : {0.0, 1e-3}) {
    options.step = {.tolerance = 1e-6, .remainder_factor = factor};
    CHECK(count_outside(scene, options, widest) > 10);
  }
}

TEST_CASE("of every operation of a formula a wrong remainder is caught") {
  const char* laws[] = {"-cross([0.6, 0.4, 1], to_body([0, 0, 1]))", "0.4 * omega / (1.1 + attitude.x * attitude.x)",
                        "-0.3 * sqrt(0.2 + attitude.xyz * attitude.xyz)", "0.3 * exp(-attitude.xyz - 0.1 * t)",
                        "0.5 * log(1.2 + attitude.xyz)", "0.4 * sin(2 * attitude.xyz + t)",
                        "-0.4 * tanh(3 * attitude.xyz)", "0.5 * atan2(attitude.xyz, 1.3 + attitude.w)",
                        "0.3 * (1.2 + attitude.xyz) ^ -0.7"};
  for (const char* law : laws) {
    CAPTURE(law);
    SceneParts parts = make_heavy_body().parts();
    parts.omega = {0.3, 0.2, 1.5};
    formula::Text text;
    text.torque = law;
    parts.torques = {torques::Formula(text)};
    const Scene scene(parts);
    const Enclosure truth = enclose(scene, cut(scene), {});
    REQUIRE(truth.status == Status::finished);
    EncloseOptions options;
    const auto count = [&](double tolerance, double factor) {
      options.step = {.tolerance = tolerance, .remainder_factor = factor};
      const Enclosure found = enclose(scene, cut(scene), options);
      int outside = 0;
      for (std::size_t i = 0; i < truth.omega.size(); ++i)   // two sets of one motion meet
        outside += !(found.omega[i] - truth.omega[i]).contains(0.0);
      return outside;
    };
    CHECK(truth.omega.back().radius < 1e-15);
    for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-17}) CHECK(count(tolerance, 1.0) == 0);
    CHECK(count(1e-6, 0.0) > 10);
  }
}

TEST_CASE("at switches widths that are too small are caught") {
  const char* laws[] = {"0.4 * sign(attitude.xyz - [0.1, 0.2, 0.3])", "where(attitude.x > 0.1, [0.5, 0, 0.1], [-0.3, 0.4, 0])",
                        "0.5 * sign(sin(3 * t + attitude.xyz))"};
  for (const char* law : laws) {
    CAPTURE(law);
    SceneParts parts = make_heavy_body().parts();
    parts.omega = {0.3, 0.2, 1.5};
    formula::Text text;
    text.torque = law;
    parts.torques.emplace_back(torques::Formula(text));
    const Scene scene(parts);
    EncloseOptions options;
    const auto follow = [&](double tolerance, double factor) {
      options.step = {.tolerance = tolerance, .derivative_tolerance = 1e-12, .switch_factor = factor};
      return enclose(scene, cut(scene), options);
    };
    const Enclosure truth = follow(1e-26, 1.0);
    REQUIRE(truth.status == Status::finished);
    CHECK(truth.omega.back().radius < 1e-14);
    const auto count = [&](const Enclosure& found) {
      int outside = 0;
      for (std::size_t i = 0; i < truth.omega.size(); ++i)   // two sets of one motion meet
        outside += !(found.omega[i] - truth.omega[i]).contains(0.0);
      return outside;
    };
    for (const double tolerance : {1e-7, 1e-9, 1e-12, 1e-17}) CHECK(count(follow(tolerance, 1.0)) == 0);
    int missed = 0;
    for (const double tolerance : {1e-5, 1e-6, 1e-7}) missed += count(follow(tolerance, 0.0));
    CHECK(missed > 3);
  }
}

TEST_CASE("a wrong torque is caught") {
  const Scene scene = make_heavy_body();
  SceneParts parts = scene.parts();
  parts.torques = {torques::Gravity(2.0 * (1 + 1e-12), {0.3, 0.2, 0.5})};
  const Reference truth = compute_reference(scene, {});
  const Scene other(parts);
  const Enclosure found = enclose(other, cut(other), {});
  CHECK_FALSE(found.omega.back().contains(truth.omega.back()));
}

TEST_CASE("an enclosure that becomes too wide says where it ends") {
  SceneParts parts = make_heavy_body().parts();
  parts.omega = {0.3, 0.2, 2.0};   // chaotic
  parts.times = {1.0, 300.0};
  const Scene scene(parts);
  EncloseOptions options;
  options.step = {.tolerance = 1e-12};
  const Enclosure found = enclose(scene, cut(scene), options);
  CHECK(found.status == Status::failed);
  CHECK((10.0 < found.end && found.end < 300.0));
  CHECK(found.omega.front().is_bounded());
  CHECK_FALSE(found.omega.back().is_bounded());
  options.max_steps = 3;
  CHECK(enclose(scene, cut(scene), options).status == Status::max_steps);
}

TEST_CASE("boxes of sets of errors hold the exact ones, and are not much wider") {
  constexpr std::size_t n = 5;
  Dice dice;
  // Turning and shearing; stretching by far more than a set may be skew; to and fro, so that many parts are merged.
  enum class Kind { turn, stretch, to_and_fro };
  const struct {
    Kind kind;
    int count;
    double widest;
  } cases[] = {{Kind::turn, 20, 3}, {Kind::turn, 400, 30}, {Kind::stretch, 400, 30}, {Kind::to_and_fro, 200, 1.2}};
  for (const auto& [kind, count, widest] : cases) {
    ErrorSet set(std::vector<double>(n, 1e-12));
    const std::vector<double> rest(n, 1e-12);
    std::vector<std::vector<double>> steps;
    for (int step = 0; step < count; ++step) {
      const double angle = kind == Kind::to_and_fro ? 0.0 : 0.6 * dice.roll();
      std::vector<double> M = make_rotation(n, step % 5, (step + 2) % 5, angle);
      const double factor = kind == Kind::turn      ? 1.0
                            : kind == Kind::stretch ? (step % 100 < 50 ? 1.3 : 0.85)
                                                    : (step % 2 == 0 ? 2048.0 : 1 / 2048.0);
      for (std::size_t j = 0; j < n; ++j) M[j] *= factor;
      if (kind != Kind::to_and_fro) M[3] += 0.5 * dice.roll();
      set.advance(M, n, rest);
      steps.push_back(M);
    }
    // The farthest that errors of these sizes reach along axis i: the sum of |row i of M_last ... M_k| rest over k.
    const std::vector<double> box = set.box();
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<long double> row(n, 0.0L);
      row[i] = 1.0L;
      long double farthest = 1e-12L;
      for (std::size_t k = steps.size(); k-- > 0;) {
        std::vector<long double> before(n, 0.0L);
        for (std::size_t a = 0; a < n; ++a)
          for (std::size_t b = 0; b < n; ++b) before[b] += row[a] * static_cast<long double>(steps[k][a * n + b]);
        row = before;
        for (const long double x : row) farthest += 1e-12L * std::abs(x);
      }
      CHECK(box[i] >= static_cast<double>(farthest));
      CHECK(box[i] <= widest * static_cast<double>(farthest));
    }
  }
}

TEST_CASE("a turning set does not grow by being boxed") {
  constexpr int n = 4;
  Dice dice;
  ErrorSet set(std::vector<double>(n, 1e-9));
  for (int step = 0; step < 10'000; ++step)
    set.advance(make_rotation(n, step % n, (step + 1) % n, 0.6 * dice.roll()), n, std::vector<double>(n, 1e-16));
  // Steps add up to 1e-12 along each axis, and turned corners reach 2 = sqrt(n) times as far.
  for (const double size : set.box()) CHECK(size < 2.01e-9 + 4e-12);
}
