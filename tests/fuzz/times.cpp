#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/heavy_top.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"

#include <algorithm>
#include <cmath>

#include "input.hpp"

// Closed forms at any times: grids, grids with holes, any 64 bits. Batches have the same bits for any threads and
// neighbours, and the values of a single body to rounding.

namespace polhode::fuzz {
namespace {

std::vector<double> times(Input& input) {
  std::vector<double> all;
  const std::size_t most = input.coin() ? 300 : 10;
  for (std::size_t parts = input.below(3); parts > 0; --parts) {   // grids, from 64 times on a case of its own
    const double start = input.number(), step = input.number();
    const std::size_t count = input.below(most);
    for (std::size_t i = 0; i < count; ++i) all.push_back(start + static_cast<double>(i) * step);
  }
  for (std::size_t changes = input.below(6); changes > 0; --changes) {
    const double t = input.number();
    if (all.empty() || input.coin()) {
      all.push_back(t);
    } else {
      all[input.below(all.size())] = t;
    }
  }
  return all;
}

struct Bodies {
  std::vector<double> moments, omega, attitude, arm;
};

Bodies bodies(Input& input, std::size_t n, bool top) {
  Bodies all;
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && input.coin()) {   // as the first
      for (int k = 0; k < 3; ++k) all.moments.push_back(all.moments[k]), all.omega.push_back(all.omega[k]);
    } else {
      const bool ordinary = input.coin();
      for (int k = 0; k < 3; ++k) all.moments.push_back(ordinary ? 1.0 + 0.9 * input.fraction() : input.number());
      if (top) all.moments[3 * i + 1] = all.moments[3 * i];
      for (int k = 0; k < 3; ++k) all.omega.push_back(input.number());
    }
    const Quat q = input.attitude();
    all.attitude.insert(all.attitude.end(), {q.x, q.y, q.z, q.w});
    all.arm.push_back(input.number());
  }
  return all;
}

/// Within 1e-12 of the largest; what is not finite is so in both.
bool is_near(const double* a, const double* b, std::size_t n) {
  double size = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    if (std::isfinite(a[i])) size = std::max(size, std::abs(a[i]));
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isfinite(a[i]) != std::isfinite(b[i])) return false;
    if (std::isfinite(a[i]) && std::abs(a[i] / size - b[i] / size) > 1e-12) return false;
  }
  return true;
}

template <class Form, class Batch, class Run>
void compare(const Form& form, Batch batch, const Run& run, std::size_t n) {
  const std::size_t m = batch.times;
  std::vector<double> w(3 * m), q(4 * m), all_w(3 * m * n), all_q(4 * m * n), again(3 * m * n);
  if (!is_done([&] { form.at(batch.t, m, w.data(), q.data()); })) return;
  const bool done = is_done([&] { run(batch, all_w.data(), all_q.data(), 1); });
  if (is_done([&] { run(batch, again.data(), nullptr, 3); }) && done)
    require(is_same(all_w.data(), again.data(), 3 * m * n), "the same bits for any threads");
  batch.bodies = 1;
  batch.own_times = false;
  std::vector<double> one_w(3 * m), one_q(4 * m);
  const bool single = is_done([&] { run(batch, one_w.data(), one_q.data(), 1); });
  require(single, "a body that is computed alone is computed in a batch");
  require(is_near(w.data(), one_w.data(), 3 * m) && is_near(q.data(), one_q.data(), 4 * m), "batch and single agree");
  if (done && !batch.own_times) require(is_same(one_w.data(), all_w.data(), 3 * m), "the bits of other neighbours");
  for (std::size_t i = 0; i < m; ++i) {
    double length = 0.0;
    for (int k = 0; k < 4; ++k) length += q[4 * i + k] * q[4 * i + k];
    require(!std::isfinite(batch.t[i]) || std::abs(length - 1.0) < 1e-13, "attitudes are unit");
  }
}

}  // namespace
}  // namespace polhode::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace polhode;
  fuzz::Input input(data, size);
  const bool top = input.coin();
  const std::size_t n = 1 + input.below(12);
  const fuzz::Bodies bodies = fuzz::bodies(input, n, top);
  const std::vector<double> t = fuzz::times(input);
  if (t.empty()) return 0;
  const Vector3d moments(bodies.moments.data()), omega(bodies.omega.data());
  const Quat q{bodies.attitude[0], bodies.attitude[1], bodies.attitude[2], bodies.attitude[3]};
  if (top) {
    fuzz::is_done([&] {
      const HeavyTop form(moments, bodies.arm[0], omega, q);
      const HeavyTopBatch batch{.bodies = n, .times = t.size(), .moments = bodies.moments.data(),
                                .weight_arm = bodies.arm.data(), .omega = bodies.omega.data(),
                                .attitude = bodies.attitude.data(), .t = t.data()};
      const auto run = [](const HeavyTopBatch& b, double* w, double* to, int threads) { heavy_top(b, w, to, threads); };
      fuzz::compare(form, batch, run, n);
    });
  } else {
    fuzz::is_done([&] {
      const FreeMotion form(moments, omega, q);
      const FreeMotionBatch batch{.bodies = n, .times = t.size(), .moments = bodies.moments.data(),
                                  .omega = bodies.omega.data(), .attitude = bodies.attitude.data(), .t = t.data()};
      const auto run = [](const FreeMotionBatch& b, double* w, double* to, int threads) {
        free_motion(b, w, to, threads);
      };
      fuzz::compare(form, batch, run, n);
      fuzz::is_done([&] { form.euler_angles(t[0]), form.polhode(t[0]), form.herpolhode(t[0]); });
      const double period = form.period();
      if (period > 0 && std::abs(t[0]) < 100 * period) fuzz::is_done([&] { form.flip_times(t[0], t[0] + 9 * period); });
    });
  }
  return 0;
}
