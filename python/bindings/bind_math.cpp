#include <algorithm>

#include <pybind11/typing.h>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/elliptic.hpp"

namespace polhode::python {
namespace {

using elliptic::Parameter;

void require_equal_sizes(const Array& a, const Array& b, const char* name) {
  if (a.size() != b.size()) throw InvalidInput(name, "broadcast with the others", "another size");
}

/// Calls use(i, parameter) for each pair, computing constants only where the pair changes.
template <class Use>
void for_each(const double* m, const double* m1, py::ssize_t n, Use use) {
  if (n == 0) return;
  Parameter parameter(m[0], m1[0]);
  for (py::ssize_t i = 0; i < n; ++i) {
    if (i % 1024 == 0) check_interrupt();
    if (i > 0 && (m[i] != m[i - 1] || m1[i] != m1[i - 1])) parameter = Parameter(m[i], m1[i]);
    use(i, parameter);
  }
}

py::typing::Tuple<Array, Array, Array> jacobi(const Array& u, const Array& m, const Array& m1) {
  require_equal_sizes(u, m, "m");
  require_equal_sizes(u, m1, "m1");
  const py::ssize_t n = u.size();
  Array sn(n), cn(n), dn(n);
  const double *pu = u.data(), *pm = m.data(), *pm1 = m1.data();
  double *ps = sn.mutable_data(), *pc = cn.mutable_data(), *pd = dn.mutable_data();
  {
    const WithoutGil nogil;
    for_each(pm, pm1, n, [=](py::ssize_t i, const Parameter& parameter) {
      const elliptic::Jacobi j = parameter.jacobi(pu[i]);
      ps[i] = j.sn, pc[i] = j.cn, pd[i] = j.dn;
    });
  }
  return py::make_tuple(sn, cn, dn);
}

template <double (Parameter::*value)() const>
Array complete(const Array& m, const Array& m1) {
  require_equal_sizes(m, m1, "m1");
  Array result(m.size());
  const double *pm = m.data(), *pm1 = m1.data();
  double* out = result.mutable_data();
  const py::ssize_t n = m.size();
  const WithoutGil nogil;
  for_each(pm, pm1, n, [=](py::ssize_t i, const Parameter& parameter) { out[i] = (parameter.*value)(); });
  return result;
}

}  // namespace

// Flat arrays of one size: polhode.elliptic broadcasts.
void bind_math(py::module_& m) {
  m.def("_jacobi", &jacobi);
  m.def("_complete_K", &complete<&Parameter::K>);
  m.def("_nome", &complete<&Parameter::nome>);
}

}  // namespace polhode::python
