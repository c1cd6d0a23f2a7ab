#include <pybind11/stl.h>

#include <memory>

#include "bind_scene.hpp"
#include "bind_solve_options.hpp"
#include "bind_solve_plan.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/solve/invariants.hpp"
#include "polhode/method/lagrangian_problem.hpp"
#include "polhode/method/euler_problem.hpp"
#include "polhode/method/methods.hpp"
#include "polhode/reference/reference.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode::python {
namespace {

using namespace py::literals;

/// The rows of a vector that the answer owns, as an array that keeps the answer alive.
py::object view(const py::object& answer, const std::vector<double>& values, py::ssize_t columns, bool wanted = true) {
  if (!wanted) return py::none();
  const auto size = static_cast<py::ssize_t>(values.size());
  if (columns == 1) return Array(size, values.data(), answer);
  return Array({size / columns, columns}, values.data(), answer);
}

/// What a solve gave; Python reads its parts when they are needed.
struct Answer {
  Motion motion;
  Wanted want;
  PlannedScene planned;   // what ran
  std::vector<formula::Input> states;
  std::vector<Controller> controllers;
};

/// Rows of the states' numbers as arrays by their names: (n,) of a number, (n, k) of a vector.
py::dict name_states(const std::vector<formula::Input>& states, const std::vector<double>& rows) {
  py::dict all;
  const auto width = static_cast<py::ssize_t>(formula::list_values(states).size());
  const py::ssize_t n = width > 0 ? static_cast<py::ssize_t>(rows.size()) / width : 0;
  py::ssize_t first = 0;
  for (const formula::Input& state : states) {
    const auto count = static_cast<py::ssize_t>(state.values.size());
    Array array = count == 1 ? Array(n) : Array({n, count});
    double* out = array.mutable_data();
    for (py::ssize_t i = 0; i < n; ++i) out = std::copy_n(rows.data() + width * i + first, count, out);
    all[py::str(state.name)] = array;
    first += count;
  }
  return all;
}

/// Those of one state.
py::dict name_state(const std::vector<formula::Input>& states, const std::vector<double>& numbers) {
  py::dict all;
  const double* in = numbers.data();
  for (const formula::Input& state : states) {
    const auto count = static_cast<py::ssize_t>(state.values.size());
    all[py::str(state.name)] = count == 1 ? py::object(py::float_(*in)) : py::object(Array(count, in));
    in += count;
  }
  return all;
}

/// Bounds of a proof; None without one.
template <std::vector<double> Motion::*part, py::ssize_t columns>
py::object view_part(const py::object& self) {
  const Answer& answer = self.cast<const Answer&>();
  return view(self, answer.motion.*part, columns,
              answer.motion.plan.proof && (columns == 3 ? answer.want.omega : answer.want.attitude));
}

/// Bounds of the states' numbers by their names; None without a proof.
template <std::vector<double> Motion::*part>
py::object name_part(const Answer& answer) {
  if (!answer.motion.plan.proof) return py::none();
  return name_states(answer.states, answer.motion.*part);
}

/// @param plan  a PlannedScene of this scene that is to run; None to plan
std::unique_ptr<Answer> solve_scene(const Scene& scene, const py::dict& given, py::handle plan) {
  SolveOptions options = to_solve_options(given);
  if (!options.progress) options.progress = make_progress(py::none());
  const auto* made = plan.is_none() ? nullptr : &plan.cast<const PlannedScene&>();
  const WithoutGil nogil;   // Python callables take it back for themselves
  PlannedScene planned = made != nullptr ? *made : PlannedScene(scene, options);
  Motion motion = planned.run(options);
  if (made == nullptr) motion.stats += planned.cost();
  return std::unique_ptr<Answer>(new Answer{std::move(motion), scene.want(), std::move(planned), scene.states(), scene.controllers()});
}

/// Of each controller a dict of t, measurement (a dict), command and states (a dict).
py::list list_ticks(const Answer& answer) {
  py::list all;
  for (std::size_t i = 0; i < answer.motion.ticks.size(); ++i) {
    const Ticks& ticks = answer.motion.ticks[i];
    const Controller& controller = answer.controllers[i];
    std::vector<formula::Input> measured = {{"omega", std::vector<double>(3)}, {"attitude", std::vector<double>(4)}};
    for (const formula::Input& input : controller.inputs())
      if (input.name == "field" || input.name == "speed") measured.push_back(input);
    const auto n = static_cast<py::ssize_t>(ticks.t.size()), m = static_cast<py::ssize_t>(controller.count_commands());
    py::dict one;
    one["t"] = Array(n, ticks.t.data());
    one["measurement"] = name_states(measured, ticks.measurement);
    one["command"] = Array({n, m}, ticks.command.data());
    one["states"] = name_states(controller.parts().law.states, ticks.states);
    all.append(one);
  }
  return all;
}

py::dict describe_stats(const Motion& motion) {
  const ode::Counts& counts = motion.stats;
  return py::dict("steps"_a = counts.steps, "rejected"_a = counts.rejected, "derivatives"_a = counts.derivatives,
                  "events"_a = counts.events, "runs"_a = motion.runs, "seconds"_a = counts.seconds);
}

py::list describe_events(const Answer& answer) {
  const Motion& motion = answer.motion;
  py::list hits;
  for (const MotionEvent& hit : motion.events) {
    py::dict all;
    all["event"] = hit.event;
    all["t"] = hit.state.t;
    all["omega"] = from_vector3(hit.state.omega);
    all["attitude"] = from_quat(hit.state.attitude);
    if (!answer.states.empty()) all["states"] = name_state(answer.states, hit.state.states);
    hits.append(all);
  }
  return hits;
}

std::size_t rows(const Array& array) { return static_cast<std::size_t>(array.size() == 0 ? 0 : array.shape(0)); }

/// The momenta of driven rotors and a damper are states, which their energy and momentum need.
void require_states(const Scene& scene, const Array& states, std::size_t count) {
  if (!scene.has_inner_states()) return;
  if (static_cast<std::size_t>(states.size()) != count * static_cast<std::size_t>(scene.count_states()))
    throw InvalidInput("states", "given for a scene with driven rotors or a damper", std::to_string(states.size()) + " numbers");
}

}  // namespace

