#include "polhode/solve/motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/all_finite.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/solve/closed_form.hpp"

namespace polhode {

std::string_view to_text(Status status) {
  switch (status) {
    case Status::finished: return "finished";
    case Status::event: return "event";
    case Status::max_steps: return "max_steps";
    case Status::stopped: return "stopped";
    case Status::failed: return "failed";
    case Status::sliding: return "sliding";
  }
  return "failed";
}

double Motion::omega_scale() const {
  double scale = math::hypot(start.omega[0], start.omega[1], start.omega[2]);
  for (std::size_t i = 0; i + 2 < omega.size(); i += 3)
    scale = std::max(scale, math::hypot(omega[i], omega[i + 1], omega[i + 2]));
  return scale;
}

bool Motion::all_finite() const {
  return polhode::all_finite(omega.data(), omega.size()) && polhode::all_finite(attitude.data(), attitude.size()) &&
         polhode::all_finite(states.data(), states.size());
}

State Motion::at(double time) const {
  if (!has_dense) {
    throw InvalidInput("motion(t)", "called on a motion solved with dense=True", "one without it",
                       "solve(scene, ..., dense=True) keeps the continuous extension");
  }
  double begin = dense_backward.empty() ? start.t : dense_backward.t_end();
  double end = dense_forward.empty() ? start.t : dense_forward.t_end();
  if (closed_form) begin = t_begin, end = t_reached;
  const Motion* within = nullptr;
  for (const auto& piece : pieces) {
    begin = &piece == &pieces.front() ? piece->t_begin : std::min(begin, piece->t_begin);
    end = &piece == &pieces.front() ? piece->t_reached : std::max(end, piece->t_reached);
    // A window includes its begin: where two pieces meet, the later one holds.
    const bool is_inside = time >= piece->t_begin && time <= piece->t_reached;
    if (is_inside && (within == nullptr || time == piece->t_begin)) within = piece.get();
  }
  if (!(time >= begin && time <= end)) {
    throw InvalidInput("motion(t)",
                       "a time between " + polhode::to_text(begin) + " and " + polhode::to_text(end) + " s",
                       polhode::to_text(time));
  }
  if (time == start.t) return start;
  if (within != nullptr) {
    State found = within->at(time);
    if (time == within->t_reached) found.omega += within->end_jump;
    return found;
  }
  double y[64], q[4] = {NAN, NAN, NAN, NAN};
  State found;
  found.t = time;
  if (closed_form) {
    const double since = time - start.t;
    closed_form->at(&since, 1, found.omega.data(), q);
    found.attitude = {q[0], q[1], q[2], q[3]};
    return found;
  }
  (time < start.t ? dense_backward : dense_forward)(time, y);
  unpack(y, 1, found.omega.data(), q);
  if (extra.count > 0) found.states = extra.of(y);
  found.attitude = {q[0], q[1], q[2], q[3]};
  return found;
}

}  // namespace polhode
