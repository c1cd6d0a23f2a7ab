#include "polhode/attitude/detail/arrays.hpp"

#include <algorithm>
#include <cmath>

#include "attitude/rows.hpp"
#include "attitude/sincos.hpp"
#include "polhode/attitude/kinematics.hpp"
#include "polhode/attitude/rotation_vector.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::arrays {
namespace {

Quat load(const double* q) { return {q[0], q[1], q[2], q[3]}; }
Vector3d load3(const double* v) { return {v[0], v[1], v[2]}; }

double square_norm(const Quat& q) { return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w; }
Quat scaled(const Quat& q, double factor) { return {q.x * factor, q.y * factor, q.z * factor, q.w * factor}; }

void store(const Quat& q, double* out) { out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w; }
void store(const Vector3d& v, double* out) { out[0] = v[0], out[1] = v[1], out[2] = v[2]; }

}  // namespace

std::size_t quat_from_euler(const EulerSequence& sequence, std::size_t n, const double* angles, double unit,
                            double* q) {
  constexpr std::size_t kRows = 64;
  double half[3 * kRows], s[3 * kRows], c[3 * kRows];
  const std::size_t in[3] = {sequence.extrinsic() ? 2u : 0u, 1u, sequence.extrinsic() ? 0u : 2u};
  for (std::size_t begin = 0; begin < n; begin += kRows) {
    const std::size_t rows = std::min(kRows, n - begin), count = 3 * rows;
    const double* block = angles + 3 * begin;
    bool small = true;
    for (std::size_t i = 0; i < count; ++i) {
      half[i] = block[i] * (0.5 * unit);
      small &= std::abs(half[i]) <= kSinCosLimit;
    }
    if (small) {
      sincos(count, half, s, c);
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        if (!std::isfinite(half[i])) return begin + i / 3;
        const math::SinCosPair at = math::sincos(half[i]);
        s[i] = at.sin, c[i] = at.cos;
      }
    }
    for (std::size_t row = 0; row < rows; ++row) {
      const double *row_s = s + 3 * row, *row_c = c + 3 * row;
      const double intrinsic_s[3] = {row_s[in[0]], row_s[1], row_s[in[2]]};
      const double intrinsic_c[3] = {row_c[in[0]], row_c[1], row_c[in[2]]};
      compose(sequence, intrinsic_s, intrinsic_c, q + 4 * (begin + row));
    }
  }
  return n;
}

void to_euler(const EulerSequence& sequence, std::size_t n, const double* q, double unit, double* angles) {
  for (std::size_t i = 0; i < n; ++i) {
    store(Vector3d(polhode::to_euler(sequence, load(q + 4 * i)) / unit), angles + 3 * i);
  }
}

void gimbal_lock(const EulerSequence& sequence, std::size_t n, const double* q, bool* locked) {
  for (std::size_t i = 0; i < n; ++i) locked[i] = polhode::gimbal_lock(sequence, load(q + 4 * i));
}

std::size_t quat_from_matrix(std::size_t n, const double* R, double* q) {
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_WB(R + 9 * i);
    Quat q_WB;
    if (!try_quat_from_matrix(R_WB, q_WB)) return i;
    store(q_WB, q + 4 * i);
  }
  return n;
}

void to_matrix(std::size_t n, const double* q, double* R) {
  for (std::size_t i = 0; i < n; ++i) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R + 9 * i) = polhode::to_matrix(load(q + 4 * i));
  }
}

std::size_t quat_from_rotation_vector(std::size_t n, const double* v, double unit, double* q) {
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d vector = unit * load3(v + 3 * i);
    if (!vector.array().isFinite().all()) return i;
    store(polhode::quat_from_rotation_vector(vector), q + 4 * i);
  }
  return n;
}

void to_rotation_vector(std::size_t n, const double* q, double unit, double* v) {
  for (std::size_t i = 0; i < n; ++i) store(Vector3d(polhode::to_rotation_vector(load(q + 4 * i)) / unit), v + 3 * i);
}

