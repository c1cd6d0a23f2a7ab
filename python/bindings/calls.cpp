#include "calls.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

struct Parameter {
  std::string name, fallback;   ///< fallback: the text of the default, empty if there is none
};

struct Signature {
  std::string name;
  std::vector<Parameter> parameters;   ///< without self; "*" stands among them

  std::string usage() const {
    std::string text = name + "(";
    for (const Parameter& parameter : parameters) {
      if (&parameter != parameters.data()) text += ", ";
      text += parameter.name + (parameter.fallback.empty() ? "" : "=" + parameter.fallback);
    }
    return text + ")";
  }
};

/// From the first line of a docstring of pybind11: `name(self: Type, a: type, b: type = value) -> type`.
Signature read_signature(const std::string& doc, const std::string& name) {
  Signature signature{name, {}};
  const std::string line = doc.substr(0, doc.find('\n'));
  int depth = 0;
  std::string part;
  for (std::size_t i = line.find('(') + 1; i < line.size(); ++i) {
    const char c = line[i];
    if ((c == ',' || c == ')') && depth == 0) {
      const std::size_t first = part.find_first_not_of(' '), colon = part.find(':'), equals = part.find(" = ");
      if (first != std::string::npos) {
        const std::string parameter = part.substr(first, colon == std::string::npos ? colon : colon - first);
        const std::string fallback = equals == std::string::npos ? "" : part.substr(equals + 3);
        if (parameter != "self") signature.parameters.push_back({parameter, fallback});
      }
      part.clear();
      if (c == ')') break;
      continue;
    }
    depth += (c == '(' || c == '[') - (c == ')' || c == ']');
    part += c;
  }
  return signature;
}

/// The first thing about a call that does not fit.
std::string describe_misfit(const Signature& signature, const py::args& args, const py::kwargs& kwargs) {
  std::vector<std::string> names;
  std::size_t positional = std::string::npos;
  for (const Parameter& parameter : signature.parameters) {
    if (parameter.name == "*") {
      positional = names.size();
    } else {
      names.push_back(parameter.name);
    }
  }
  for (const auto& [key, value] : kwargs) {
    const std::string keyword = py::str(key);
    if (std::find(names.begin(), names.end(), keyword) == names.end()) return "the keyword '" + keyword + "'";
  }
  if (args.size() > std::min(positional, names.size())) return std::to_string(args.size()) + " positional arguments";
  std::size_t i = 0;
  for (const Parameter& parameter : signature.parameters) {
    if (parameter.name == "*") continue;
    const bool given = i++ < args.size() || kwargs.contains(parameter.name.c_str());
    if (!given && parameter.fallback.empty()) return "nothing for '" + parameter.name + "'";
  }
  std::string types;
  const auto add = [&](py::handle value) {
    types += (types.empty() ? "" : ", ") + std::string(py::str(py::type::handle_of(value).attr("__name__")));
  };
  for (const py::handle value : args) add(value);
  for (const auto& item : kwargs) add(item.second);
  return "arguments of the types " + types;
}

[[noreturn]] void refuse(const Signature& signature, const std::string& owner, const py::args& args,
                         const py::kwargs& kwargs) {
  throw InvalidInput(owner, "called as " + signature.usage(), describe_misfit(signature, args, kwargs));
}

/// Adds an overload that takes any arguments, after all others, and leaves the docstring alone.
void add_refusal(py::handle cls, const std::string& name, py::object function, bool is_method) {
  auto* const compiled = reinterpret_cast<PyCFunctionObject*>(function.ptr());
  const std::string doc = compiled->m_ml->ml_doc == nullptr ? "" : compiled->m_ml->ml_doc;
  if (doc.find("*args") != std::string::npos || doc.find('(') == std::string::npos) return;
  const std::string type = py::str(cls.attr("__name__"));
  const bool constructor = name == "__init__", state = name == "__setstate__";
  const Signature signature = read_signature(doc, constructor ? type : name);
  const std::string owner = constructor ? type : type + "." + name;
  if (constructor || state) {
    py::cpp_function([=](py::detail::value_and_holder&, const py::args& args,
                         const py::kwargs& kwargs) { refuse(signature, owner, args, kwargs); },
                     py::name(name.c_str()), py::is_method(cls), py::sibling(function),
                     py::detail::is_new_style_constructor());
  } else if (is_method) {
    py::cpp_function([=](py::handle, const py::args& args,
                         const py::kwargs& kwargs) { refuse(signature, owner, args, kwargs); },
                     py::name(name.c_str()), py::is_method(cls), py::sibling(function));
  } else {
    py::cpp_function([=](const py::args& args, const py::kwargs& kwargs) { refuse(signature, owner, args, kwargs); },
                     py::name(name.c_str()), py::scope(cls), py::sibling(function));
  }
  std::free(const_cast<char*>(compiled->m_ml->ml_doc));   // as pybind11 made it
  compiled->m_ml->ml_doc = strdup(doc.c_str());
}

void visit_class(py::handle cls) {
  const py::dict members = py::dict(cls.attr("__dict__"));
  for (const auto& [key, value] : members) {
    const std::string name = py::str(key);
    const bool special = name.compare(0, 2, "__") == 0;
    if (special && name != "__init__" && name != "__setstate__" && name != "__call__") continue;
    const bool is_static = Py_TYPE(value.ptr()) == &PyStaticMethod_Type;
    if (!is_static && !PyInstanceMethod_Check(value.ptr())) continue;
    const py::object function = is_static ? value.attr("__func__")
                                          : py::reinterpret_borrow<py::object>(PyInstanceMethod_Function(value.ptr()));
    if (PyCFunction_Check(function.ptr())) add_refusal(cls, name, function, !is_static);
  }
}

}  // namespace

void refuse_wrong_calls(const std::vector<py::type>& classes) {
  for (const py::type& cls : classes) visit_class(cls);
}

}  // namespace polhode::python
