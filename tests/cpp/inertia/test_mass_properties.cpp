#include <doctest/doctest.h>

#include "polhode/core/error.hpp"
#include "polhode/inertia/shapes.hpp"

using namespace polhode;

TEST_CASE("the block of the homework, at its centre and at the centre of a face") {
  const double M = 3, a = 1, b = 2, c = 4;
  const MassProperties block = shapes::box(M, {a, b, c});
  CHECK(block.inertia().matrix().diagonal() == Vector3d(b * b + c * c, a * a + c * c, a * a + b * b));
  const InertiaTensor at_face = block.about({0, 0, c});
  CHECK(at_face.matrix().diagonal() == Vector3d(b * b + 4 * c * c, a * a + 4 * c * c, a * a + b * b));
  CHECK(at_face.is_diagonal());
}

TEST_CASE("adding, taking away, moving") {
  const MassProperties cone = shapes::cone(2, 1, 3);
  CHECK(cone.com() == Vector3d(0, 0, 0.75));
  const Quat q_AB = normalized({0.1, 0.5, -0.3, 0.8});
  const MassProperties moved = shapes::box(5, {1, 2, 3}).moved(q_AB, {1, -2, 0.5});
  const MassProperties both = cone + moved;
  CHECK(both.mass() == 7);
  const MassProperties back = both - moved;
  CHECK((back.com() - cone.com()).norm() < 1e-14);
  CHECK((back.inertia().matrix() - cone.inertia().matrix()).norm() < 1e-13);
  CHECK_THROWS_AS(cone - moved, InvalidInput);
}

TEST_CASE("a tensor about another point") {
  const MassProperties body = shapes::box(6, {1, 2, 3}).moved({0.5, 0.5, 0.5, 0.5}, {4, -5, 6});
  const MassProperties back = MassProperties::from_tensor(6, body.com(), body.about({1, 2, 3}), {1, 2, 3});
  CHECK((back.inertia().matrix() - body.inertia().matrix()).norm() < 1e-12);
  CHECK_THROWS_AS(MassProperties::from_tensor(6, body.com(), body.inertia()), InvalidInput);
}

TEST_CASE("points: a dumbbell far away") {
  const double masses[] = {1, 3};
  const double positions[] = {1e6, 0, 1, 1e6, 0, 5};
  const MassProperties body = MassProperties::from_points(masses, positions, 2);
  CHECK(body.com() == Vector3d(1e6, 0, 4));
  CHECK(body.inertia().moments() == Vector3d(0, 12, 12));
  CHECK_THROWS_AS(MassProperties::from_points(masses, positions, 0), InvalidInput);
}

TEST_CASE("every record makes its shape from plain numbers") {
  CHECK(shapes::all().size() == 18);
  const double box[] = {6, 1, 2, 3};
  CHECK(shapes::find("box").make(box) == shapes::box(6, {1, 2, 3}));
  const double prism[] = {6, 0, 0, 1, 0, 0, 1, 3};
  const shapes::Triangle corners{{{0, 0}, {1, 0}, {0, 1}}};
  CHECK(shapes::find("triangular_prism").make(prism) == shapes::triangular_prism(6, corners, 3));
  for (const shapes::Record& record : shapes::all()) {
    CHECK(record.parameters.front().name == "mass");
    CHECK_FALSE(record.doc.empty());
  }
  CHECK_THROWS_WITH_AS(shapes::find("bx"), doctest::Contains("one of box, sphere"), InvalidInput);
}