void rotation_angle(std::size_t n, const double* q, double* angle) {
  for (std::size_t i = 0; i < n; ++i) angle[i] = polhode::rotation_angle(load(q + 4 * i));
}

std::size_t normalize(std::size_t n, const double* q, double* unit_q) {
  for (std::size_t i = 0; i < n; ++i) {
    Quat unit = load(q + 4 * i);
    const double square = square_norm(unit);
    if (!(std::abs(square - 1.0) <= 1.9e-6 || std::abs(std::sqrt(square) - 1.0) <= 1e-6)) return i;
    if (std::abs(square - 1.0) > 1e-12) {
      const double size = std::sqrt(square);
      unit = {unit.x / size, unit.y / size, unit.z / size, unit.w / size};
    }
    store(scaled(unit, back_to_unit_if_off(square_norm(unit))), unit_q + 4 * i);
  }
  return n;
}

void canonical(std::size_t n, const double* q, double* canonical_q) {
  for (std::size_t i = 0; i < n; ++i) store(polhode::canonical(load(q + 4 * i)), canonical_q + 4 * i);
}

void conjugate(std::size_t n, const double* q, double* __restrict q_inverse) {
  for (std::size_t i = 0; i < n; ++i) store(polhode::conjugate(load(q + 4 * i)), q_inverse + 4 * i);
}

void product(std::size_t n, const double* q_AB, std::size_t step_AB, const double* q_BC, std::size_t step_BC,
             double* __restrict q_AC) {
  for (std::size_t i = 0; i < n; ++i) store(load(q_AB + step_AB * i) * load(q_BC + step_BC * i), q_AC + 4 * i);
}

void multiply(std::size_t n, const double* q_AB, std::size_t step_AB, const double* q_BC, std::size_t step_BC,
              double* __restrict q_AC) {
  for (std::size_t i = 0; i < n; ++i) {
    const Quat q = load(q_AB + step_AB * i) * load(q_BC + step_BC * i);
    store(scaled(q, back_to_unit_if_off(square_norm(q))), q_AC + 4 * i);
  }
}

std::size_t rotate(std::size_t n, const double* q_WB, std::size_t step_q, const double* v, std::size_t step_v,
                   bool inverse, double* __restrict rotated) {
  const double sign = inverse ? -1.0 : 1.0;
  double check = 0.0;  // stays 0 while all is finite
  for (std::size_t i = 0; i < n; ++i) {
    Quat q = load(q_WB + step_q * i);
    q.w *= sign;
    const Vector3d from = load3(v + step_v * i);
    check += 0.0 * from[0] + 0.0 * from[1] + 0.0 * from[2];
    store(polhode::rotate(q, from), rotated + 3 * i);
  }
  if (check == 0.0) return n;
  std::size_t row = 0;
  while (row + 1 < n && load3(v + step_v * row).array().isFinite().all()) ++row;
  return row;
}

void body_rates(const EulerSequence& sequence, std::size_t n, const double* angles, std::size_t step_angles,
                const double* angle_rates, std::size_t step_rates, double* w_B) {
  for (std::size_t i = 0; i < n; ++i) {
    store(polhode::body_rates(sequence, load3(angles + step_angles * i), load3(angle_rates + step_rates * i)),
          w_B + 3 * i);
  }
}

std::size_t euler_rates(const EulerSequence& sequence, std::size_t n, const double* angles, std::size_t step_angles,
                        const double* w_B, std::size_t step_w, double* angle_rates) {
  for (std::size_t i = 0; i < n; ++i) {
    Vector3d rates;
    if (!try_euler_rates(sequence, load3(angles + step_angles * i), load3(w_B + step_w * i), rates)) return i;
    store(rates, angle_rates + 3 * i);
  }
  return n;
}

}  // namespace polhode::arrays
