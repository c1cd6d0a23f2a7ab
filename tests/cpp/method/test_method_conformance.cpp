#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/method/methods.hpp"
#include "polhode/solve/plan.hpp"
#include "polhode/solve/solve.hpp"

// What every method of the list must do on a body. No method is named here: what is expected follows from its record.

using namespace polhode;

namespace {

constexpr double end_time = 4.0;
const Vector3d block{0.20, 0.40, 0.52}, block_omega{1, 2, 3};
const Vector3d top{1, 1, 0.5}, top_omega{0.3, -0.2, 5};
const Quat tilted{std::sin(0.35), 0, 0, std::cos(0.35)};
constexpr double weight_arm = 2.0;

Scene make_scene(const Vector3d& moments, const Vector3d& omega, std::vector<double> times, bool driven) {
  SceneParts parts{
      .inertia_B = InertiaTensor::from_moments(moments), .omega = omega, .attitude = tilted, .times = std::move(times)};
  if (driven) parts.torques = {torques::Gravity(weight_arm, {0, 0, 1})};
  return Scene(std::move(parts));
}

/// A free block, or a free symmetric body for methods that take no other; Lagrange's top.
Scene make_free(const ode::MethodRecord& method, std::vector<double> times, double size = 1.0, double rate = 1.0) {
  for (double& t : times) t /= rate;
  const Scene one = make_scene(block * size, block_omega * rate, times, false);
  return compute_refusal(method.name, one).empty() ? one : make_scene(top * size, top_omega * rate, times, false);
}
Scene make_driven(std::vector<double> times) { return make_scene(top, top_omega, std::move(times), true); }

State truth(const Scene& scene, double t) {
  if (scene.torques().empty()) return FreeMotion(scene.inertia_B(), scene.omega(), scene.attitude()).at(t);
  return HeavyTop(scene.inertia_B(), weight_arm, scene.omega(), scene.attitude()).at(t);
}

/// The scenes' measure: |omega error| over the largest |omega| of the start and the samples, and the angle between the
/// attitudes.
double compute_error(const Scene& scene, const Motion& motion) {
  double rates = 0.0, size = scene.omega().norm(), angle = 0.0;
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const State exact = truth(scene, motion.t[i]);
    double near = 0.0, far = 0.0, e = 0.0;
    const double q[4] = {exact.attitude.x, exact.attitude.y, exact.attitude.z, exact.attitude.w};
    for (std::size_t k = 0; k < 4; ++k) {
      near += std::pow(motion.attitude[4 * i + k] - q[k], 2);
      far += std::pow(motion.attitude[4 * i + k] + q[k], 2);
    }
    for (std::size_t k = 0; k < 3; ++k) e += std::pow(motion.omega[3 * i + k] - exact.omega[static_cast<int>(k)], 2);
    angle = std::max(angle, 4 * std::asin(std::min(1.0, std::sqrt(std::min(near, far)) / 2)));
    rates = std::max(rates, std::sqrt(e));
    size = std::max(size, exact.omega.norm());
  }
  return std::max(rates / size, angle);
}

/// As fine as `accuracy` over a few radians: a tolerance, or the step that the order makes of it, within reason.
SolveOptions at_accuracy(const ode::MethodRecord& method, double accuracy, int order, double rate = 1.0) {
  SolveOptions options{.method = std::string(method.name)};
  if (method.adaptive) {
    options.rtol = accuracy;
  } else {
    options.step = 0.27 * std::max(std::pow(accuracy, 1.0 / std::max(order, 1)), 1e-3) / rate;
  }
  return options;
}

std::vector<double> even_times(int n) {
  std::vector<double> times;
  for (int i = 0; i <= n; ++i) times.push_back(end_time * i / n);
  return times;
}

bool claims(const ode::MethodRecord& method, const std::string& invariant) {
  std::istringstream list{std::string(method.keeps)};
  for (std::string one; std::getline(list >> std::ws, one, ',');) {
    if (one == invariant) return true;
  }
  return false;
}

struct Drifts {
  double energy = 0.0, size = 0.0, vector = 0.0;
};

/// At most, over the samples of a free motion.
Drifts compute_drifts(const Scene& scene, const Motion& motion) {
  Drifts drifts;
  const Matrix3d& I = scene.inertia_B().matrix();
  const Vector3d L0 = rotate(scene.attitude(), I * scene.omega());
  const double T0 = scene.omega().dot(I * scene.omega());
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const Vector3d w{motion.omega[3 * i], motion.omega[3 * i + 1], motion.omega[3 * i + 2]};
    const double* q = motion.attitude.data() + 4 * i;
    const Vector3d L = rotate({q[0], q[1], q[2], q[3]}, I * w);
    drifts.energy = std::max(drifts.energy, std::abs(w.dot(I * w) / T0 - 1));
    drifts.size = std::max(drifts.size, std::abs(L.norm() / L0.norm() - 1));
    drifts.vector = std::max(drifts.vector, (L - L0).norm() / L0.norm());
  }
  return drifts;
}

