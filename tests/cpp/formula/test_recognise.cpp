#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <string>

#include "polhode/formula/facts.hpp"
#include "polhode/formula/modes.hpp"
#include "polhode/formula/parser.hpp"
#include "polhode/formula/recognise.hpp"

using namespace polhode;
using namespace polhode::formula;
using Kind = KnownTorque::Kind;

namespace {

Matrix3d inertia() {
  Matrix3d I;
  I << 2.0, 0.25, -0.125, 0.25, 3.0, 0.5, -0.125, 0.5, 4.0;
  return I;
}

Program parse_torque(const std::string& torque) { return parse({torque, {}, {}, {}, {}}); }
Recognition find(const std::string& torque) { return recognise(parse_torque(torque), inertia()); }

void check_vector(const Vector3d& found, const Vector3d& truth) {
  CHECK((found - truth).norm() <= 1e-15 * truth.norm());
}

}  // namespace

TEST_CASE("formula: a formula that is gravity in disguise is found") {
  for (const std::string text :
       {"-2 * cross([0.3, 0.2, 0.5], to_body([0, 0, 1]))",
        "2 * cross([2 * (attitude.x * attitude.z - attitude.w * attitude.y), 2 * (attitude.y * attitude.z + "
        "attitude.w * attitude.x), 1 - 2 * (attitude.x^2 + attitude.y^2)], [0.3, 0.2, 0.5])",
        "dot(attitude, attitude) * cross(to_body([0, 0, 2]), [0.3, 0.2, 0.5])"}) {
    const Recognition found = find(text);
    REQUIRE(found.parts.size() == 1);
    CHECK(found.is_whole);
    CHECK(found.parts[0].kind == Kind::gravity);
    check_vector(found.parts[0].vector, {0.6, 0.4, 1.0});
  }
}

TEST_CASE("formula: built-in torques are found in sums") {
  const Recognition found =
      find("[0.1, 0.2, 0.3] - [0.5, 0.5, 0.4] * omega + to_body([1, 2, 0.5]) - "
           "cross([0.6, 0.4, 1], to_body([0, 0, 1]))");
  CHECK(found.is_whole);
  REQUIRE(found.parts.size() == 4);
  CHECK(found.parts[0].kind == Kind::damping);
  check_vector(found.parts[0].matrix.diagonal(), {0.5, 0.5, 0.4});
  CHECK(found.parts[1].kind == Kind::constant_in_body);
  check_vector(found.parts[1].vector, {0.1, 0.2, 0.3});
  CHECK(found.parts[2].kind == Kind::constant_in_space);
  check_vector(found.parts[2].vector, {1.0, 2.0, 0.5});
  CHECK(found.parts[3].kind == Kind::gravity);
  check_vector(found.parts[3].vector, {0.6, 0.4, 1.0});

  const Recognition rotors = find("cross(omega, [0.1, -0.2, 0.3])");
  CHECK(rotors.is_whole);
  REQUIRE(rotors.parts.size() == 1);
  CHECK(rotors.parts[0].kind == Kind::rotors);
  check_vector(rotors.parts[0].vector, {-0.1, 0.2, -0.3});

  const Recognition angular = find("-0.3 * [2 * omega.x + 0.25 * omega.y - 0.125 * omega.z, 0.25 * omega.x + 3 * "
                                   "omega.y + 0.5 * omega.z, -0.125 * omega.x + 0.5 * omega.y + 4 * omega.z]");
  REQUIRE(angular.parts.size() == 1);
  CHECK(angular.parts[0].kind == Kind::angular_damping);
  CHECK(angular.parts[0].rate == doctest::Approx(0.3).epsilon(1e-15));
  CHECK(angular.is_whole);
}

TEST_CASE("formula: the gravity gradient is found with its rate and phase") {
  Text text{"3 * 0.001^2 * cross(u, h) - 0.5 * omega", {}, {}, {},
            {{"u", "to_body([cos(0.001 * t + 0.25), sin(0.001 * t + 0.25), 0])"},
             {"h", "[2 * u.x + 0.25 * u.y - 0.125 * u.z, 0.25 * u.x + 3 * u.y + 0.5 * u.z, -0.125 * u.x + "
                   "0.5 * u.y + 4 * u.z]"}}};
  const Recognition found = recognise(parse(text), inertia());
  CHECK(found.is_whole);
  REQUIRE(found.parts.size() == 2);
  CHECK(found.parts[0].kind == Kind::gravity_gradient);
  CHECK(found.parts[0].rate == 0.001);
  CHECK(found.parts[0].phase == 0.25);
  CHECK(found.parts[1].kind == Kind::damping);
  text.torque = "3.1 * 0.001^2 * cross(u, h)";   // another strength
  CHECK_FALSE(recognise(parse(text), inertia()).is_whole);
}

