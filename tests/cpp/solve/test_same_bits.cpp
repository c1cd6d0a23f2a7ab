#include <doctest/doctest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/heavy_top.hpp"
#include "polhode/batch/solve_many.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/method/methods.hpp"
#include "polhode/solve/solve.hpp"

// The same answers, bit for bit, by every compiler and on every processor. `make same-bits` compares far more answers
// of the Python module; these are for machines that have only the C++ library, such as an emulated AArch64.

namespace polhode {
namespace {

/// FNV-1a, 64 bits.
class Hash {
 public:
  void add(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    for (int i = 0; i < 64; i += 8) value_ = (value_ ^ ((bits >> i) & 0xff)) * 0x100000001b3u;
  }
  void add(const State& s) {
    for (int i = 0; i < 3; ++i) add(s.omega[i]);
    for (const double x : {s.attitude.x, s.attitude.y, s.attitude.z, s.attitude.w}) add(x);
  }
  void add(const std::vector<double>& values) {
    for (const double x : values) add(x);
  }
  std::string text() const {
    std::ostringstream out;
    out << std::hex << value_;
    return out.str();
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// Numbers in [0, 1) of exact arithmetic: a congruential generator's upper 32 bits.
class Draw {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 32) / 4294967296.0;
  }

 private:
  std::uint64_t state_ = 7;
};

struct Bodies {
  std::vector<double> moments, omega, attitude, times;
};

Bodies draw_bodies(std::size_t n) {
  Draw draw;
  Bodies bodies;
  for (std::size_t i = 0; i < n; ++i) {
    double square[3], sum = 0.0;
    for (double& s : square) {
      const double side = 0.1 + 0.9 * draw();
      sum += s = side * side;
    }
    for (const double s : square) bodies.moments.push_back(sum - s);
    for (int k = 0; k < 3; ++k) bodies.omega.push_back(12.0 * draw() - 6.0);
    for (const double x : {0.5, -0.5, 0.5, 0.5}) bodies.attitude.push_back(x);
    bodies.times.push_back(2000.0 * draw() - 500.0);
  }
  return bodies;
}

Scene make_scene(const std::string& kind) {
  SceneParts parts{.inertia_B = InertiaTensor::from_moments({1.0, 1.5, 2.25}), .omega = {0.25, 3.0, -0.5},
                   .attitude = {0.5, -0.5, 0.5, 0.5}, .times = {0.5, 1.25, 4.0}};
  if (kind == "heavy") parts.torques.push_back(torques::Gravity(2.0, {0.25, 0.125, 0.5}));
  if (kind == "damped") parts.torques.push_back(torques::Damping(Matrix3d(Vector3d{0.125, 0.25, 0.0625}.asDiagonal())));
  if (kind == "pushed") parts.torques.push_back(torques::Constant({0.5, -0.25, 0.125}, torques::Constant::Frame::space));
  return Scene(std::move(parts));
}

std::map<std::string, std::string> compute_hashes() {
  std::map<std::string, std::string> hashes;
  const double starts[][6] = {{1, 2, 2.5, 3, 0.5, 0.25}, {1, 2, 2.5, 0.5, 0.25, 3}, {0.2, 0.4, 0.52, 1e-4, 5, 1e-4},
                              {1, 1, 1.5, 1, 2, 3}, {2, 2, 2, 1, 2, 3}, {1e-6, 1, 1.0000001, 1, 2, 3}};
  Hash free, full, top;
  for (const auto& s : starts) {
    const Vector3d omega{s[3], s[4], s[5]};
    const FreeMotion motion(InertiaTensor::from_moments({s[0], s[1], s[2]}), omega, {0.5, -0.5, 0.5, 0.5});
    const FreeMotion tilted(InertiaTensor::from_moments({s[0], s[1], s[2]}).rotated({0.1, 0.7, -0.1, 0.7}), omega);
    for (const double t : {0.0, 0.1, -3.0, 17.5, 1e3, -1e6}) {
      free.add(motion.at(t));
      full.add(tilted.at(t));
    }
  }
  for (const double spin : {0.1, 6.0, 400.0}) {
    const HeavyTop motion({1, 1, 0.5}, 2.0, {0.3, -0.2, spin}, {0.5, -0.5, 0.5, 0.5});
    for (const double t : {0.1, -3.0, 17.5, 1e3}) top.add(motion.at(t));
  }
  hashes["free bodies"] = free.text();
  hashes["free bodies, full tensors"] = full.text();
  hashes["tops"] = top.text();

  constexpr std::size_t n = 501;
  const Bodies bodies = draw_bodies(n);
  std::vector<double> grid(n), omega(7 * n * 3), attitude(7 * n * 4);
  for (std::size_t i = 0; i < n; ++i) grid[i] = 0.125 * static_cast<double>(i);
  Hash any_times, uniform, own;
  free_motion({.bodies = 7, .times = n, .moments = bodies.moments.data(), .omega = bodies.omega.data(),
               .attitude = bodies.attitude.data(), .t = bodies.times.data()}, omega.data(), attitude.data());
  any_times.add(omega), any_times.add(attitude);
  free_motion({.bodies = 7, .times = n, .moments = bodies.moments.data(), .omega = bodies.omega.data(),
               .attitude = bodies.attitude.data(), .t = grid.data()}, omega.data(), attitude.data());
  uniform.add(omega), uniform.add(attitude);
  omega.assign(n * 3, 0.0), attitude.assign(n * 4, 0.0);
  free_motion({.bodies = n, .times = 1, .moments = bodies.moments.data(), .omega = bodies.omega.data(),
               .attitude = bodies.attitude.data(), .t = bodies.times.data(), .own_times = true},
              omega.data(), attitude.data());
  own.add(omega), own.add(attitude);
  hashes["batch of free bodies, any times"] = any_times.text();
  hashes["batch of free bodies, grid"] = uniform.text();
  hashes["batch of free bodies, own times"] = own.text();

  for (const char* kind : {"free", "heavy", "damped", "pushed"}) {
    const Scene scene = make_scene(kind);
    for (const ode::MethodRecord& method : methods()) {
      SolveOptions options;
      options.method = std::string(method.name);
      if (method.adaptive) options.rtol = 1e-9;
      else options.step = 0.015625;
      Hash hash;
      try {
        const Motion motion = solve(scene, options);
        hash.add(motion.omega), hash.add(motion.attitude);
      } catch (const InvalidInput&) {
        continue;   // a method that does not take this scene
      }
      hashes[std::string(kind) + ", " + std::string(method.name)] = hash.text();
    }
    SolveOptions options;
    options.accuracy = 1e-9;
    const Motion motion = solve(scene, options);
    Hash hash;
    hash.add(motion.omega), hash.add(motion.attitude), hash.add(motion.error);
    hashes[std::string(kind) + ", accuracy 1e-9"] = hash.text();
  }
  return hashes;
}

}  // namespace

TEST_CASE("answers have the same bits by every compiler and on every processor") {
  const std::string level = simd_level() == SimdLevel::baseline ? "baseline" : "wide";
  const std::string path = POLHODE_REFERENCE "/same_bits_cpp.txt";
  std::map<std::string, std::string> stored;   // "level: answer" to hash
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (const auto at = line.rfind(' '); at != std::string::npos) stored[line.substr(0, at)] = line.substr(at + 1);
  const auto hashes = compute_hashes();
  if (std::getenv("POLHODE_WRITE_BITS")) {
    for (const auto& [name, hash] : hashes) stored[level + ": " + name] = hash;
    std::ofstream out(path);
    for (const auto& [name, hash] : stored) out << name << ' ' << hash << '\n';
    return;
  }
  for (const auto& entry : hashes) {
    const std::string name = level + ": " + entry.first;
    CHECK_MESSAGE(stored[name] == entry.second, name);
  }
  CHECK(hashes.size() >= 60);
}

}  // namespace polhode
