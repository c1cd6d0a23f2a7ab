#include <pybind11/stl.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include "bind_orbit.hpp"
#include "bind_scene.hpp"
#include "bind_torque.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"

// Every torque of the list gets its Python class from its record: constructor, properties, repr, equality, hash,
// pickle.
namespace polhode::python {
namespace {

using Kind = TorqueParameter::Kind;

Matrix3d to_matrix_or_diagonal(py::handle value, const char* name) {
  const Array array = to_array(value, name);
  if (array.ndim() != 1) return to_matrix3(value, name);
  return to_vector3(value, name).asDiagonal();
}

TorqueValue to_value(py::handle value, const TorqueParameter& parameter, const std::string& where) {
  switch (parameter.kind) {
    case Kind::real: return to_real(value, where.c_str());
    case Kind::vector: return to_vector3(value, where.c_str());
    case Kind::matrix: return to_matrix_or_diagonal(value, where.c_str());
    case Kind::orbit: return to_ephemeris(value, where);
    case Kind::choice: break;
  }
  const std::string text = py::isinstance<py::str>(value) ? value.cast<std::string>() : std::string(py::repr(value));
  const std::string choices = "|" + std::string(parameter.choices) + "|";
  if (text.empty() || text.find('|') != std::string::npos || choices.find("|" + text + "|") == std::string::npos) {
    throw InvalidInput(where, "one of " + std::string(parameter.choices), "'" + text + "'");
  }
  return text;
}

TorqueValue default_value(const TorqueParameter& parameter) {
  if (parameter.kind == Kind::choice) return std::string(*parameter.fallback);
  double value = 0.0;
  std::from_chars(parameter.fallback->data(), parameter.fallback->data() + parameter.fallback->size(), value);
  return value;
}

py::object from_value(const TorqueValue& value) {
  return std::visit(
      [](const auto& one) -> py::object {
        using T = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<T, formula::Ephemeris>) {
          return from_ephemeris(one);
        } else if constexpr (std::is_same_v<T, Vector3d>) {
          return from_vector3(one);
        } else if constexpr (std::is_same_v<T, Matrix3d>) {
          return from_matrix3(one);
        } else {
          return py::cast(one);
        }
      },
      value);
}

std::string call_signature(const TorqueRecord& record) {
  std::string text = std::string(record.name) + "(";
  for (const TorqueParameter& parameter : record.parameters) {
    if (&parameter != record.parameters.data()) text += ", ";
    text += parameter.name;
    if (parameter.fallback) {
      const char* quote = parameter.kind == Kind::choice ? "\"" : "";
      text.append("=").append(quote).append(*parameter.fallback).append(quote);
    }
  }
  return text + ")";
}

std::string docstring(const TorqueRecord& record) {
  static constexpr const char* shapes[] = {"float", "array_like, shape (3,)", "array_like, shape (3, 3) or (3,)",
                                           "str", "Orbit"};
  std::string text = call_signature(record) + "\n\n" + std::string(record.doc) + "\n\nParameters\n----------\n";
  for (const TorqueParameter& parameter : record.parameters) {
    text += std::string(parameter.name) + " : " + shapes[static_cast<int>(parameter.kind)] + "\n    ";
    text += std::string(parameter.doc);
    if (!parameter.choices.empty()) text += ": " + std::string(parameter.choices);
    if (!parameter.unit.empty()) text += " [" + std::string(parameter.unit) + "]";
    text += "\n";
  }
  text += "\nRaises\n------\nInvalidInput\n    For a wrong shape, or numbers that are not finite.\n";
  text += "\nReferences\n----------\n" + std::string(record.source) + "\n";
  return text;
}

/// What to write instead of a keyword that a torque does not have.
std::string keyword_hint(const TorqueRecord& record, const std::string& keyword) {
  if (record.name == "Gravity" && (keyword == "mass" || keyword == "m" || keyword == "g")) {
    return "weight is the mass times g: Gravity(weight=mass * 9.80665, arm=...)";
  }
  py::list names;
  for (const TorqueParameter& parameter : record.parameters) names.append(std::string(parameter.name));
  const py::list near = py::module_::import("difflib").attr("get_close_matches")(keyword, names, 1);
  return near.empty() ? "" : "did you mean '" + near[0].cast<std::string>() + "'?";
}

void refuse_unknown(const TorqueRecord& record, const py::kwargs& kwargs) {
  for (const auto& item : kwargs) {
    const std::string keyword = item.first.cast<std::string>();
    const bool known = std::any_of(record.parameters.begin(), record.parameters.end(),
                                   [&](const TorqueParameter& parameter) { return parameter.name == keyword; });
    if (known) continue;
    throw InvalidInput(std::string(record.name), "called as " + call_signature(record), "the keyword '" + keyword + "'",
                       keyword_hint(record, keyword));
  }
}

TorqueValues parse(const TorqueRecord& record, const py::args& args, const py::kwargs& kwargs) {
  TorqueValues values;
  const std::string name(record.name);
  if (args.size() > record.parameters.size()) {
    throw InvalidInput(name, "called as " + call_signature(record), std::to_string(args.size()) + " arguments");
  }
  refuse_unknown(record, kwargs);
  for (std::size_t i = 0; i < record.parameters.size(); ++i) {
    const TorqueParameter& parameter = record.parameters[i];
    const py::str key(parameter.name.data(), parameter.name.size());
    const std::string where = name + "." + std::string(parameter.name);
    const bool named = kwargs.contains(key);
    if (i < args.size() && named) throw InvalidInput(where, "given once", "it twice");
    if (i < args.size()) {
      values.push_back(to_value(args[i], parameter, where));
    } else if (named) {
      values.push_back(to_value(kwargs[key], parameter, where));
    } else if (parameter.fallback) {
      values.push_back(default_value(parameter));
    } else {
      throw InvalidInput(where, "given", "nothing", call_signature(record));
    }
  }
  return values;
}

py::tuple to_tuple(const TorqueValues& values) {
  py::tuple tuple(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    py::object value = from_value(values[i]);
    tuple[i] = py::hasattr(value, "tolist") ? value.attr("tolist")() : value;   // plain numbers: comparable, hashable
  }
  return tuple;
}

template <class T>
void bind_one(py::module_& m) {
  const TorqueRecord& record = T::record();
  static const std::string doc = docstring(record);
  py::class_<T> type(m, std::string(record.name).c_str(), doc.c_str());
  type.def(py::init([&record](const py::args& args, const py::kwargs& kwargs) {
    return T::from_values(parse(record, args, kwargs));
  }));
  for (std::size_t i = 0; i < record.parameters.size(); ++i) {
    type.def_property_readonly(std::string(record.parameters[i].name).c_str(),
                               [i](const T& torque) { return from_value(torque.values()[i]); });
  }
  bind_traits(type);
  bind_value(type);
  type.def("__repr__", [&record](const T& torque) {
    std::string text = "polhode.torques." + std::string(record.name) + "(";
    const py::tuple values = to_tuple(torque.values());
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) text += ", ";
      text += std::string(record.parameters[i].name) + "=" + std::string(py::repr(values[i]));
    }
    return text + ")";
  });
  type.def("__eq__", [](const T& a, const py::object& b) {
    return py::isinstance<T>(b) && to_tuple(a.values()).equal(to_tuple(b.cast<const T&>().values()));
  });
  type.def("__hash__", [](const T& torque) { return py::hash(py::str(py::repr(to_tuple(torque.values())))); });
  type.def(
      py::pickle([](const T& torque) { return to_tuple(torque.values()); },
                 [&record](const py::tuple& state) { return T::from_values(parse(record, state, py::kwargs())); }));
}

