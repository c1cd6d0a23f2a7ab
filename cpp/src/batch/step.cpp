#include "polhode/batch/step.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>

#include "batch/lanes/step_kernels.hpp"
#include "batch/parallel.hpp"
#include "batch/rows.hpp"
#include "core/choose_level.hpp"
#include "core/choose_once.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {
namespace {

constexpr std::size_t grain = 64;         // bodies; a multiple of every block of lanes
constexpr std::size_t round_work = 65536;   // steps of bodies between two checks for Ctrl-C

const StepKernels& choose_kernels() {
  static constinit std::atomic<const StepKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const StepKernels& {
    return *choose_level(simd_level(), baseline_step_lanes, avx2_step_lanes, avx512_step_lanes);
  });
}

template <class T>
bool is_body(const T* I) {
  const T largest = std::max({I[0], I[1], I[2]}), smallest = std::min({I[0], I[1], I[2]}), sum = I[0] + I[1] + I[2];
  constexpr T tolerance = std::is_same_v<T, float> ? T(1e-5) : T(InertiaTensor::tolerance);
  return smallest > 0 && sum <= std::numeric_limits<T>::max() && 2 * largest - sum <= tolerance * largest;
}

template <class T>
bool is_unit(const T* q) {
  const T error = std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1);
  return !(error > (std::is_same_v<T, float> ? T(1e-5) : T(2e-6)));   // NaN passes: it is the body's own
}

template <class T>
constexpr double largest_angle =
    std::is_same_v<T, float> ? 1e10 : 1e25;   // [rad]: beyond it no digit of a phase is left

/// Bound on the sum of a body's components of momentum in all steps. Not finite for a body that becomes NaN.
template <class T>
double bound_momentum(const StepBatch<T>& b, std::size_t body) {
  const auto sum = [](const T* v) {
    return std::abs(static_cast<double>(v[0])) + std::abs(static_cast<double>(v[1])) +
           std::abs(static_cast<double>(v[2]));
  };
  const double kicks = b.torque == nullptr ? 0.0 : sum(b.torque + (b.one_torque ? 0 : 3 * body));
  return sum(b.momentum + 3 * body) + kicks * std::abs(static_cast<double>(b.step)) * static_cast<double>(b.count);
}

/// Bound on the angle of rotation in one step. NaN passes every comparison: it is the body's own.
template <class T>
double bound_angle(const StepBatch<T>& b, std::size_t body) {
  const T* I = b.moments + (b.one_inertia ? 0 : 3 * body);
  const double size = bound_momentum(b, body), least = static_cast<double>(std::min({I[0], I[1], I[2]}));
  return size <= std::numeric_limits<double>::max() ? size * std::abs(static_cast<double>(b.step)) / least : 0.0;
}

/// The first body that is refused, or the number of bodies.
template <class T>
std::size_t find_refused(const StepBatch<T>& b, std::size_t begin, std::size_t end) {
  bool good = true;
  if (!b.one_inertia)
    for (std::size_t i = begin; i < end; ++i) good &= is_body(b.moments + 3 * i);
  for (std::size_t i = begin; i < end; ++i) good &= is_unit(b.attitude + 4 * i);
  for (std::size_t i = begin; i < end; ++i) good &= !(bound_angle(b, i) > largest_angle<T>);
  if (good) return b.bodies;
  for (std::size_t i = begin; i < end; ++i) {
    if (!b.one_inertia && !is_body(b.moments + 3 * i)) return i;
    if (!is_unit(b.attitude + 4 * i) || bound_angle(b, i) > largest_angle<T>) return i;
  }
  return b.bodies;
}

