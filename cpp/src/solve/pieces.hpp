#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "polhode/solve/solve.hpp"

// A span that is cut where torques begin or cease to act, each piece run by itself from where the last one ended.
namespace polhode {

/// A stretch of the span in which the same torques act; `end` is before `begin` where it is met backwards.
struct Piece {
  double begin, end;
  std::vector<AnyTorque> torques;   ///< those that act, without their windows
  PiecePlan plan = {};              ///< how it is integrated; without a method where nothing was planned
};

/// In the order in which they are run from the scene's start.
struct Pieces {
  std::vector<Piece> backward, forward;
  std::vector<double> method_switches = {};   ///< times at which it is cut besides the windows' ends
  bool whole = true;                ///< no window's end lies within the span: nothing is cut
  std::size_t size() const { return backward.size() + forward.size(); }
  std::vector<Piece*> all();              ///< backward pieces first
  std::vector<const Piece*> all() const;
};

bool has_windows(const Scene& scene);

/// @param method_switches  other times at which to cut
Pieces cut(const Scene& scene, std::vector<double> method_switches = {});

/// The scene of one piece: its torques, a start and times of its own.
Scene make_piece_scene(const Scene& scene, const Piece& piece, const State& start, std::vector<double> times,
                       const Wanted& want);

/// The same scene without windows, where none ends within the span: each torque acts all the time or not at all.
Scene drop_windows(const Scene& scene);

/// Whether anybody wants the attitude, or any piece's torques see it: then all pieces carry it.
bool carries_attitude(const Scene& scene, const Pieces& pieces, const SolveOptions& options);

/// "from t = 10 to 20 s"
std::string describe_span(const Piece& piece);

}  // namespace polhode
