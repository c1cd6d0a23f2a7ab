#include <cfenv>
#include <doctest/doctest.h>

#include <chrono>
#include <stdexcept>
#include <vector>

#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/solve_many.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/core/interrupt.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

using namespace polhode;

namespace {

struct Asked : std::runtime_error {
  Asked() : std::runtime_error("asked to stop") {}
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Loops until the guard ends it, for two seconds at most.
void wait_for_check() {
  const auto start = std::chrono::steady_clock::now();
  while (seconds_since(start) < 2) check_interrupt();
}

}  // namespace

TEST_CASE("long work asks its guard, short work does not, and the innermost guard is asked") {
  check_interrupt();   // without a guard
  int outer = 0, inner = 0;
  const InterruptGuard first([&] { ++outer, throw Asked(); });
  check_interrupt();
  CHECK(outer == 0);
  CHECK_THROWS_AS(wait_for_check(), Asked);
  CHECK(outer == 1);
  {
    const InterruptGuard second([&] { ++inner, throw Asked(); });
    CHECK_THROWS_AS(wait_for_check(), Asked);
  }
  CHECK(outer == 1);
  CHECK(inner == 1);
  CHECK_THROWS_AS(wait_for_check(), Asked);
  CHECK(outer == 2);
}

TEST_CASE("batches end by the guard of the calling thread, on any number of threads") {
  const std::size_t bodies = 400'000, times = 16;
  std::vector<double> moments, omega, attitude, t, out(3 * bodies * times);
  for (std::size_t i = 0; i < bodies; ++i) {
    moments.insert(moments.end(), {1.0, 2.0, 2.5});
    omega.insert(omega.end(), {0.1, 1.0, 0.3});
    attitude.insert(attitude.end(), {0.0, 0.0, 0.0, 1.0});
  }
  for (std::size_t i = 0; i < times; ++i) t.push_back(static_cast<double>(i * i));
  FreeMotionBatch batch;
  batch.bodies = bodies, batch.times = times;
  batch.moments = moments.data(), batch.omega = omega.data(), batch.attitude = attitude.data(), batch.t = t.data();
  const MakeScene make_scene = [](std::size_t) {
    return Scene(SceneParts{InertiaTensor::from_moments({1, 2, 2.5}), {0.1, 1, 0.3}, {},
                            {torques::Damping(Matrix3d::Identity())}, {10.0}, {true, false}, 0.0, ""});
  };
  SolveOptions options;
  options.accuracy = 1e-6;
  for (const int threads : {1, 2, 4}) {
    int asked = 0;
    const InterruptGuard guard([&] { ++asked, throw Asked(); });
    CHECK_THROWS_AS(for (int i = 0; i < 100; ++i) free_motion(batch, out.data(), nullptr, threads), Asked);
    CHECK_THROWS_AS(solve_many(bodies, 1, make_scene, options, out.data(), nullptr, threads), Asked);
    CHECK(asked == 2);
  }
}

TEST_CASE("other modes of rounding than to nearest are seen") {
  const int before = std::fegetround();
  CHECK(rounds_to_nearest());
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const bool nearest = rounds_to_nearest();
    std::fesetround(before);
    CHECK_FALSE(nearest);
  }
}

TEST_CASE("denormal numbers are refused where the processor takes them for 0") {
  const double tiny = 0x1p-1030;
  CHECK_FALSE(flushes_to_zero());
  CHECK_NOTHROW(require_kept(tiny, "x"));
  CHECK_NOTHROW(InertiaTensor::from_moments({tiny, tiny, tiny}));
#if defined(__SSE2__)
  const unsigned before = _mm_getcsr();
  for (const unsigned bit : {0x8000u, 0x0040u}) {
    _mm_setcsr(before | bit);
    const bool flushes = flushes_to_zero();
    bool refused = false, taken = true;
    try {
      InertiaTensor::from_moments({tiny, tiny, tiny});
    } catch (const InvalidInput&) {
      refused = true;
    }
    try {
      InertiaTensor::from_moments({0x1p-1022, 0x1p-1022, 0x1p-1022}), require_kept(0.0, "x"), require_kept(-0.0, "x");
    } catch (const InvalidInput&) {
      taken = false;
    }
    _mm_setcsr(before);
    CHECK(flushes);
    CHECK(refused);
    CHECK(taken);
  }
#endif
}