template <class T>
[[noreturn]] void refuse(const StepBatch<T>& b, std::size_t body) {
  const T* I = b.moments + (b.one_inertia ? 0 : 3 * body);
  if (!is_body(I)) {
    throw InvalidInput(b.one_inertia ? "inertia" : row_name("inertia", body),
                       "three positive, finite moments, none above the sum of the two others",
                       "(" + to_text(I[0]) + ", " + to_text(I[1]) + ", " + to_text(I[2]) + ")",
                       "a rod or a point has a zero moment, so its rate about that axis is undefined");
  }
  const T* q = b.attitude + 4 * body;
  if (is_unit(q)) {
    throw InvalidInput(row_name("momentum", body),
                       "such that the body rotates by at most " + to_text(largest_angle<T>) + " rad in a step",
                       to_text(bound_angle(b, body)) + " rad at most",
                       "beyond this the phase has no digits; h may be too large, or the units do not fit");
  }
  double norm2 = 0.0;
  for (int k = 0; k < 4; ++k) norm2 += static_cast<double>(q[k]) * static_cast<double>(q[k]);
  throw InvalidInput(row_name("attitude", body), "a unit quaternion (x, y, z, w)", "norm " + to_text(std::sqrt(norm2)),
                     "normalise it first, if it is meant to be an attitude");
}

template <class T>
void run(const StepBatch<T>& batch, int threads) {
  if (!std::isfinite(batch.step)) {
    throw InvalidInput("h", "a finite time step [s]", to_text(static_cast<double>(batch.step)));
  }
  if (batch.bodies == 0) return;
  if (batch.one_inertia && !is_body(batch.moments)) refuse(batch, 0);
  const std::size_t steps = static_cast<std::size_t>(std::max(1L, batch.count));
  const std::size_t work = steps > std::numeric_limits<std::size_t>::max() / batch.bodies
                               ? std::numeric_limits<std::size_t>::max()
                               : steps * batch.bodies;
  const std::size_t workers = std::min(thread_count(threads, work, 20000), (batch.bodies + grain - 1) / grain);
  std::atomic<std::size_t> refused{batch.bodies};
  parallel_for(batch.bodies, workers, grain, [&](std::size_t begin, std::size_t end) {
    const std::size_t found = find_refused(batch, begin, end);
    std::size_t first = refused;
    while (found < first && !refused.compare_exchange_weak(first, found)) continue;
  });
  if (refused < batch.bodies) refuse(batch, refused);
  if (batch.count == 0) return;

  const StepKernels& kernels = choose_kernels();
  // In pieces, so that Ctrl-C takes effect. Kicks between the steps of a call last a whole step, also between its pieces.
  const long most = static_cast<long>(std::max<std::size_t>(1, round_work / grain));
  parallel_for(batch.bodies, workers, grain, [&](std::size_t begin, std::size_t end) {
    const std::size_t bodies = std::max(grain, round_work / std::min(steps, round_work) / grain * grain);
    for (std::size_t i = begin; i < end; i += bodies) {
      StepBatch<T> piece = batch;
      for (long left = batch.count; left > 0; left -= piece.count) {
        check_interrupt();
        piece.count = std::min(left, most);
        piece.first = left == batch.count ? batch.first : 1.0;
        piece.last = left == piece.count ? batch.last : 0.0;
        if constexpr (std::is_same_v<T, float>) {
          kernels.run_f(piece, i, std::min(end, i + bodies));
        } else {
          kernels.run_d(piece, i, std::min(end, i + bodies));
        }
      }
    }
  });
}

}  // namespace

void step_bodies(const StepBatch<float>& batch, int threads) { run(batch, threads); }
void step_bodies(const StepBatch<double>& batch, int threads) { run(batch, threads); }

namespace {

template <class T>
void multiply_all(std::size_t n, const T* p, const T* q, std::size_t step_q, T* __restrict out) {
  for (std::size_t i = 0; i < n; ++i, p += 4, q += step_q, out += 4) {
    out[0] = p[3] * q[0] + q[3] * p[0] + (p[1] * q[2] - p[2] * q[1]);
    out[1] = p[3] * q[1] + q[3] * p[1] + (p[2] * q[0] - p[0] * q[2]);
    out[2] = p[3] * q[2] + q[3] * p[2] + (p[0] * q[1] - p[1] * q[0]);
    out[3] = p[3] * q[3] - (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]);
  }
}

}  // namespace

void multiply_attitudes(std::size_t n, const float* q_AB, const float* q_BC, std::size_t step_BC, float* q_AC) {
  multiply_all(n, q_AB, q_BC, step_BC, q_AC);
}

void multiply_attitudes(std::size_t n, const double* q_AB, const double* q_BC, std::size_t step_BC, double* q_AC) {
  multiply_all(n, q_AB, q_BC, step_BC, q_AC);
}

}  // namespace polhode
