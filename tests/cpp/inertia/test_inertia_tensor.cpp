#include <doctest/doctest.h>

#include <Eigen/LU>

#include "polhode/core/error.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

using namespace polhode;

namespace {

Matrix3d make(double xx, double yy, double zz, double xy = 0, double xz = 0, double yz = 0) {
  Matrix3d m;
  m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return m;
}

double residual(const InertiaTensor& t) {
  const Matrix3d rebuilt = t.axes() * make(t.moments()[0], t.moments()[1], t.moments()[2]) * t.axes().transpose();
  return (rebuilt - t.matrix()).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a diagonal tensor has a signed permutation for axes, and its entries for moments") {
  const auto t = InertiaTensor::from_moments({2, 1, 2.5});
  CHECK(t.moments() == Vector3d(1, 2, 2.5));
  Matrix3d expected;
  expected << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // a quarter turn about z
  CHECK(t.axes() == expected);
  CHECK(t.is_diagonal());
  CHECK(t.symmetry() == Symmetry::triaxial);
  CHECK(InertiaTensor::from_moments({1, 2, 2.5}).axes() == Matrix3d::Identity());
}

TEST_CASE("principal axes rebuild the tensor, right-handed, at every scale") {
  for (const double scale : {1e-300, 1e-12, 1.0, 1e12, 1e300}) {
    const InertiaTensor t(scale * make(4, 5, 6, -0.7, 0.3, 1.1));
    CHECK(residual(t) < 2e-15 * scale * 6);
    CHECK(t.axes().determinant() == doctest::Approx(1).epsilon(1e-14));
    CHECK((t.axes().transpose() * t.axes() - Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-15);
  }
}

TEST_CASE("classes and arbitrary directions") {
  CHECK(InertiaTensor::from_moments({2, 2, 2}).principal().arbitrary() == Arbitrary::sphere);
  const auto coin = InertiaTensor::from_moments({1, 2, 1});
  CHECK(coin.symmetry() == Symmetry::oblate);
  CHECK(coin.principal().normal() == Vector3d(0, 1, 0));
  const auto rod = InertiaTensor::from_moments({0, 3, 3});
  CHECK(rod.symmetry() == Symmetry::prolate);
  CHECK(rod.axes() == Matrix3d::Identity());
  CHECK_FALSE(rod.is_positive_definite());
  CHECK_FALSE(rod.rotated(normalized({0.1, 0.2, 0.3, 0.4})).is_positive_definite());  // its 0 became rounding
  CHECK(InertiaTensor::from_moments({1e-20, 3, 3}).is_positive_definite());           // exactly as given
  CHECK(InertiaTensor(Matrix3d::Zero()).symmetry() == Symmetry::spherical);
  CHECK(InertiaTensor(make(1, 1 + 1e-9, 1.5)).principal(1e-6).arbitrary() == Arbitrary::plane);
}

TEST_CASE("a gap between moments that is as wide as the caller's counts as none, gaps of 0 included") {
  CHECK(InertiaTensor::from_moments({2, 2.5, 4}).principal(0.125).symmetry == Symmetry::oblate);
  CHECK(InertiaTensor::from_moments({2, 3.5, 4}).principal(0.125).symmetry == Symmetry::prolate);
  CHECK(InertiaTensor::from_moments({3.5, 3.75, 4}).principal(0.125).symmetry == Symmetry::spherical);
  CHECK(InertiaTensor::from_moments({1, 1, 1.5}).principal(0.0).symmetry == Symmetry::oblate);
  CHECK(InertiaTensor::from_moments({1, 1.5, 1.5}).principal(0.0).symmetry == Symmetry::prolate);
  CHECK(InertiaTensor::from_moments({2, 2, 2}).principal(0.0).symmetry == Symmetry::spherical);
  CHECK(InertiaTensor::from_moments({1, 1 + 1e-15, 1.5}).principal(0.0).symmetry == Symmetry::triaxial);
}

TEST_CASE("rotating a tensor keeps its moments and rotates its axes") {
  const InertiaTensor t(make(4, 5, 6, -0.7, 0.3, 1.1));
  const Quat q = normalized({0.3, -0.2, 0.5, 0.7});
  const InertiaTensor turned = t.rotated(q);
  CHECK((turned.moments() - t.moments()).norm() < 1e-14);
  const Vector3d u{0.2, -3, 1};
  CHECK(turned.about_axis(rotate(q, u)) == doctest::Approx(t.about_axis(u)).epsilon(1e-14));
  CHECK(t.about_axis(1e-300 * u) == doctest::Approx(t.about_axis(u)).epsilon(1e-14));
}

TEST_CASE("a tensor that no body can have is refused") {
  CHECK_THROWS_WITH_AS(InertiaTensor::from_moments({1, 2, 5}), doctest::Contains("a deficit of 40 %"), InvalidInput);
  CHECK_THROWS_WITH_AS(InertiaTensor::from_moments({1, 2, 5}), doctest::Contains("(0, 0, 1)"), InvalidInput);
  CHECK(InertiaTensor::from_moments({1, 2, 5}, false).moments() == Vector3d(1, 2, 5));
  CHECK_THROWS_AS(InertiaTensor::from_moments({-1, 2, 2}, false), InvalidInput);
  CHECK_THROWS_AS(InertiaTensor::from_moments({NAN, 2, 2}, false), InvalidInput);
  Matrix3d skew = make(1, 1, 1);
  skew(0, 1) = 2e-12;
  CHECK_THROWS_AS(InertiaTensor{skew}, InvalidInput);
  skew(0, 1) = 0.9e-12;
  CHECK(InertiaTensor(skew).matrix()(1, 0) == 0.45e-12);
  CHECK_NOTHROW(InertiaTensor::from_moments({1, 2, 3 * (1 + 1e-15)}));
  CHECK_NOTHROW(InertiaTensor::from_moments({5e307, 5e307, 1e308}));
  CHECK_THROWS_AS(InertiaTensor(make(1, 1, 1)).about_axis({0, 0, 0}), InvalidInput);
}
