#include "solve/ground/pieces.hpp"

#include <algorithm>
#include <utility>

#include "polhode/core/error.hpp"
#include "solve/ground/body_piece.hpp"

namespace polhode {
namespace {

using torques::During;

const During* find_windows(const AnyTorque& torque) {
  const auto* during = std::get_if<During>(&torque);
  return during != nullptr && !during->traits().vanishes ? during : nullptr;
}

AnyTorque drop_window(const AnyTorque& torque) {
  const auto* during = std::get_if<During>(&torque);
  if (during == nullptr) return torque;
  return std::visit([](const auto& lasting) { return AnyTorque(lasting); }, during->torque());
}

/// The user's own torque behind one with windows or none.
const torques::Custom* find_custom(const AnyTorque& torque) {
  const auto* during = std::get_if<During>(&torque);
  return during != nullptr ? std::get_if<torques::Custom>(&during->torque()) : std::get_if<torques::Custom>(&torque);
}

/// The torque for a span without breaks.
AnyTorque drop_breaks(AnyTorque torque, double begin, double end) {
  const auto* custom = std::get_if<torques::Custom>(&torque);
  if (custom != nullptr && !custom->breaks().empty()) return custom->between(begin, end);
  return torque;
}

/// The first and the last time, including the start.
std::pair<double, double> find_span(const Scene& scene) {
  const auto [least, most] = std::minmax_element(scene.times().begin(), scene.times().end());
  return {std::min(scene.t0(), *least), std::max(scene.t0(), *most)};
}

/// The torques that act between two times, without their windows, and their numbers.
std::vector<AnyTorque> find_acting(const Scene& scene, double begin, double end,
                                   std::vector<std::size_t>* numbers = nullptr) {
  std::vector<AnyTorque> acting;
  for (const AnyTorque& torque : scene.torques()) {
    const auto* during = std::get_if<During>(&torque);
    if (during != nullptr && !(begin < end ? during->acts_throughout(begin, end) : during->acts_at(begin))) continue;
    acting.push_back(drop_breaks(drop_window(torque), begin, end));
    if (numbers != nullptr) numbers->push_back(static_cast<std::size_t>(&torque - scene.torques().data()));
  }
  return acting;
}

/// The rotors that rotate between two times, without their windows.
std::vector<Rotor> find_rotating(const std::vector<Rotor>& rotors, double begin, double end) {
  std::vector<Rotor> rotating;
  for (const Rotor& rotor : rotors) {
    if (!(begin < end ? rotor.rotates_throughout(begin, end) : rotor.rotates_at(begin))) continue;
    rotating.push_back(rotor.without_windows());
  }
  return rotating;
}

/// The body of a piece, and its torques on a body of constant inertia.
void set_body(const Scene& scene, Piece& piece) {
  const bool backward = piece.end < piece.begin;
  piece.body = scene.find_body_piece(piece.begin, backward);
  piece.changes = !piece.body.is_constant();
  for (const AnyTorque& torque : piece.torques)
    if (piece.changes && !traits(torque).vanishes) piece.names.emplace_back(torque_name(torque));
  ConstantBody made = make_constant(scene, piece.body, piece.begin, std::move(piece.torques), std::move(piece.rotors));
  piece.torques = std::move(made.torques), piece.rotors = std::move(made.rotors);
  piece.inertia_B = std::move(made.inertia_B), piece.keeps_damper = made.keeps_damper;
}

/// -J^-1 dh, solved for the inertia after the jump.
Vector3d compute_rate_jump(const Scene& scene, const Momentum& after, const Vector3d& dh) {
  if (after.J == scene.inertia_B().matrix()) return polhode::compute_rate_jump(scene.inertia_B(), dh);
  return polhode::compute_rate_jump(InertiaTensor::from_trusted(after.J, false), dh);
}

}  // namespace

bool has_windows(const Scene& scene) {
  return scene.changes() || has_rotor_windows(scene) ||
         std::any_of(scene.torques().begin(), scene.torques().end(),
                     [](const AnyTorque& torque) {
                       if (std::holds_alternative<During>(torque)) return true;
                       const auto* custom = std::get_if<torques::Custom>(&torque);
                       return custom != nullptr && !custom->breaks().empty();
                     });
}

Scene add_breaks(const Scene& scene, const std::vector<double>& times) {
  SceneParts parts = scene.parts();
  for (AnyTorque& torque : parts.torques) {
    const torques::Custom* custom = find_custom(torque);
    if (custom == nullptr) continue;
    std::vector<double> all = custom->breaks();
    all.insert(all.end(), times.begin(), times.end());
    const torques::Custom cut = custom->with_breaks(std::move(all));
    if (const auto* during = std::get_if<During>(&torque)) {
      torque = During(cut, during->windows());
    } else {
      torque = cut;
    }
  }
  return Scene(std::move(parts));
}

bool has_rotor_windows(const Scene& scene) {
  return std::any_of(scene.rotors().begin(), scene.rotors().end(),
                     [](const Rotor& rotor) { return rotor.has_windows(); });
}

Vector3d compute_rate_jump(const InertiaTensor& J_B, const Vector3d& dh_B) {
  const Matrix3d& J = J_B.matrix();
  if (J_B.is_diagonal()) return {-dh_B[0] / J(0, 0), -dh_B[1] / J(1, 1), -dh_B[2] / J(2, 2)};
  const Vector3d dh_P = J_B.axes().transpose() * dh_B;
  return -(J_B.axes() * dh_P.cwiseQuotient(J_B.moments()));
}

Momentum find_momentum(const Scene& scene, double t) {
  return {scene.inertia_B(t), scene.rotor_momentum(t) + scene.inner_momentum(t)};
}

Momentum find_momentum(const Scene& scene, const Piece& piece, double t) {
  Momentum found{scene.inertia_B().matrix(), sum_momenta(piece.rotors, scene.omega())};
  if (!scene.changes()) return found;
  if (piece.body.inertia)
    found.J = Changing::compute_tensor(*piece.body.inertia, t) - scene.inertia_reduction();
  const double from = std::min(piece.begin, piece.end), to = std::max(piece.begin, piece.end);
  found.h = sum_momenta(find_rotating(scene.parts().rotors, from, to), scene.omega());
  if (piece.body.momentum) found.h += Changing::compute_vector(*piece.body.momentum, t);
  return found;
}

Vector3d compute_rate_jump(const Scene& scene, const Vector3d& omega, const Momentum& before, const Momentum& after) {
  if (before.J == after.J) return compute_rate_jump(scene, after, after.h - before.h);
  const Vector3d kept = scene.leaving() ? Vector3d(Vector3d::Zero()) : Vector3d((after.J - before.J) * omega);
  return compute_rate_jump(scene, after, kept + (after.h - before.h));
}

Vector3d carry_rates(const Scene& scene, const Vector3d& d_omega, const Momentum& before, const Momentum& after) {
  return d_omega + compute_rate_jump(scene, d_omega, {before.J, after.h}, after);
}

Pieces cut(const Scene& scene, std::vector<double> method_switches) {
  const auto [first, last] = find_span(scene);
  const double t0 = scene.t0();
  std::vector<double> edges = method_switches;
  for (const double t : scene.find_changes(first, last)) edges.push_back(t);
  for (const AnyTorque& torque : scene.torques()) {
    if (const torques::Custom* custom = find_custom(torque); custom != nullptr) {
      for (const double t : custom->breaks()) {
        if (first < t && t < last) edges.push_back(t);
      }
    }
    const During* during = find_windows(torque);
    if (during == nullptr) continue;
    for (const torques::Window& window : during->windows()) {
      for (const double t : {window.begin, window.end}) {
        if (first < t && t < last) edges.push_back(t);
      }
    }
  }
  const SceneParts parts = scene.parts();   // free rotors have their momentum
  bool ends_at_jump = scene.changes();   // and its pieces need scenes of their own
  for (const Rotor& rotor : parts.rotors) {
    for (const torques::Window& window : rotor.windows()) {
      for (const double t : {window.begin, window.end}) {
        if (first < t && t < last) edges.push_back(t);
        ends_at_jump = ends_at_jump || t == last;
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  Pieces pieces;
  pieces.whole = edges.empty() && !ends_at_jump;
  pieces.method_switches = std::move(method_switches);
  const auto add = [&](std::vector<Piece>& direction, double end) {
    const double begin = direction.empty() ? t0 : direction.back().end;
    const double from = std::min(begin, end), to = std::max(begin, end);
    std::vector<std::size_t> numbers;
    direction.push_back({begin, end, find_acting(scene, from, to, &numbers), find_rotating(parts.rotors, from, to)});
    direction.back().numbers = std::move(numbers);
    if (scene.changes()) set_body(scene, direction.back());
  };
  if (std::any_of(scene.times().begin(), scene.times().end(), [t0](double t) { return t >= t0; })) {
    for (const double t : edges) {
      if (t > t0) add(pieces.forward, t);
    }
    add(pieces.forward, last);
  }
  if (first < t0) {
    for (auto t = edges.rbegin(); t != edges.rend(); ++t) {
      if (*t < t0) add(pieces.backward, *t);
    }
    add(pieces.backward, first);
  }
  return pieces;
}

Scene make_piece_scene(const Scene& scene, const Piece& piece, const State& start, std::vector<double> times,
                       const Wanted& want) {
  std::vector<AnyTorque> torques = piece.torques;
  if (!start.states.empty()) set_starts(torques, start.states);
  return Scene(SceneParts{.inertia_B = piece.inertia_B.value_or(scene.given_inertia_B()),
                          .omega = start.omega,
                          .attitude = start.attitude,
                          .torques = std::move(torques),
                          .times = std::move(times),
                          .want = want,
                          .t0 = start.t,
                          .name = scene.name(),
                          .rotors = piece.rotors,
                          .damper = piece.keeps_damper ? scene.damper() : std::nullopt});
}

Scene drop_windows(const Scene& scene) {
  const auto [first, last] = find_span(scene);
  SceneParts parts = scene.parts();
  parts.torques = find_acting(scene, first, last);
  parts.rotors = find_rotating(parts.rotors, first, last);
  return Scene(std::move(parts));
}

std::string describe_span(const Piece& piece) {
  return "from t = " + to_text(std::min(piece.begin, piece.end)) + " to " + to_text(std::max(piece.begin, piece.end)) +
         " s";
}

bool carries_attitude(const Scene& scene, const Pieces& pieces, const SolveOptions& options) {
  bool uses = scene.want().attitude || !options.events.empty();
  for (const Piece* piece : pieces.all()) uses |= summarize(piece->torques).uses_attitude;
  return uses;
}

std::vector<Piece*> Pieces::all() {
  std::vector<Piece*> list;
  for (Piece& piece : backward) list.push_back(&piece);
  for (Piece& piece : forward) list.push_back(&piece);
  return list;
}

std::vector<const Piece*> Pieces::all() const {
  std::vector<const Piece*> list;
  for (const Piece& piece : backward) list.push_back(&piece);
  for (const Piece& piece : forward) list.push_back(&piece);
  return list;
}

}  // namespace polhode
