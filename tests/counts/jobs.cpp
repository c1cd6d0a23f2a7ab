#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/free_sensitivity.hpp"
#include "polhode/batch/gyrostat.hpp"
#include "polhode/batch/heavy_top.hpp"
#include "polhode/batch/solve_many.hpp"
#include "polhode/batch/step.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/gyrostat.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/inertia/mesh.hpp"
#include "polhode/solve/solve.hpp"
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS_AT(name) static_cast<void>(name)
#endif

// Twenty jobs, one after the other, each with an instruction count of its own under callgrind. What a process does once
// (the choice of kernels, first memory) is not counted: each job runs once before.

using namespace polhode;

namespace {

constexpr std::size_t many = 4096;

/// Numbers in [0, 1), always the same.
class Draw {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 7;
};

struct Bodies {
  std::vector<double> moments, omega, attitude, axes;
  explicit Bodies(std::size_t n) {
    Draw draw;
    for (std::size_t i = 0; i < n; ++i) {
      double square[3], sum = 0.0;
      for (double& s : square) s = 0.1 + 0.9 * draw(), sum += s;
      for (const double s : square) moments.push_back(sum - s);
      for (int k = 0; k < 3; ++k) omega.push_back(4.0 * draw() - 2.0), axes.push_back(draw());
      for (const double x : {0.5, -0.5, 0.5, 0.5}) attitude.push_back(x);
    }
  }
};

const double box[] = {0.2, 0.4, 0.52}, spin[] = {1, 2, 3}, racket[] = {1e-4, 5, 1e-4}, start[] = {0.5, -0.5, 0.5, 0.5};
const double round_top[] = {1, 1, 0.5}, top_spin[] = {0.1, 0.2, 5.0}, arm = 1.3, rotor[] = {0.1, -0.3, 0.5};
const Bodies bodies(many);
std::vector<double> times(many), grid(many), w(3 * many), q(4 * many), d(3 * many), jw(9 * many), jq(9 * many);
std::vector<float> w32(3 * many), q32(4 * many);

FreeMotionBatch one(const double* omega, const std::vector<double>& t) {
  return {.bodies = 1, .times = many, .moments = box, .omega = omega, .attitude = start, .t = t.data()};
}
FreeMotionBatch each(std::size_t n, std::size_t count, bool own) {
  return {.bodies = n, .times = count, .moments = bodies.moments.data(), .omega = bodies.omega.data(),
          .attitude = bodies.attitude.data(), .t = (own ? times : grid).data(), .own_times = own};
}
HeavyTopBatch top(const std::vector<double>& t) {
  return {.bodies = 1, .times = many, .moments = round_top, .weight_arm = &arm, .omega = top_spin, .attitude = start,
          .t = t.data()};
}

Scene make_scene(bool heavy) {
  SceneParts parts{.inertia_B = InertiaTensor::from_moments({1.0, 1.5, 2.25}), .omega = {0.25, 3.0, -0.5},
                   .attitude = {0.5, -0.5, 0.5, 0.5}, .times = {0.5, 1.25, 4.0}};
  if (heavy) parts.torques.push_back(torques::Gravity(2.0, {0.25, 0.125, 0.5}));
  return Scene(std::move(parts));
}
void solve_by(const char* method, double accuracy) {
  static const Scene scene = make_scene(true);
  SolveOptions options;
  if (method != nullptr) options.method = method, options.rtol = accuracy;
  else options.accuracy = accuracy;
  solve(scene, options);
}

template <class T>
void step() {
  const std::vector<T> moments = {T(0.2), T(0.4), T(0.52)};
  std::vector<T> momentum(3 * 512, T(0.3)), attitude(4 * 512, T(0.5));
  StepBatch<T> batch;
  batch.bodies = 512, batch.moments = moments.data(), batch.one_inertia = true, batch.step = T(0.02), batch.count = 8;
  batch.momentum = momentum.data(), batch.attitude = attitude.data();
  step_bodies(batch, 1);
}

/// A closed strip of triangles between two poles.
void integrate() {
  constexpr std::int32_t around = 2048;
  static const auto shape = [] {
    std::pair<std::vector<double>, std::vector<std::int32_t>> mesh;
    for (std::int32_t i = 0; i < around; ++i) {
      const double x = 2.0 * i / around - 1.0;
      for (const double v : {x, x * (1 - x), x * x}) mesh.first.push_back(v);
      const std::int32_t next = (i + 1) % around;
      for (const std::int32_t v : {i, next, around, next, i, around + 1}) mesh.second.push_back(v);
    }
    for (const double v : {0.0, 0.0, 1.0, 0.0, 0.0, -1.0}) mesh.first.push_back(v);
    return mesh;
  }();
  integrate_mesh(Mesh(shape.first.data(), shape.first.size() / 3, shape.second.data(), shape.second.size() / 3));
}

const std::vector<std::pair<const char*, std::function<void()>>> jobs = {
    {"free motion: any times", [] { free_motion(one(spin, times), w.data(), q.data(), 1); }},
    {"free motion: uniform grid", [] { free_motion(one(spin, grid), w.data(), q.data(), 1); }},
    {"free motion: near the separatrix", [] { free_motion(one(racket, times), w.data(), q.data(), 1); }},
    {"free motion: float32", [] { free_motion(one(spin, times), {.single = {w32.data(), q32.data(), nullptr}}, 1); }},
    {"free motion: directions",
     [] { free_motion(one(spin, times), {.rows = {nullptr, nullptr, d.data()}, .vector = spin}, 1); }},
    {"free motion: a body at one time each", [] { free_motion(each(many, 1, true), w.data(), q.data(), 1); }},
    {"free motion: bodies x times", [] { free_motion(each(32, 128, false), w.data(), q.data(), 1); }},
    {"free motion: derivatives",
     [] {
       free_sensitivity(one(spin, times), {SensitivityTo::omega}, RotationSide::body, w.data(), q.data(), jw.data(),
                        jq.data(), 1);
     }},
    {"FreeMotion: set-up",
     [] {
       for (int i = 0; i < 100; ++i) FreeMotion(Vector3d(0.2, 0.4, 0.52), Vector3d(1, 2, 3));
     }},
    {"FreeMotion: set-up near the separatrix",
     [] {
       for (int i = 0; i < 100; ++i) FreeMotion(Vector3d(0.2, 0.4, 0.52), Vector3d(1e-4, 5, 1e-4));
     }},
    {"heavy top: any times", [] { heavy_top(top(times), w.data(), q.data(), 1); }},
    {"heavy top: uniform grid", [] { heavy_top(top(grid), w.data(), q.data(), 1); }},
    {"gyrostat: any times",
     [] {
       const GyrostatBatch batch{.bodies = 1, .times = many, .moments = box, .momentum = rotor, .omega = spin,
                                 .attitude = start, .t = times.data()};
       gyrostat(batch, w.data(), q.data(), 1);
     }},
    {"step: float32", [] { step<float>(); }},
    {"step: float64", [] { step<double>(); }},
    {"solve: taylor at 1e-12", [] { solve_by("taylor", 1e-12); }},
    {"solve: dop853 at 1e-9", [] { solve_by("dop853", 1e-9); }},
    {"solve: accuracy 1e-9 with its certificate", [] { solve_by(nullptr, 1e-9); }},
    {"solve_many: rk45 in lanes",
     [] {
       SolveOptions options;
       options.method = "rk45", options.rtol = 1e-6;
       solve_many(32, 3, [](std::size_t) { return make_scene(true); }, options, w.data(), q.data(), 1);
     }},
    {"mesh: 4096 faces", [] { integrate(); }},
};

}  // namespace

int main() {
  Draw draw;
  for (double& t : times) t = 1000.0 * draw();
  for (std::size_t i = 0; i < many; ++i) grid[i] = 0.25 * static_cast<double>(i);
  for (const auto& [name, work] : jobs) {
    work();
    CALLGRIND_ZERO_STATS;
    work();
    CALLGRIND_DUMP_STATS_AT(name);
    std::printf("%s\n", name);
  }
}
