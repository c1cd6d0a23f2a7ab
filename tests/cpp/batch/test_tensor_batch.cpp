#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/heavy_top.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"

using namespace polhode;

namespace {

constexpr std::size_t bodies = 70;   // more than one block

InertiaTensor make_tensor(const Vector3d& moments) {
  return InertiaTensor::from_moments(moments).rotated(normalized(Quat{0.1, 0.7, -0.3, 0.6}));
}

/// Starts of bodies with one tensor: in general, at rest, on and next to the unstable axis, of any size.
struct Starts {
  std::vector<double> omega, attitude, arms, t;
  explicit Starts(const InertiaTensor& tensor) {
    for (int i = 0; i < int{bodies}; ++i) {
      Vector3d w(std::cos(i), std::sin(3 * i), 2 * std::cos(2 * i + 1));
      if (i == 3) w.setZero();
      if (i == 4) w = 3.0 * tensor.axes().col(1);
      if (i == 5) w = 3.0 * tensor.axes().col(1) + 1e-9 * w;
      if (i == 6) w *= 1e-7;
      for (const double v : w) omega.push_back(v);
      const Quat q = normalized({std::sin(i), 0.5, std::cos(i), -0.25});
      for (const double v : {q.x, q.y, q.z, q.w}) attitude.push_back(v);
      arms.push_back(i % 2 == 0 ? 2.0 : -1.5);
      t.push_back(1.75 * i - 50.0);
    }
  }
  Vector3d w(std::size_t i) const { return {omega[3 * i], omega[3 * i + 1], omega[3 * i + 2]}; }
  Quat q(std::size_t i) const {
    return {attitude[4 * i], attitude[4 * i + 1], attitude[4 * i + 2], attitude[4 * i + 3]};
  }
  FreeMotionBatch free() const {
    return {.bodies = bodies, .omega = omega.data(), .attitude = attitude.data()};
  }
  HeavyTopBatch tops() const {
    return {.bodies = bodies, .weight_arm = arms.data(), .omega = omega.data(), .attitude = attitude.data()};
  }
};

struct States {
  std::vector<double> omega, attitude;
  explicit States(std::size_t n) : omega(3 * n), attitude(4 * n) {}
  friend bool operator==(const States&, const States&) = default;
};

/// A batch at the given times, with one thread and with three.
template <class Batch>
States evaluate(Batch batch, const std::vector<double>& t, bool own_times,
                std::size_t (*motion)(const Batch&, double*, double*, int)) {
  batch.t = t.data(), batch.own_times = own_times, batch.times = own_times ? t.size() / bodies : t.size();
  States found(bodies * batch.times), again(bodies * batch.times);
  CHECK(motion(batch, found.omega.data(), found.attitude.data(), 1) == 0);
  CHECK(motion(batch, again.omega.data(), again.attitude.data(), 3) == 0);
  CHECK(found == again);
  return found;
}

/// The same, one body after the other.
template <class MakeMotion>
States evaluate_singly(const MakeMotion& make_motion, const std::vector<double>& t, bool own_times) {
  const std::size_t times = own_times ? t.size() / bodies : t.size();
  States found(bodies * times);
  for (std::size_t i = 0; i < bodies; ++i) {
    make_motion(i).at(t.data() + (own_times ? i * times : 0), times, &found.omega[3 * i * times],
                      &found.attitude[4 * i * times]);
  }
  return found;
}

std::vector<double> make_grid() {
  std::vector<double> t;
  for (int i = 0; i < 40; ++i) t.push_back(0.125 * i - 1.0);
  return t;
}

}  // namespace

TEST_CASE("free bodies with a full tensor have the bits of FreeMotion") {
  const InertiaTensor tensor = make_tensor({1.0, 2.0, 2.5});
  const Starts starts(tensor);
  FreeMotionBatch batch = starts.free();
  batch.tensor = &tensor;
  const auto single = [&](std::size_t i) { return FreeMotion(tensor, starts.w(i), starts.q(i)); };
  CHECK(evaluate(batch, starts.t, true, &free_motion) == evaluate_singly(single, starts.t, true));
  CHECK(evaluate(batch, make_grid(), false, &free_motion) == evaluate_singly(single, make_grid(), false));
}

TEST_CASE("tops with a full tensor have the bits of HeavyTop") {
  const InertiaTensor tensor = make_tensor({1.0, 1.0, 0.6});
  const Starts starts(tensor);
  HeavyTopBatch batch = starts.tops();
  batch.tensor = &tensor;
  const auto single = [&](std::size_t i) { return HeavyTop(tensor, starts.arms[i], starts.w(i), starts.q(i)); };
  CHECK(evaluate(batch, starts.t, true, &heavy_top) == evaluate_singly(single, starts.t, true));
  CHECK(evaluate(batch, make_grid(), false, &heavy_top) == evaluate_singly(single, make_grid(), false));
}

TEST_CASE("a diagonal tensor has the bits of its moments, in their order") {
  const Vector3d triaxial(2.5, 1.0, 2.0), symmetric(1.0, 0.6, 1.0);
  const InertiaTensor body = InertiaTensor::from_moments(triaxial), top = InertiaTensor::from_moments(symmetric);
  const Starts starts(body);
  std::vector<double> moments, top_moments;
  for (std::size_t i = 0; i < bodies; ++i) {
    moments.insert(moments.end(), triaxial.begin(), triaxial.end());
    top_moments.insert(top_moments.end(), symmetric.begin(), symmetric.end());
  }
  FreeMotionBatch by_moments = starts.free(), by_tensor = by_moments;
  by_moments.moments = moments.data(), by_tensor.tensor = &body;
  CHECK(evaluate(by_tensor, starts.t, true, &free_motion) == evaluate(by_moments, starts.t, true, &free_motion));
  CHECK(evaluate(by_tensor, make_grid(), false, &free_motion) == evaluate(by_moments, make_grid(), false, &free_motion));
  HeavyTopBatch tops_by_moments = starts.tops(), tops_by_tensor = tops_by_moments;
  tops_by_moments.moments = top_moments.data(), tops_by_tensor.tensor = &top;
  CHECK(evaluate(tops_by_tensor, starts.t, true, &heavy_top) == evaluate(tops_by_moments, starts.t, true, &heavy_top));
}

TEST_CASE("a batch with a tensor counts what is not finite, and refuses a body that cannot spin") {
  const InertiaTensor tensor = make_tensor({1.0, 1.0, 0.6}), rod = make_tensor({1.0, 1.0, 0.0}),
                      triaxial = make_tensor({1.0, 2.0, 2.5});
  Starts starts(tensor);
  starts.omega[30] = NAN, starts.attitude[45] = INFINITY;
  States found(bodies);
  FreeMotionBatch free = starts.free();
  free.tensor = &tensor, free.t = starts.t.data(), free.times = 1, free.own_times = true;
  HeavyTopBatch tops = starts.tops();
  tops.tensor = &tensor, tops.t = starts.t.data(), tops.times = 1, tops.own_times = true;
  CHECK(free_motion(free, found.omega.data(), found.attitude.data()) == 2);
  CHECK(std::isnan(found.omega[30]));
  CHECK(std::isfinite(found.omega[36]));
  CHECK(heavy_top(tops, found.omega.data(), found.attitude.data()) == 2);
  free.tensor = &rod, tops.tensor = &triaxial;
  CHECK_THROWS_WITH_AS(free_motion(free, found.omega.data(), nullptr), doctest::Contains("positive about every axis"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(heavy_top(tops, found.omega.data(), nullptr, 1), doctest::Contains("body[0]"), InvalidInput);
}
