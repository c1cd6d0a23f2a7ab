#include "bind.hpp"
#include "polhode/ode/methods.hpp"

namespace polhode::python {

void bind_ode(py::module_& m) {
  m.def("method_records", [] {
    py::list list;
    for (const ode::MethodRecord& record : ode::methods()) {
      py::dict one;
      one["name"] = std::string(record.name);
      one["order"] = record.order;
      one["dense_order"] = record.dense_order;
      one["adaptive"] = record.adaptive;
      one["keeps"] = std::string(record.keeps);
      one["doc"] = std::string(record.doc);
      one["source"] = std::string(record.source);
      list.append(one);
    }
    return list;
  }, "The list of methods, a dict each.");
}

}  // namespace polhode::python