template <>
void bind_one<torques::Custom>(py::module_& m) {
  bind_torque_custom(m);
}

template <>
void bind_one<torques::Formula>(py::module_& m) {
  bind_torque_formula(m);
}

template <>
void bind_one<torques::During>(py::module_& m) {
  bind_torque_during(m);
}

py::dict describe(const TorqueRecord& record) {
  static constexpr const char* kinds[] = {"real", "vector", "matrix", "choice", "orbit"};
  py::list parameters;
  for (const TorqueParameter& parameter : record.parameters) {
    py::dict one;
    one["name"] = std::string(parameter.name);
    one["kind"] = kinds[static_cast<int>(parameter.kind)];
    one["unit"] = std::string(parameter.unit);
    one["doc"] = std::string(parameter.doc);
    one["default"] = parameter.fallback ? from_value(default_value(parameter)) : py::none();
    one["choices"] = parameter.choices.empty() ? py::object(py::tuple())
                                               : py::tuple(py::str(std::string(parameter.choices)).attr("split")("|"));
    parameters.append(one);
  }
  py::dict dict;
  dict["name"] = std::string(record.name);
  dict["key"] = std::string(record.key);
  dict["doc"] = std::string(record.doc);
  dict["source"] = std::string(record.source);
  dict["parameters"] = parameters;
  return dict;
}

constexpr const char* as_formula_doc = R"doc(Return the same torque as a formula, which is never replaced.

Parameters
----------
inertia : InertiaTensor or array_like, optional
    Of the body, for a torque that depends on it [kg m^2].

Returns
-------
Formula
    With `recognise` False, and with the parameters of the torque by their names.

Raises
------
InvalidInput
    For a torque that depends on the inertia, without it.
)doc";

template <class List = AnyTorque, class Visitor>
void for_each_torque(Visitor&& visitor) {
  [&]<class... T>(std::variant<T...>*) { (visitor.template operator()<T>(), ...); }(static_cast<List*>(nullptr));
}

/// as_formula(inertia=None) of the classes of torques, once Formula has its own.
void bind_as_formula(const py::module_& torques) {
  for_each_torque<LastingTorque>([&]<class T>() {
    if constexpr (!std::is_same_v<T, torques::Custom>) {
      auto type = py::reinterpret_borrow<py::class_<T>>(torques.attr(std::string(T::record().name).c_str()));
      type.def("as_formula", [](const T& torque, const py::object& inertia) {
        return as_formula(torque, to_used_inertia(torque, inertia));
      }, py::arg("inertia") = py::none(), as_formula_doc);
    }
  });
}

}  // namespace

AnyTorque to_torque(py::handle value, const std::string& name) {
  std::optional<AnyTorque> torque;
  for_each_torque([&]<class T>() {
    if (!py::isinstance<Bound<T>>(value)) return;
    const auto& bound = value.cast<const Bound<T>&>();
    if constexpr (std::is_same_v<T, Bound<T>>) {
      torque.emplace(bound);
    } else {
      torque.emplace(bound.get());
    }
  });
  if (!torque) {
    throw InvalidInput(name, "a torque of polhode.torques", std::string(py::str(py::type::of(value))),
                       "wrap a function of your own in polhode.torques.Custom");
  }
  return *torque;
}

void bind_torque(py::module_& m) {
  py::module_ torques = m.def_submodule("torques", "The classes of polhode.torques.");
  for_each_torque([&]<class T>() { bind_one<T>(torques); });
  bind_as_formula(torques);
  bind_formula_symbols(m);
  m.def("torque_records", [] {
    py::list list;
    for_each_torque<LastingTorque>([&]<class T>() { list.append(describe(T::record())); });
    return list;
  }, "The list of torques: name, scene-file key, doc, source, parameters.");
}

}  // namespace polhode::python