void check_order(const ode::MethodRecord& method, const Scene& scene, int order, double least_slope,
                 double most_slope) {
  double error[2], work[2];
  for (int k = 0; k < 2; ++k) {
    SolveOptions options = at_accuracy(method, method.adaptive && k == 1 ? 1e-8 : 1e-4, order);
    if (!method.adaptive && k == 1) *options.step /= 2;
    const Motion motion = solve(scene, options);
    REQUIRE(motion.status == Status::finished);
    error[k] = compute_error(scene, motion);
    work[k] = static_cast<double>(motion.stats.steps);
  }
  if (error[0] < 1e-13) return;   // exact
  if (method.adaptive_order) return;   // its order follows the tolerance
  const double slope = std::log(error[0] / error[1]) / std::log(work[1] / work[0]);
  CAPTURE(error[0]);
  CAPTURE(error[1]);
  CHECK(slope > least_slope);
  CHECK(slope < most_slope);
}

template <class Check>
void for_each_method(Check&& check) {
  for (const ode::MethodRecord& method : methods()) {
    const std::string name(method.name);
    CAPTURE(name);
    check(method);
  }
}

}  // namespace

TEST_CASE("every method: the order of its record, free and driven, at the end and between the steps") {
  for_each_method([](const ode::MethodRecord& method) {
    // An adaptive method's tolerance spans more than one halving, so its slope is less sharp.
    const double below = method.adaptive ? 0.6 : 0.15, above = method.adaptive ? 2.0 : 0.3;
    check_order(method, make_free(method, {end_time}), method.order, method.order - below, method.order + above);
    if (method.order == 0) return;
    const int driven = method.order_with_torque(), between = std::min(method.order, method.dense_order);
    check_order(method, make_driven({end_time}), driven, driven - below, driven + above + 0.4);
    check_order(method, make_free(method, even_times(97)), method.order, between - below - 0.2, 99);
  });
}

TEST_CASE("every adaptive method: the error stays near its tolerance") {
  for_each_method([](const ode::MethodRecord& method) {
    if (!method.adaptive) return;
    for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) {
      for (const Scene& scene : {make_free(method, even_times(40)), make_driven(even_times(40))}) {
        const double error = compute_error(scene, solve(scene, at_accuracy(method, rtol, method.order)));
        CHECK(error < 300 * rtol);
        CHECK(error > 1e-4 * rtol);
      }
    }
  });
}

TEST_CASE(
    "every method: what it keeps of a free body is kept to rounding, over 200000 steps too, and nothing else is") {
  for_each_method([](const ode::MethodRecord& method) {
    if (method.adaptive) return;
    const double step = 0.02;
    std::vector<double> times;
    for (int i = 0; i <= 20; ++i) times.push_back(200 * i * step);
    const Scene scene = make_free(method, times);
    SolveOptions options{.method = std::string(method.name), .step = step};
    const Drifts drifts = compute_drifts(scene, solve(scene, options));
    const std::pair<const char*, double> kept[] = {
        {"energy", drifts.energy}, {"|L|", drifts.size}, {"L", drifts.vector}};
    for (const auto& each : kept) {   // CAPTURE is a lambda, which in C++20 Clang lets no structured binding into
      const char* const invariant = each.first;
      const double drift = each.second;
      CAPTURE(invariant);
      if (claims(method, invariant)) {
        CHECK(drift < 2e-13);
      } else if (!claims(method, "L_z")) {
        CHECK_FALSE(drift < 1e-10);   // and not NaN either
      }
    }
    if (!claims(method, "|L|")) return;
    const Scene longer = make_free(method, {200000 * step});
    CHECK(compute_drifts(longer, solve(longer, options)).size <
          5e-12);   // 7e-12 where omega is carried and L made of it each step
  });
}

