#include "polhode/solve/motion.hpp"

#include <algorithm>

#include "polhode/core/error.hpp"

namespace polhode {

std::string_view to_text(Status status) {
  switch (status) {
    case Status::finished: return "finished";
    case Status::event: return "event";
    case Status::max_steps: return "max_steps";
    case Status::stopped: return "stopped";
    case Status::failed: return "failed";
  }
  return "failed";
}

State Motion::at(double time) const {
  if (!has_dense) {
    throw InvalidInput("motion(t)", "called on a motion solved with dense=True", "one without it",
                       "solve(scene, ..., dense=True) keeps the continuous extension");
  }
  const double first = std::min({t0, dense_forward.t_end(), dense_backward.empty() ? t0 : dense_backward.t_end()});
  const double last = std::max({t0, dense_forward.empty() ? t0 : dense_forward.t_end(), t0});
  const double begin = dense_backward.empty() ? t0 : std::min(first, dense_backward.t_end());
  if (!(time >= begin && time <= last)) {
    throw InvalidInput("motion(t)", "a time between " + polhode::to_text(begin) + " and " + polhode::to_text(last) + " s",
                       polhode::to_text(time));
  }
  double y[64];
  const ode::DenseOutput& dense = time < t0 || dense_forward.empty() ? dense_backward : dense_forward;
  State state;
  state.t = time;
  double attitude[4] = {NAN, NAN, NAN, NAN};
  dense(time, y);
  unpack(y, state.omega.data(), attitude);
  state.attitude = {attitude[0], attitude[1], attitude[2], attitude[3]};
  return state;
}

}  // namespace polhode
