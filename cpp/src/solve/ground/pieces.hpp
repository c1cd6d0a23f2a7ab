#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/solve.hpp"

// A span that is cut where torques or rotors start or stop. Each piece is integrated from the end of the last.
namespace polhode {

/// A part of the span with a fixed set of torques and rotors. `end` is before `begin` in a backward run.
struct Piece {
  double begin, end;
  std::vector<AnyTorque> torques;   ///< those that act, without their windows
  std::vector<Rotor> rotors;        ///< those that rotate, without their windows
  /// The inertia that the piece's scene is given, where it is not that of the whole scene.
  std::optional<InertiaTensor> inertia_B = {};
  BodyPiece body = {};              ///< of a body that changes
  bool changes = false;             ///< the body changes within the piece: its torques say how
  std::vector<std::string> names = {};   ///< of the scene's torques that act, where the body changes
  std::vector<std::size_t> numbers = {};   ///< of the scene's torques, in the order of those of the piece
  bool keeps_damper = true;         ///< else the damper stands in the torques
  PiecePlan plan = {};              ///< its model and method; no method before planning
  const ClosedFormRecord* form = nullptr;   ///< what runs it: a closed form, or the plan's method where it is null
};

/// The pieces, in the order of the run from the scene's start.
struct Pieces {
  std::vector<Piece> backward, forward;
  std::vector<double> method_switches = {};   ///< further cuts, besides the ends of windows
  bool whole = true;                ///< no end of a window lies within the span, so nothing is cut
  std::size_t size() const { return backward.size() + forward.size(); }
  std::vector<Piece*> all();              ///< backward pieces first
  std::vector<const Piece*> all() const;
};

/// True if a torque or a rotor has windows, a torque of the user's own has breaks, or the body changes.
bool has_windows(const Scene& scene);
/// The scene whose own torques of the user have these breaks as well.
Scene add_breaks(const Scene& scene, const std::vector<double>& times);
bool has_rotor_windows(const Scene& scene);

/// The change of omega where the momentum of the rotors jumps by dh: -J^-1 dh, because J w + h is continuous.
Vector3d compute_rate_jump(const InertiaTensor& J_B, const Vector3d& dh_B);

/// How omega and the angular momentum in body axes are related at a time, H = J w + h, without momenta that are states.
struct Momentum {
  Matrix3d J;   ///< which moves with omega
  Vector3d h;
  friend bool operator==(const Momentum&, const Momentum&) = default;
};
Momentum find_momentum(const Scene& scene, double t);                       ///< in the piece that holds from t on
Momentum find_momentum(const Scene& scene, const Piece& piece, double t);   ///< in a piece, at one of its ends

/// The change of omega where these jump: J w + h is continuous, or w and h are where matter leaves.
Vector3d compute_rate_jump(const Scene& scene, const Vector3d& omega, const Momentum& before, const Momentum& after);
/// The same for a small change of omega alone: what it becomes.
Vector3d carry_rates(const Scene& scene, const Vector3d& d_omega, const Momentum& before, const Momentum& after);

/// @param method_switches  further times at which to cut
Pieces cut(const Scene& scene, std::vector<double> method_switches = {});

/// The scene of one piece, with its own torques, start and times.
Scene make_piece_scene(const Scene& scene, const Piece& piece, const State& start, std::vector<double> times,
                       const Wanted& want);

/// The same scene without windows. No window may begin or end within the span, so each torque acts always or never.
Scene drop_windows(const Scene& scene);

/// True if all pieces must integrate the attitude: it is requested, or a torque or an event depends on it.
bool carries_attitude(const Scene& scene, const Pieces& pieces, const SolveOptions& options);

/// "from t = 10 to 20 s"
std::string describe_span(const Piece& piece);

}  // namespace polhode