TEST_CASE("every method: backwards, there and back, a span of zero, and a start at another time") {
  for_each_method([](const ode::MethodRecord& method) {
    const SolveOptions options = at_accuracy(method, 1e-6, method.order);
    const Scene there = make_free(method, {end_time, -end_time, 0.0});
    const Motion motion = solve(there, options);
    REQUIRE(motion.t.size() == 3);
    CHECK(motion.omega[6] == there.omega()[0]);   // bit for bit
    CHECK(motion.attitude[8] == there.attitude().x);
    const double error = compute_error(there, solve(make_free(method, {end_time}), options));
    CHECK(compute_error(there, motion) < 8 * error + 1e-12);

    SceneParts parts{.inertia_B = there.inertia_B(), .omega = {motion.omega[0], motion.omega[1], motion.omega[2]},
                     .attitude = {motion.attitude[0], motion.attitude[1], motion.attitude[2], motion.attitude[3]},
                     .times = {0.0, end_time}, .t0 = end_time};
    const Motion back = solve(Scene(parts), options);
    REQUIRE(back.t.size() == 2);
    CHECK(back.omega[3] == parts.omega[0]);
    double away = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      away = std::max(away, std::abs(back.omega[k] - there.omega()[static_cast<int>(k)]));
    CHECK(away / there.omega().norm() < 8 * error + 1e-12);

    const Motion none = solve(make_free(method, {0.0, 0.0}), options);
    CHECK(none.t.size() == 2);
    CHECK(none.stats.steps == 0);
  });
}

TEST_CASE("every method: the same bits again, whatever the samples; dense output is what the samples are") {
  for_each_method([](const ode::MethodRecord& method) {
    SolveOptions options = at_accuracy(method, 1e-6, method.order);
    const Motion once = solve(make_free(method, {end_time}), options);
    options.dense = true;
    const Motion sampled = solve(make_free(method, even_times(97)), options);
    for (std::size_t k = 0; k < 3; ++k) CHECK(sampled.omega[3 * 97 + k] == once.omega[k]);
    for (std::size_t k = 0; k < 4; ++k) CHECK(sampled.attitude[4 * 97 + k] == once.attitude[k]);
    for (std::size_t i = 0; i < sampled.t.size(); i += 7) {
      const State state = sampled.at(sampled.t[i]);
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(std::abs(state.omega[static_cast<int>(k)] - sampled.omega[3 * i + k]) < 1e-12);
      CHECK(std::abs(state.attitude.x - sampled.attitude[4 * i]) < 1e-12);
    }
  });
}

TEST_CASE("every method: moments, rates and times by 2^40 and 2^-40 change no bit, by 1e12 and 1e-12 hardly any") {
  for_each_method([](const ode::MethodRecord& method) {
    const SolveOptions plain = at_accuracy(method, 1e-6, method.order);
    const Motion base = solve(make_free(method, {0.4 * end_time, end_time}), plain);
    for (const double factor : {0x1p40, 0x1p-40, 1e12, 1e-12}) {
      const bool exact = (factor == 0x1p40 || factor == 0x1p-40);
      const Motion heavy = solve(make_free(method, {0.4 * end_time, end_time}, factor), plain);
      const Motion fast = solve(make_free(method, {0.4 * end_time, end_time}, 1.0, factor),
                                at_accuracy(method, 1e-6, method.order, factor));
      for (std::size_t k = 0; k < 6; ++k) {
        if (exact) {
          CHECK(heavy.omega[k] == base.omega[k]);
          CHECK(fast.omega[k] == base.omega[k] * factor);
        } else {
          CHECK(std::abs(heavy.omega[k] - base.omega[k]) < 1e-7);
          CHECK(std::abs(fast.omega[k] / factor - base.omega[k]) < 1e-7);
        }
      }
    }
  });
}

TEST_CASE("every method: events, the bounds of the span, and the limit of the steps") {
  for_each_method([](const ode::MethodRecord& method) {
    SolveOptions options = at_accuracy(method, 1e-6, method.order);
    options.events = {{[](const State& s) { return s.omega[0]; }, 0, true}};
    const Motion motion = solve(make_free(method, {0.0, 100.0}), options);
    if (method.order > 0) {
      CHECK(motion.status == Status::event);
      REQUIRE(motion.events.size() == 1);
      CHECK(std::abs(motion.events[0].state.omega[0]) < 1e-12);
    }
    options.events.clear();

    double least = 1e9, most = -1e9;
    const auto watching = torques::Custom::from(
        [&](double t, const double*, const double*, double* torque) {
          least = std::min(least, t);
          most = std::max(most, t);
          torque[0] = torque[1] = 0.0, torque[2] = 0.01;
        },
        {.uses_time = true, .uses_attitude = false, .uses_rates = false});
    const Scene watched({.inertia_B = InertiaTensor::from_moments(block), .omega = block_omega, .torques = {watching},
                         .times = {0.7, 1.9}, .t0 = 0.5});
    if (compute_refusal(method.name, watched).empty()) {
      CHECK(solve(watched, options).t.size() == 2);
      CHECK(least >= 0.5);
      CHECK(most <= 1.9);
    }

    options.max_steps = 3;
    const Motion short_run = solve(make_free(method, {100.0}), options);
    CHECK(short_run.status == Status::max_steps);
    CHECK(short_run.stats.steps == 3);
  });
}