TEST_CASE("formula: what vanishes identically is found, and what does not is not") {
  const Recognition zero = find("omega * (dot(attitude, attitude) - 1)");
  CHECK(zero.is_whole);
  CHECK(zero.parts.empty());
  CHECK(find("to_space(to_body([1, 2, 3])) - [1, 2, 3]").is_whole);
  CHECK_FALSE(find("omega * (dot(attitude, attitude) - 1.0000001)").parts.empty());
  for (const std::string other : {"tanh(omega)", "norm(omega) * omega", "omega * omega * omega", "attitude.xyz",
                                  "-cross([0.6, 0.4, 1], to_body([1, 0, 0]))", "where(omega.x > 0, omega, -omega)"})
    CHECK_FALSE(find(other).is_whole);
}

TEST_CASE("formula: known parts are split off and the rest stays, with the same sum") {
  const Program torque = parse_torque("-0.5 * omega + 0.1 * omega * norm(omega, 1) + omega * omega * omega.z + "
                                      "cross(to_body([0, 0, 1]), [0.6, 0.4, 1])");
  const Recognition found = recognise(torque, inertia());
  CHECK_FALSE(found.is_whole);
  REQUIRE(found.parts.size() == 2);
  CHECK(found.parts[0].kind == Kind::damping);
  CHECK(found.parts[1].kind == Kind::gravity);
  CHECK(find_facts(found.rest).uses_rates);
  CHECK_FALSE(find_facts(found.rest).uses_attitude);
  const double y[7] = {0.3, -0.2, 0.5, 0.1, 0.5, 0.7, 0.5};
  double whole[3], rest[3];
  Evaluator evaluate(torque), evaluate_rest(found.rest);
  evaluate(0.0, y, nullptr, whole), evaluate_rest(0.0, y, nullptr, rest);
  const Vector3d omega(y[0], y[1], y[2]);
  const Vector3d up = rotate({-y[3], -y[4], -y[5], y[6]}, {0, 0, 1});
  const Vector3d sum = Vector3d(rest) - found.parts[0].matrix * omega - found.parts[1].vector.cross(up);
  CHECK((sum - Vector3d(whole)).norm() <= 1e-15);
}

TEST_CASE("formula: facts by structure") {
  const Facts damping = find_facts(parse_torque("-[0.5, 0.5, 0.4] * omega"));
  CHECK(damping.uses_rates);
  CHECK_FALSE((damping.uses_time || damping.uses_attitude || damping.uses_states || damping.has_switches));
  CHECK(damping.degree == 1);
  CHECK(damping.is_linear_in_rates());
  const Facts mixed = find_facts(parse_torque("to_body([cos(t), 0, 1]) * omega + norm(attitude) * omega"));
  CHECK((mixed.uses_time && mixed.uses_attitude && mixed.uses_rates));
  CHECK(mixed.degree == -1);
  CHECK(mixed.rate_degree == 1);
  CHECK(find_facts(parse_torque("to_body([0, 0, 1]) * omega * omega")).degree == 4);
  CHECK(find_facts(parse_torque("abs(omega)")).has_switches);
  CHECK_FALSE(find_facts(parse_torque("omega - omega + [t, 0, 0] * (omega.x - omega.x)")).uses_time);
}

TEST_CASE("formula: modes replace switches by their branches, with guards after the outputs") {
  const Program program = parse_torque("clip(-omega, -0.5, 0.5)");
  const double y[7] = {0.25, 2.0, -3.0, 0.0, 0.0, 0.0, 1.0};
  const Mode mode = find_mode(program, 0.0, y);
  CHECK(mode.size() == 6);
  const Program smooth = in_mode(program, mode, true);
  CHECK(list_switches(smooth).empty());
  REQUIRE(smooth.outputs.size() == 9);
  double found[9], truth[3];
  Evaluator evaluate(program), evaluate_smooth(smooth);
  evaluate(0.0, y, nullptr, truth), evaluate_smooth(0.0, y, nullptr, found);
  for (int i = 0; i < 3; ++i) CHECK(found[i] == truth[i]);
  CHECK(truth[0] == -0.25);
  CHECK(truth[1] == -0.5);
  CHECK(truth[2] == 0.5);
  for (std::size_t i = 0; i < 6; ++i) CHECK((found[3 + i] > 0.0) == mode[i]);
  // The branch goes on beyond the surface.
  const double beyond[7] = {5.0, 2.0, -3.0, 0.0, 0.0, 0.0, 1.0};
  evaluate_smooth(0.0, beyond, nullptr, found);
  CHECK(found[0] == -5.0);
}
