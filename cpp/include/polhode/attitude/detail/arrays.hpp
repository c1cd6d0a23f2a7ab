#pragma once

#include <cstddef>

#include "polhode/attitude/euler.hpp"

/// The same on n rows of C-contiguous numbers: quaternions x y z w, matrices row by row. Outputs overlap no input.
/// A `step` is the distance between rows of an operand, 0 where one row serves all.
/// Those that check return the first row that is refused, n when there is none; rows from there on are then unset.
namespace polhode::arrays {

inline constexpr double kRadians = 1.0;
inline constexpr double kDegrees = 0.017453292519943295;  ///< [rad]

/// Angles times `unit` [rad]; refused: a row that is not finite.
std::size_t quat_from_euler(const EulerSequence& sequence, std::size_t n, const double* angles, double unit, double* q);
void to_euler(const EulerSequence& sequence, std::size_t n, const double* q, double unit, double* angles);
void gimbal_lock(const EulerSequence& sequence, std::size_t n, const double* q, bool* locked);

/// Refused: a matrix that quat_from_matrix would refuse.
std::size_t quat_from_matrix(std::size_t n, const double* R, double* q);
void to_matrix(std::size_t n, const double* q, double* R);

/// Refused: a row that is not finite.
std::size_t quat_from_rotation_vector(std::size_t n, const double* v, double unit, double* q);
void to_rotation_vector(std::size_t n, const double* q, double unit, double* v);
void rotation_angle(std::size_t n, const double* q, double* angle);

/// q / |q|; a q of unit norm to rounding stays as it is. Refused: |q| further than 1e-6 from 1, or not finite.
std::size_t normalize(std::size_t n, const double* q, double* unit_q);

/// Of q and -q the one with w >= 0, as polhode::canonical.
void canonical(std::size_t n, const double* q, double* canonical_q);

void conjugate(std::size_t n, const double* q, double* q_inverse);

/// The Hamilton product q_AB q_BC of any quaternions, as it is rounded.
void product(std::size_t n, const double* q_AB, std::size_t step_AB, const double* q_BC, std::size_t step_BC,
             double* q_AC);

/// q_AC = q_AB q_BC of unit quaternions, brought back to unit norm.
void multiply(std::size_t n, const double* q_AB, std::size_t step_AB, const double* q_BC, std::size_t step_BC,
              double* q_AC);

/// v_W = R_WB v_B, or v_B = R_WB^T v_W when `inverse`. Refused: a vector that is not finite.
std::size_t rotate(std::size_t n, const double* q_WB, std::size_t step_q, const double* v, std::size_t step_v,
                   bool inverse, double* rotated);

/// As the functions of one row in kinematics.hpp. Refused by euler_rates: an angle at the pole.
void body_rates(const EulerSequence& sequence, std::size_t n, const double* angles, std::size_t step_angles,
                const double* angle_rates, std::size_t step_rates, double* w_B);
std::size_t euler_rates(const EulerSequence& sequence, std::size_t n, const double* angles, std::size_t step_angles,
                        const double* w_B, std::size_t step_w, double* angle_rates);

}  // namespace polhode::arrays
