#include <cstddef>
#include <optional>
#include <vector>

#include "polhode/exact/free_motion.hpp"

// The free body, for a page. Arrays lie in the module's memory: `reserve` gives a place for n numbers.
#define POLHODE_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {
std::vector<double> room;
std::optional<polhode::FreeMotion> motion;
}  // namespace

/// A place for n numbers; the one before is no longer valid.
POLHODE_EXPORT(reserve) double* reserve(int n) {
  room.resize(static_cast<std::size_t>(n));
  return room.data();
}

/// The body: moments (3), omega (3), attitude (4).
POLHODE_EXPORT(set_body) void set_body(const double* start) {
  motion.emplace(polhode::Vector3d(start[0], start[1], start[2]), polhode::Vector3d(start[3], start[4], start[5]),
                 polhode::Quat{start[6], start[7], start[8], start[9]});
}

/// omega (n, 3) in the body and attitude (n, 4), (x, y, z, w), at n times.
POLHODE_EXPORT(states) void states(const double* t, int n, double* omega, double* attitude) {
  motion->at(t, static_cast<std::size_t>(n), omega, attitude);
}

POLHODE_EXPORT(period) double period() { return motion->period(); }
POLHODE_EXPORT(energy) double energy() { return motion->energy(); }
POLHODE_EXPORT(kind) int kind() { return static_cast<int>(motion->kind()); }
POLHODE_EXPORT(precession_rate) double precession_rate() { return motion->precession_rate(); }

/// The angular momentum in space (3).
POLHODE_EXPORT(angular_momentum) void angular_momentum(double* L) {
  const polhode::Vector3d v = motion->angular_momentum();
  L[0] = v[0], L[1] = v[1], L[2] = v[2];
}

/// The number of flips from `begin` to `end`; the first `most` of their times.
POLHODE_EXPORT(flips) int flips(double begin, double end, double* times, int most) {
  const std::vector<double> found = motion->flip_times(begin, end);
  for (std::size_t i = 0; i < found.size() && i < static_cast<std::size_t>(most); ++i) times[i] = found[i];
  return static_cast<int>(found.size());
}
