#include "bind_solve_plan.hpp"

#include <pybind11/stl.h>

#include "bind_solve_options.hpp"
#include "gil.hpp"
#include "polhode/exact/closed_forms.hpp"
#include "polhode/solve/closed_form.hpp"

namespace polhode::python {
namespace {

using namespace py::literals;

py::dict describe_facts(const Facts& facts) {
  py::dict all;
  all["free"] = facts.is_free();
  const Vector3d& h = facts.rotor_momentum;
  all["rotor_momentum"] = py::make_tuple(h[0], h[1], h[2]);
  all["symmetry"] = to_text(facts.symmetry);
  all["gaps"] = py::make_tuple(facts.gap_low, facts.gap_high);
  all["off_axis"] = facts.off_axis;
  all["separatrix"] = facts.separatrix;
  all["span"] = facts.span();
  all["turns"] = facts.turns;
  all["effort"] = facts.work();
  all["call_seconds"] = facts.call_seconds;
  all["only_at_end"] = facts.only_at_end;
  all["sees_time"] = facts.torques.uses_time;
  all["sees_attitude"] = facts.torques.uses_attitude;
  all["sees_rates"] = facts.torques.uses_rates;
  py::list kept;
  if (facts.is_free() || facts.torques.keeps_energy) kept.append("energy");
  const bool no_torque = facts.torques.acting == (facts.torques.rotors ? 1 : 0);
  if (no_torque) kept.append("angular_momentum");
  if (!no_torque && facts.torques.keeps_vertical) kept.append("vertical_momentum");
  if (facts.torques.keeps_jacobi) kept.append("jacobi");
  all["keeps"] = kept;
  all["may_spin_up"] = facts.may_spin_up;
  all["decay"] = facts.decay;
  all["stiffness"] = facts.stiffness;
  return all;
}

py::dict describe_candidate(const Candidate& candidate) {
  return py::dict("name"_a = candidate.name, "exact"_a = candidate.exact, "why_not"_a = candidate.why_not,
                  "predicted_error"_a = candidate.predicted_error, "predicted_seconds"_a = candidate.predicted_seconds,
                  "rtol"_a = candidate.rtol);
}

py::dict describe_piece(const PiecePlan& piece) {
  return py::dict("begin"_a = piece.begin, "end"_a = piece.end, "torques"_a = py::tuple(py::cast(piece.torques)),
                  "model"_a = piece.model, "method"_a = piece.method, "turns"_a = piece.turns,
                  "predicted_seconds"_a = piece.predicted_seconds,
                  "ran"_a = piece.ran.empty() ? py::object(py::none()) : py::object(py::str(piece.ran)));
}

/// The closed form as the class that evaluates it.
py::object to_python(const ClosedForm* form) {
#define POLHODE_CAST(type) \
  if (const auto* found = dynamic_cast<const ClosedFormOf<type>*>(form)) return py::cast(found->motion());
  POLHODE_CLOSED_FORM_TYPES(POLHODE_CAST)
#undef POLHODE_CAST
  return py::none();
}

std::unique_ptr<PlannedScene> make_planned(const Scene& scene, const py::dict& options) {
  SolveOptions chosen = to_solve_options(options);
  if (!chosen.progress) chosen.progress = make_progress(py::none());   // pilot runs heed Ctrl-C
  const WithoutGil nogil;   // Python callables take it back for themselves
  return std::make_unique<PlannedScene>(scene, chosen);
}

py::dict make_report(const PlannedScene& planned) {
  const PlanReport report = [&] {
    const WithoutGil nogil;
    return planned.explain();
  }();
  py::list candidates;
  for (const Candidate& candidate : report.candidates) candidates.append(describe_candidate(candidate));
  py::list left_out;
  for (const LeftOut& left : report.left_out) {
    left_out.append(py::dict("torque"_a = left.torque, "name"_a = left.name, "omega"_a = left.omega,
                             "attitude"_a = left.attitude, "reason"_a = left.reason));
  }
  return py::dict("facts"_a = describe_facts(report.facts), "candidates"_a = candidates,
                  "reasons"_a = py::cast(report.reasons), "left_out"_a = left_out);
}

}  // namespace

py::dict describe_plan(const Plan& plan, const std::string& state, double rtol) {
  py::list pieces;
  for (const PiecePlan& piece : plan.pieces) pieces.append(describe_piece(piece));
  return py::dict("model"_a = plan.model, "method"_a = plan.method, "pieces"_a = pieces, "state"_a = state,
                  "accuracy"_a = plan.accuracy,
                  "certify"_a = plan.proof ? py::object(py::str("proof")) : py::object(py::bool_(plan.certify)),
                  "rtol"_a = rtol, "predicted_error"_a = plan.predicted_error,
                  "predicted_seconds"_a = plan.predicted_seconds);
}

void bind_solve_plan(py::module_& m) {
  py::class_<Factors>(m, "CostFactors", "The time of each method on this machine over its forecast, by name.")
      .def(py::init([](const std::map<std::string, double>& factors) {
             return Factors{CostFactors(factors.begin(), factors.end())};
           }),
           py::arg("factors"));
  py::class_<PlannedScene>(m, "PlannedScene", "A scene and what was decided for it, once.")
      .def(py::init(&make_planned), py::arg("scene"), py::arg("options"))
      .def_property_readonly("parts", [](const PlannedScene& planned) {
        return describe_plan(planned.plan(), planned.plan().state, planned.plan().rtol);
      })
      .def_property_readonly("report", &make_report);
  m.def("effect", [](const Scene& scene, std::size_t torque) {
    const Effect found = [&] {
      const WithoutGil nogil;
      return compute_effect(scene, torque);
    }();
    return py::dict("omega"_a = found.omega, "attitude"_a = found.attitude,
                    "first_order"_a = py::make_tuple(found.first_omega, found.first_attitude),
                    "kind"_a = found.is_bounded() ? "bounded" : "refused", "reason"_a = found.refusal);
  }, py::arg("scene"), py::arg("torque"), "A bound on what one torque changes, by the names of its record.");
  m.def("closed_forms", [] {
    py::list list;
    for (const ClosedFormRecord* form : closed_forms()) {
      py::dict record;
      record["name"] = std::string(form->name);
      record["type"] = std::string(form->type);
      record["doc"] = std::string(form->doc);
      record["source"] = std::string(form->source);
      list.append(record);
    }
    return list;
  }, "The closed forms, simplest first: name, type (the class), doc, source.");
  m.def("find_closed_form", [](const Scene& scene) { return to_python(find_closed_form(scene, compute_facts(scene)).get()); },
        py::arg("scene"), "The closed form that holds for a scene without windows, as its class; None if none does.");
  m.def("closed_form_refusal", [](const Scene& scene, const std::string& type) {
    const Facts facts = compute_facts(scene);
    const ClosedFormRecord* found = find_closed_form_record(scene, facts);
    if (found != nullptr && found->type == type) return std::string();
    std::string why;
    for (const ClosedFormRecord* form : closed_forms()) {
      if (form->type != type) continue;
      const Refusal refusal = form->refuse(scene, facts, Words::yes);
      why = refusal ? refusal.why : "also holds, but " + std::string(found->name) + " is simpler";
    }
    return why;
  }, py::arg("scene"), py::arg("type"), "Why a class of closed forms is not that of a scene; empty if it is.");
}

}  // namespace polhode::python
