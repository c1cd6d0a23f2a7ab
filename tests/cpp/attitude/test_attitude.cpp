#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "polhode/attitude/detail/arrays.hpp"
#include "polhode/attitude/euler.hpp"
#include "polhode/attitude/kinematics.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/attitude/matrix.hpp"
#include "polhode/attitude/rotation_vector.hpp"
#include "polhode/core/error.hpp"

using namespace polhode;
using std::numbers::pi;

namespace {

std::vector<EulerSequence> all_sequences() {
  std::vector<EulerSequence> all;
  for (const std::string axes : {"XYZ", "xyz"})
    for (const char a : axes)
      for (const char b : axes)
        for (const char c : axes)
          if (a != b && b != c) all.emplace_back(std::string{a, b, c});
  return all;
}

Matrix3d elementary(int axis, double angle) {
  Matrix3d R = Matrix3d::Identity();
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  R(i, i) = R(j, j) = std::cos(angle);
  R(i, j) = -std::sin(angle);
  R(j, i) = std::sin(angle);
  return R;
}

/// The product of the three matrices, as the letters say.
Matrix3d euler_matrix(const EulerSequence& sequence, const Vector3d& angles) {
  const std::string letters = sequence.letters();
  Matrix3d R = Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const char letter = letters[static_cast<std::size_t>(i)];
    const Matrix3d turn = elementary(letter >= 'x' ? letter - 'x' : letter - 'X', angles[i]);
    R = letter >= 'x' ? Matrix3d(turn * R) : Matrix3d(R * turn);
  }
  return R;
}

double distance(const Matrix3d& a, const Matrix3d& b) { return (a - b).cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("attitude: 24 sequences, each with its letters") {
  const auto all = all_sequences();
  CHECK(all.size() == 24);
  CHECK(EulerSequence("ZXZ").letters() == "ZXZ");
  CHECK(EulerSequence("xyz").letters() == "xyz");
  for (const char* bad : {"", "Z", "ZX", "ZXZX", "ZZX", "XZZ", "zXz", "ABC", "123", "zx "}) {
    CHECK_THROWS_AS(EulerSequence{bad}, InvalidInput);
  }
}

TEST_CASE("attitude: Euler angles are the product of three turns, both ways") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-pi, pi);
  for (const EulerSequence& sequence : all_sequences()) {
    for (int i = 0; i < 200; ++i) {
      const Vector3d angles(angle(random), angle(random), angle(random));
      const Matrix3d R_WB = euler_matrix(sequence, angles);
      const Quat q_WB = quat_from_euler(sequence, angles);
      CHECK(distance(to_matrix(q_WB), R_WB) < 4e-15);
      CHECK(distance(to_matrix(quat_from_matrix(R_WB)), R_WB) < 4e-15);
      const Vector3d back = to_euler(sequence, q_WB);
      CHECK(distance(euler_matrix(sequence, back), R_WB) < 4e-15);
      CHECK(std::abs(back[1] - (sequence.proper() ? pi / 2 : 0.0)) <= pi / 2);
    }
  }
}

TEST_CASE("attitude: at the pole the matrix is right, the third angle 0, and the flag up") {
  for (const EulerSequence& sequence : all_sequences()) {
    for (const double pole : {sequence.proper() ? 0.0 : -pi / 2, sequence.proper() ? pi : pi / 2}) {
      const Vector3d angles(0.7, pole, -1.9);
      const Quat q_WB = quat_from_euler(sequence, angles);
      CHECK(gimbal_lock(sequence, q_WB));
      const Vector3d back = to_euler(sequence, q_WB);
      CHECK(back[1] == pole);
      CHECK(back[2] == 0.0);
      CHECK(distance(euler_matrix(sequence, back), euler_matrix(sequence, angles)) < 2e-15);
      CHECK_THROWS_AS(euler_rates(sequence, angles, {1, 2, 3}), InvalidInput);
    }
  }
}

TEST_CASE("attitude: rates are the derivative of the attitude, and invert") {
  const Vector3d angles(0.4, 1.1, -0.8), rates(0.3, -0.5, 0.9);
  const double h = 1e-5;
  for (const EulerSequence& sequence : all_sequences()) {
    const Matrix3d R = euler_matrix(sequence, angles);
    const Matrix3d dR =
        (euler_matrix(sequence, angles + h * rates) - euler_matrix(sequence, angles - h * rates)) / (2 * h);
    const Matrix3d W = R.transpose() * dR;  // the cross-product matrix of w_B
    const Vector3d w_B = body_rates(sequence, angles, rates);
    CHECK((w_B - Vector3d(W(2, 1), W(0, 2), W(1, 0))).norm() < 1e-9);
    CHECK((euler_rates(sequence, angles, w_B) - rates).norm() < 1e-14);
  }
}

TEST_CASE("attitude: rotation vectors at both ends") {
  for (const double size : {1e-300, 1e-160, 1e-9, 9.9e-3, 1.01e-2, 1.0, 3.0}) {
    const Vector3d v = size * Vector3d(0.48, -0.6, 0.64);
    const Quat q = quat_from_rotation_vector(v);
    CHECK((to_rotation_vector(q) - v).cwiseAbs().maxCoeff() <= 1e-15 * size);
    CHECK(rotation_angle(q) == doctest::Approx(size).epsilon(1e-15));
  }
  CHECK((to_rotation_vector({-0.6, 0.8, 0, 0}) - pi * Vector3d(0.6, -0.8, 0)).norm() < 1e-15);
  CHECK(canonical({0, -1, 0, 0}) == Quat{0, 1, 0, 0});
}

TEST_CASE("attitude: what is no rotation is refused") {
  const Matrix3d one = Matrix3d::Identity();
  Matrix3d mirror = one, sheared = one, nan = one;
  mirror(2, 2) = -1;
  sheared(0, 1) = 1e-5;
  nan(1, 1) = NAN;
  for (const Matrix3d& bad : {mirror, sheared, nan, Matrix3d(1.01 * one), Matrix3d(Matrix3d::Zero())}) {
    CHECK_THROWS_AS(quat_from_matrix(bad), InvalidInput);
  }
}

TEST_CASE("attitude: the array of sines and cosines is that of single numbers, also for large angles") {
  // A rotation about one axis shows the sine and cosine of the half angle.
  const EulerSequence sequence("ZXZ");
  std::vector<double> angles;
  for (double x = 1e-300; x < 1e300; x *= 1.37) angles.insert(angles.end(), {x, 0, 0, -x, 0, 0});
  for (int i = -40; i <= 40; ++i) angles.insert(angles.end(), {i * pi / 2, 0, 0});
  const std::size_t n = angles.size() / 3;
  std::vector<double> q(4 * n);
  CHECK(arrays::quat_from_euler(sequence, n, angles.data(), 1.0, q.data()) == n);
  for (std::size_t i = 0; i < n; ++i) {
    const double half = 0.5 * angles[3 * i];
    // 0.8 ulp of the arrays' loop and 0.52 of the functions are 2.9e-16 at most: a bound, not a measurement.
    CHECK(std::abs(q[4 * i + 2] - math::sin(half)) <= 3e-16 * std::abs(math::sin(half)));
    CHECK(std::abs(q[4 * i + 3] - math::cos(half)) <= 3e-16 * std::abs(math::cos(half)));
  }
  angles[3 * (n - 1)] = NAN;
  CHECK(arrays::quat_from_euler(sequence, n, angles.data(), 1.0, q.data()) == n - 1);
}