void bind_solve(py::module_& m) {
  bind_solve_plan(m);
  py::class_<Answer>(m, "Answer")
      .def_property_readonly("t",
                             [](const py::object& self) { return view(self, self.cast<const Answer&>().motion.t, 1); })
      .def_property_readonly("omega",
                             [](const py::object& self) {
                               const Answer& answer = self.cast<const Answer&>();
                               return view(self, answer.motion.omega, 3, answer.want.omega);
                             })
      .def_property_readonly("attitude",
                             [](const py::object& self) {
                               const Answer& answer = self.cast<const Answer&>();
                               return view(self, answer.motion.attitude, 4, answer.want.attitude);
                             })
      .def_property_readonly("omega_lower", &view_part<&Motion::omega_lower, 3>)
      .def_property_readonly("omega_upper", &view_part<&Motion::omega_upper, 3>)
      .def_property_readonly("attitude_lower", &view_part<&Motion::attitude_lower, 4>)
      .def_property_readonly("attitude_upper", &view_part<&Motion::attitude_upper, 4>)
      .def_property_readonly("states_lower", &name_part<&Motion::states_lower>)
      .def_property_readonly("states_upper", &name_part<&Motion::states_upper>)
      .def_property_readonly("proved_span",
                             [](const Answer& answer) -> py::object {
                               if (!answer.motion.plan.proof) return py::none();
                               return py::make_tuple(answer.motion.proved_begin, answer.motion.proved_end);
                             })
      .def_property_readonly("status", [](const Answer& answer) { return std::string(to_text(answer.motion.status)); })
      .def_property_readonly("message", [](const Answer& answer) { return answer.motion.message; })
      .def_property_readonly("stats", [](const Answer& answer) { return describe_stats(answer.motion); })
      .def_property_readonly("events", [](const Answer& answer) { return describe_events(answer); })
      .def_property_readonly("states",
                             [](const Answer& answer) { return name_states(answer.states, answer.motion.states); })
      .def_property_readonly("ticks", [](const Answer& answer) { return list_ticks(answer); })
      .def_property_readonly("plan",
                             [](const Answer& answer) {
                               const Motion& motion = answer.motion;
                               return describe_plan(motion.plan, motion.state, motion.rtol_used);
                             })
      .def_property_readonly("planned", [](const Answer& answer) { return answer.planned; })
      .def_property_readonly("error", [](const Answer& answer) { return answer.motion.error; })
      .def_property_readonly("error_kind", [](const Answer& answer) { return answer.motion.error_kind; })
      .def_property_readonly("asked", [](const Answer& answer) { return answer.motion.asked; })
      .def_property_readonly("has_dense", [](const Answer& answer) { return answer.motion.has_dense; })
      .def("__call__", [](const Answer& answer, py::handle times) {
        const Motion& motion = answer.motion;
        const Array t = to_array(times, "motion(t)");
        const auto n = static_cast<std::size_t>(t.size());
        std::vector<py::ssize_t> shape(t.shape(), t.shape() + t.ndim());
        auto with = [&](py::ssize_t last) {
          auto full = shape;
          full.push_back(last);
          return full;
        };
        Array omega(with(3)), attitude(with(4));
        const double* in = t.data();
        double *w = omega.mutable_data(), *q = attitude.mutable_data();
        {
          const WithoutGil nogil;
          for (std::size_t i = 0; i < n; ++i) {
            if (i % 1024 == 0) check_interrupt();
            const State state = motion.at(in[i]);
            std::copy_n(state.omega.data(), 3, w + 3 * i);
            const double attitude_i[4] = {state.attitude.x, state.attitude.y, state.attitude.z, state.attitude.w};
            std::copy_n(attitude_i, 4, q + 4 * i);
          }
        }
        return py::make_tuple(omega, attitude);
      })
      .def("states_at", [](const Answer& answer, py::handle times) {
        const Array t = to_array(times, "motion.states_at(t)");
        std::vector<double> rows;
        for (py::ssize_t i = 0; i < t.size(); ++i) {
          const State state = answer.motion.at(t.data()[i]);
          rows.insert(rows.end(), state.states.begin(), state.states.end());
        }
        return name_states(answer.states, rows);
      });

  m.def("solve", &solve_scene, py::arg("scene"), py::arg("options"), py::arg("plan") = py::none());

  m.def("method_refusal", [](const std::string& method, const Scene& scene) { return compute_refusal(method, scene); },
        "The reason why a method cannot integrate a scene, or an empty string.");

  m.def("energy", [](const Scene& scene, const Array& t, const Array& omega, const py::object& attitude,
                     const Array& states) {
    Array energy(t.size());
    const Array q = attitude.is_none() ? Array(py::array::ShapeContainer{0}) : attitude.cast<Array>();
    const double *in = t.data(), *w = omega.data(), *attitudes = attitude.is_none() ? nullptr : q.data();
    double* out = energy.mutable_data();
    const std::size_t count = rows(t);
    require_states(scene, states, count);
    const double* own = states.data();
    {
      const WithoutGil nogil;
      compute_energy(scene, count, in, w, attitudes, out, own);
    }
    return energy;
  }, py::arg("scene"), py::arg("t"), py::arg("omega"), py::arg("attitude"), py::arg("states") = Array(0));
  m.def("angular_momentum", [](const Scene& scene, const Array& t, const Array& omega, const Array& attitude,
                               const Array& states) {
    Array L({omega.shape(0), py::ssize_t{3}});
    const double *in = t.data(), *w = omega.data(), *q = attitude.data(), *own = states.data();
    double* out = L.mutable_data();
    const std::size_t count = rows(omega);
    require_states(scene, states, count);
    {
      const WithoutGil nogil;
      compute_angular_momentum(scene, count, in, w, q, out, own);
    }
    return L;
  }, py::arg("scene"), py::arg("t"), py::arg("omega"), py::arg("attitude"), py::arg("states") = Array(0));
  m.def("rotor_speed", [](const Scene& scene, const Array& t, const Array& omega, const Array& states) {
    Array speed({omega.shape(0), static_cast<py::ssize_t>(scene.rotors().size())});
    require_states(scene, states, rows(omega));
    compute_rotor_speed(scene, rows(omega), t.data(), omega.data(), states.data(),
                        speed.mutable_data());
    return speed;
  });
  m.def("damper_rates", [](const Scene& scene, const Array& omega, const Array& states) {
    Array rates({omega.shape(0), py::ssize_t{scene.damper() ? 3 : 0}});
    if (!scene.damper()) return rates;
    require_states(scene, states, rows(omega));
    compute_damper_rates(scene, rows(omega), omega.data(), states.data(), rates.mutable_data());
    return rates;
  });
  m.def("drift", [](const Scene& scene, const Array& t, const py::object& omega, const py::object& attitude,
                    const Array& states) {
    Motion motion;
    motion.start = scene.start();
    const auto fill = [](const Array& array) { return std::vector<double>(array.data(), array.data() + array.size()); };
    motion.t = fill(t);
    if (!omega.is_none()) motion.omega = fill(omega.cast<Array>());
    if (!attitude.is_none()) motion.attitude = fill(attitude.cast<Array>());
    motion.states = fill(states);
    const WithoutGil nogil;
    return compute_drift(scene, motion);
  }, py::arg("scene"), py::arg("t"), py::arg("omega"), py::arg("attitude"), py::arg("states") = Array(0));
  const py::object named = py::module_::import("collections").attr("namedtuple")("Reference", "omega attitude steps");
  m.def("reference", [named](const Scene& scene, int order, double tolerance, long max_steps) {
    ReferenceOptions options{order, tolerance, max_steps, [] {
      check_signals();
      return true;
    }};
    Reference found;
    {
      const WithoutGil nogil;
      found = compute_reference(scene, options);
    }
    const auto n = static_cast<py::ssize_t>(scene.times().size());
    return named(Array({n, py::ssize_t{3}}, found.omega.data()), Array({n, py::ssize_t{4}}, found.attitude.data()),
                 found.steps);
  }, py::arg("scene"), py::arg("order"), py::arg("tolerance"), py::arg("max_steps"),
     "A named tuple of omega, attitude and steps of a scene by Taylor series in long double, as a reference.");
  m.def("generalised_forces", [](py::handle torque, py::handle angles) {
    const Vector3d tau_B = to_vector3(torque, "torque"), q = to_vector3(angles, "angles");
    return from_vector3(LagrangianProblem<NoTorque>::compute_rate_map(q[1], q[2]).transpose() * tau_B);
  });
}

}  // namespace polhode::python
