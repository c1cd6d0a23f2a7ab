#include "bind_plan.hpp"

#include <pybind11/stl.h>

#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/solve/closed_form.hpp"

namespace polhode::python {
namespace {

py::dict describe_facts(const Facts& facts) {
  py::dict all;
  all["free"] = facts.is_free();
  all["symmetry"] = to_text(facts.symmetry);
  all["gaps"] = py::make_tuple(facts.gap_low, facts.gap_high);
  all["off_axis"] = facts.off_axis;
  all["separatrix"] = facts.separatrix;
  all["span"] = facts.span();
  all["turns"] = facts.turns;
  all["only_at_end"] = facts.only_at_end;
  all["sees_time"] = facts.torques.uses_time;
  all["sees_attitude"] = facts.torques.uses_attitude;
  all["sees_rates"] = facts.torques.uses_rates;
  py::list kept;
  if (facts.is_free() || facts.torques.keeps_energy) kept.append("energy");
  if (facts.is_free()) kept.append("angular_momentum");
  if (!facts.is_free() && facts.torques.keeps_vertical) kept.append("vertical_momentum");
  if (facts.torques.keeps_jacobi) kept.append("jacobi");
  all["keeps"] = kept;
  all["may_spin_up"] = facts.may_spin_up;
  all["decay"] = facts.decay;
  all["stiffness"] = facts.stiffness;
  return all;
}

py::dict make_report(const Scene& scene, const py::object& accuracy, const py::object& method, bool certify,
                     const std::string& formulation, const Factors* factors) {
  SolveOptions options = to_wishes(accuracy, method, certify, formulation);
  options.cost_factors = factors == nullptr ? nullptr : &factors->by_name;
  const PlanReport report = explain_plan(scene, options);
  py::list candidates;
  for (const Candidate& one : report.candidates) {
    candidates.append(
        py::make_tuple(one.name, one.exact, one.why_not, one.predicted_error, one.predicted_seconds, one.rtol));
  }
  py::dict all;
  all["plan"] = describe_plan(report.plan, report.plan.state, report.plan.rtol);
  all["facts"] = describe_facts(report.facts);
  all["candidates"] = candidates;
  all["reasons"] = py::cast(report.reasons);
  all["left_out"] = py::cast(report.left_out);
  return all;
}

}  // namespace

py::tuple describe_plan(const Plan& plan, const std::string& state, double rtol) {
  py::list pieces;
  for (const PiecePlan& one : plan.pieces) {
    pieces.append(py::make_tuple(one.begin, one.end, py::tuple(py::cast(one.torques)), one.model, one.method, one.turns,
                                 one.predicted_seconds));
  }
  return py::make_tuple(plan.model, plan.method, state, plan.accuracy, plan.certify, rtol,
                        plan.predicted_error, plan.predicted_seconds, py::tuple(pieces));
}

std::optional<double> to_optional(const py::object& value, const char* name) {
  if (value.is_none()) return std::nullopt;
  return to_real(value, name);
}

SolveOptions to_wishes(const py::object& accuracy, const py::object& method, bool certify,
                       const std::string& formulation) {
  SolveOptions options;
  options.accuracy = to_optional(accuracy, "accuracy");
  if (!method.is_none()) options.method = std::string(py::str(method));
  options.certify = certify;
  if (formulation != "euler" && formulation != "lagrangian") {
    throw InvalidInput("formulation", "'euler' or 'lagrangian'", "'" + formulation + "'");
  }
  options.formulation = formulation == "euler" ? Formulation::euler : Formulation::lagrangian;
  return options;
}

void bind_plan(py::module_& m) {
  py::class_<Factors>(m, "CostFactors", "The time of each method on this machine over its forecast, by name.")
      .def(py::init([](const std::map<std::string, double>& factors) {
             return Factors{CostFactors(factors.begin(), factors.end())};
           }),
           py::arg("factors"));
  m.def("plan", &make_report, py::arg("scene"), py::arg("accuracy"), py::arg("method"), py::arg("certify"),
        py::arg("formulation"), py::arg("factors").none(true));
  m.def("exact_models", [] {
    py::list list;
    for (const ExactModel& model : exact_models()) {
      list.append(py::make_tuple(std::string(model.name), std::string(model.doc), std::string(model.source)));
    }
    return list;
  }, "The closed forms: name, doc, source.");
}

}  // namespace polhode::python
