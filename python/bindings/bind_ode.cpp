#include "bind.hpp"
#include "polhode/method/methods.hpp"

namespace polhode::python {

void bind_ode(py::module_& m) {
  m.def("method_records", [] {
    py::list list;
    for (const ode::MethodRecord& record : methods()) {
      py::dict one;
      one["name"] = std::string(record.name);
      one["order"] = record.order;
      one["driven_order"] = record.order_with_torque();
      one["dense_order"] = record.dense_order;
      one["adaptive"] = record.adaptive;
      one["implicit"] = record.implicit;
      one["comparison"] = record.comparison;
      one["keeps"] = std::string(record.keeps);
      one["needs"] = std::string(record.needs);
      one["doc"] = std::string(record.doc);
      one["source"] = std::string(record.source);
      list.append(one);
    }
    return list;
  }, "The list of methods, a dict each.");
}

}  // namespace polhode::python
