#include "polhode/batch/solve_many.hpp"
#include "polhode/method/methods.hpp"
#include "polhode/solve/plan.hpp"
#include "polhode/solve/solve.hpp"

#include <cmath>

#include "input.hpp"

// Scenes of any numbers, torques, windows and options: refused, or planned and solved. A success is finite, within
// max_steps, and has the bits that solve_many gives.

namespace polhode::fuzz {
namespace {

LastingTorque lasting(Input& input) {
  switch (input.below(4)) {
    case 0:
      return torques::Constant(input.vector(), input.coin() ? torques::Constant::Frame::space
                                                            : torques::Constant::Frame::body);
    case 1: {
      const double weight = input.number();
      return torques::Gravity(weight, input.vector());
    }
    case 2: {
      const double rate = input.number();
      return torques::GravityGradient(rate, input.number());
    }
    default: {
      Matrix3d matrix = input.vector().asDiagonal();
      if (input.coin()) matrix(0, 1) = input.number();
      return torques::Damping(matrix);
    }
  }
}

AnyTorque torque(Input& input) {
  const LastingTorque one = lasting(input);
  const std::size_t count = input.below(6);
  if (count >= 3 || count == 0) return std::visit([](const auto& kind) { return AnyTorque(kind); }, one);
  std::vector<torques::Window> windows;
  for (std::size_t i = 0; i < count; ++i) {
    const double begin = input.number();
    windows.push_back({begin, begin + std::abs(input.number())});
  }
  return torques::During(one, windows);
}

Scene scene(Input& input) {
  const bool ordinary = input.coin();
  Vector3d moments;
  for (int k = 0; k < 3; ++k) moments[k] = ordinary ? 1.0 + 0.9 * input.fraction() : input.number();
  SceneParts parts{.inertia_B = InertiaTensor::from_moments(moments)};
  parts.omega = input.vector();
  parts.attitude = input.attitude();
  for (std::size_t count = input.below(4); count > 0; --count) parts.torques.push_back(torque(input));
  parts.times = input.numbers(input.below(9));
  parts.want.omega = input.below(8) != 0;
  parts.want.attitude = input.below(8) != 0;
  if (input.below(4) == 0) parts.t0 = input.number();
  return Scene(std::move(parts));
}

SolveOptions options(Input& input) {
  SolveOptions options;
  options.max_steps = 400;
  options.certify = input.below(4) != 0;
  options.proof = input.below(16) == 0;
  options.dense = input.below(4) == 0;
  switch (input.below(4)) {
    case 0: options.accuracy = input.number(); break;
    case 1: options.accuracy = std::pow(10.0, -12.0 * input.fraction()); break;
    case 2: options.rtol = std::pow(10.0, -12.0 * input.fraction()); break;
    default: break;
  }
  if (input.below(3) == 0) {
    const auto all = methods();
    options.method = std::string(all[input.below(all.size())].name);
  }
  if (input.below(4) == 0) options.step = input.number();
  return options;
}

void try_scene(Input& input) {
  const Scene given = scene(input);
  const SolveOptions how = options(input);
  is_done([&] { explain_plan(given, how); });
  Motion motion;
  if (!is_done([&] { motion = solve(given, how); })) return;
  if (motion.status == Status::finished && succeeded(given, motion)) require(motion.all_finite(), "success is finite");
  if (how.dense) is_done([&] { motion.at(input.number()); });
  if (how.dense || how.proof) return;
  const std::size_t n = given.times().size();
  std::vector<double> w(6 * n), q(8 * n);
  std::vector<ManyResult> many;
  const bool done = is_done([&] {
    many = solve_many(2, n, [&](std::size_t) { return given; }, how, given.want().omega ? w.data() : nullptr,
                      given.want().attitude ? q.data() : nullptr);
  });
  if (!done || many[1].lanes || motion.status != Status::finished) return;   // Taylor's lanes have bits of their own
  require(is_same(motion.omega.data(), w.data() + 3 * n, motion.omega.size()), "solve_many has the bits of solve");
  require(is_same(motion.attitude.data(), q.data() + 4 * n, motion.attitude.size()), "the same for attitudes");
}

}  // namespace
}  // namespace polhode::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  polhode::fuzz::Input input(data, size);
  polhode::fuzz::is_done([&] { polhode::fuzz::try_scene(input); });
  return 0;
}
