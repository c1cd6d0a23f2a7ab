#include <pybind11/typing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/batch/summary.hpp"
#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

using Of = SummaryQuantity::Of;

std::vector<double> to_numbers(const py::handle value, const char* name) {
  const Array array = to_array(value, name);
  require_finite(array, name);
  return {array.data(), array.data() + array.size()};
}

/// n with 2^n <= |x| (down) or 2^n >= |x|.
int to_exponent(py::handle value, const char* name, bool down) {
  const double x = to_real(value, name);
  if (!(x > 0.0)) throw InvalidInput(name, "positive", to_text(x));
  int n = 0;
  const double m = std::frexp(x, &n);   // x = m 2^n, 1/2 <= m < 1
  return down || m == 0.5 ? n - 1 : n;
}

SummaryQuantity to_quantity(const py::dict& given) {
  constexpr const char* names[] = {"angle", "axis_angle", "omega", "energy", "value", "attitude"};
  if (!given.contains("of")) throw InvalidInput("quantities", "with 'of' in each", "none");
  const std::string of = given["of"].cast<std::string>();
  const auto found = std::find(std::begin(names), std::end(names), of);
  if (found == std::end(names))
    throw InvalidInput("of", "angle, axis_angle, omega, energy, value or attitude", of);
  SummaryQuantity q;
  q.of = static_cast<Of>(found - std::begin(names));
  for (const auto& [key, value] : given) {
    const std::string name = key.cast<std::string>();
    const bool nominal = name == "nominal" && (q.of == Of::angle || q.of == Of::attitude);
    if (name == "of") continue;
    if (nominal || (name == "target" && q.of == Of::axis_angle)) {
      q.reference = to_numbers(value, nominal ? "nominal" : "target");
    } else if (name == "axis" && q.of == Of::axis_angle) {
      const Vector3d axis = to_vector3(value, "axis");
      q.axis = {axis[0], axis[1], axis[2]};
    } else if (name == "least" && q.of != Of::attitude) {
      q.first = to_exponent(value, "least", true);
    } else if (name == "largest" && q.of != Of::attitude) {
      q.last = to_exponent(value, "largest", false);
    } else {
      throw InvalidInput("quantities", "of known entries", "'" + name + "' for " + of);
    }
  }
  if (given.contains("least") != given.contains("largest"))
    throw InvalidInput("quantities", "with both of 'least' and 'largest', or none", "one");
  return q;
}

std::vector<SummaryQuantity> to_quantities(const py::list& given) {
  std::vector<SummaryQuantity> all;
  for (const py::handle item : given) all.push_back(to_quantity(item.cast<py::dict>()));
  return all;
}

void require_shape(const Array& array, std::initializer_list<std::size_t> shape, const char* name) {
  bool same = static_cast<std::size_t>(array.ndim()) == shape.size();
  std::string text;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const std::size_t size = shape.begin()[i];
    same = same && static_cast<std::size_t>(array.shape(static_cast<py::ssize_t>(i))) == size;
    text += (i == 0 ? "(" : ", ") + std::to_string(size);
  }
  if (!same) throw InvalidInput(name, "of shape " + text + ")", "another");
}

void add_free(Summary& summary, std::uint64_t first, const py::object& inertia, const Array& omega,
              const Array& attitude, const Array& times, int threads) {
  FreeMotionBatch batch;
  batch.bodies = static_cast<std::size_t>(omega.ndim() == 2 ? omega.shape(0) : 0);
  batch.times = static_cast<std::size_t>(times.size());
  require_shape(omega, {batch.bodies, 3}, "omega");
  require_shape(attitude, {batch.bodies, 4}, "attitude");
  require_shape(times, {summary.times()}, "times");
  batch.omega = omega.data(), batch.attitude = attitude.data(), batch.t = times.data();
  Array moments;
  if (py::isinstance<InertiaTensor>(inertia)) {
    batch.tensor = &inertia.cast<const InertiaTensor&>();
  } else {
    moments = to_array(inertia, "inertia");
    require_shape(moments, {batch.bodies, 3}, "inertia");
    batch.moments = moments.data();
  }
  const WithoutGil nogil;
  summary.add_free(first, batch, threads);
}

void copy_tensor(const double* m, std::vector<double>& to) {
  for (const std::size_t i : {0u, 4u, 8u, 1u, 2u, 5u}) to.push_back(m[i]);
}

void add_states(Summary& summary, std::uint64_t first, const py::object& omega, const py::object& attitude,
                const py::object& inertia, const py::object& values) {
  Summary::States states;
  const py::object& some = omega.is_none() ? attitude.is_none() ? values : attitude : omega;
  const Array w = omega.is_none() ? Array() : to_array(omega, "omega");
  const Array q = attitude.is_none() ? Array() : to_array(attitude, "attitude");
  const Array v = values.is_none() ? Array() : to_array(values, "values");
  const Array& any = omega.is_none() ? attitude.is_none() ? v : q : w;
  if (some.is_none() || any.ndim() != 3) throw InvalidInput("omega", "of shape (bodies, times, 3)", "another");
  states.bodies = static_cast<std::size_t>(any.shape(0));
  const auto& all = summary.quantities();
  const auto count = static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](const SummaryQuantity& s) { return s.of == Of::value; }));
  if (!omega.is_none()) require_shape(w, {states.bodies, summary.times(), 3}, "omega"), states.omega = w.data();
  if (!attitude.is_none())
    require_shape(q, {states.bodies, summary.times(), 4}, "attitude"), states.attitude = q.data();
  if (!values.is_none()) require_shape(v, {states.bodies, summary.times(), count}, "values"), states.values = v.data();
  std::vector<double> tensors;
  if (py::isinstance<InertiaTensor>(inertia)) {
    const Matrix3d I = inertia.cast<const InertiaTensor&>().matrix().transpose();
    copy_tensor(I.data(), tensors);
    states.one_tensor = true;
  } else if (!inertia.is_none()) {
    const Array given = to_array(inertia, "inertia");
    const bool full = given.ndim() == 3;
    if (full) require_shape(given, {states.bodies, 3, 3}, "inertia");
    else require_shape(given, {states.bodies, 3}, "inertia");
    for (std::size_t body = 0; body < states.bodies; ++body) {
      if (full) copy_tensor(given.data() + 9 * body, tensors);
      else for (std::size_t i = 0; i < 6; ++i) tensors.push_back(i < 3 ? given.data()[3 * body + i] : 0.0);
    }
  }
  states.tensors = tensors.empty() ? nullptr : tensors.data();
  const WithoutGil nogil;
  summary.add_states(first, states);
}

template <class T>
py::array_t<T> to_python(const std::vector<T>& values, std::vector<py::ssize_t> shape) {
  py::array_t<T> array(std::move(shape));
  std::copy(values.begin(), values.end(), array.mutable_data());
  return array;
}

py::dict to_record(const Summary& summary) {
  Summary::Record record;
  {
    const WithoutGil nogil;
    record = summary.record();
  }
  const auto times = static_cast<py::ssize_t>(summary.times());
  py::list quantities;
  for (std::size_t i = 0; i < record.quantities.size(); ++i) {
    const Summary::Scalar& s = record.quantities[i];
    py::dict one;
    py::array_t<std::int64_t> count(times);
    std::transform(s.count.begin(), s.count.end(), count.mutable_data(),
                   [](double n) { return static_cast<std::int64_t>(n); });
    one["count"] = count;
    if (summary.quantities()[i].of == Of::attitude) {
      one["moments"] = to_python(s.moments, {times, 10});
    } else {
      one["sum"] = to_python(s.sum, {times}), one["sum2"] = to_python(s.sum2, {times});
      one["min"] = to_python(s.least, {times}), one["max"] = to_python(s.largest, {times});
      one["histogram"] = to_python(s.histogram, {times, static_cast<py::ssize_t>(summary.bins(i))});
    }
    quantities.append(one);
  }
  py::dict found;
  found["first"] = record.first, found["end"] = record.end, found["bodies"] = record.bodies;
  found["failed"] = record.failed, found["quantities"] = quantities;
  return found;
}

Summary from_record(const py::list& quantities, std::size_t times, const py::dict& given) {
  Summary::Record record;
  record.first = given["first"].cast<std::uint64_t>(), record.end = given["end"].cast<std::uint64_t>();
  record.bodies = given["bodies"].cast<std::uint64_t>(), record.failed = given["failed"].cast<std::uint64_t>();
  for (const py::handle item : given["quantities"].cast<py::list>()) {
    const auto one = item.cast<py::dict>();
    const auto numbers = [&one](const char* name) {
      if (!one.contains(name)) return std::vector<double>();
      const Array array = to_array(one[name], name);
      return std::vector<double>(array.data(), array.data() + array.size());
    };
    Summary::Scalar s{numbers("count"), numbers("sum"), numbers("sum2"), numbers("min"), numbers("max"), {},
                      numbers("moments")};
    if (one.contains("histogram")) {
      const auto bins = one["histogram"].cast<py::array_t<std::uint32_t, plain>>();
      s.histogram.assign(bins.data(), bins.data() + bins.size());
    }
    record.quantities.push_back(std::move(s));
  }
  return Summary::from_record(to_quantities(quantities), times, record);
}

py::typing::Tuple<Array, Array> mean_attitudes(const py::object& given) {
  const Array moments = to_array_with_tail(given, "moments", {10});
  std::vector<py::ssize_t> shape(moments.shape(), moments.shape() + moments.ndim() - 1);
  Array spread(shape);
  shape.push_back(4);
  Array attitude(shape);
  for (py::ssize_t i = 0; i < spread.size(); ++i) {
    const MeanAttitude mean = mean_attitude(moments.data() + 10 * i);
    std::copy(mean.attitude.begin(), mean.attitude.end(), attitude.mutable_data() + 4 * i);
    spread.mutable_data()[i] = mean.spread;
  }
  return py::make_tuple(attitude, spread);
}

}  // namespace

void bind_batch_summary(py::module_& m) {
  py::class_<Summary>(m, "_Summary")
      .def(py::init([](const py::list& given, std::size_t times) { return Summary(to_quantities(given), times); }),
           py::arg("quantities"), py::arg("times"))
      .def("add_free", &add_free, py::arg("first"), py::arg("inertia"), py::arg("omega"), py::arg("attitude"),
           py::arg("times"), py::arg("threads") = 0)
      .def("add_states", &add_states, py::arg("first"), py::arg("omega") = py::none(), py::arg("attitude") = py::none(),
           py::arg("inertia") = py::none(), py::arg("values") = py::none())
      .def("merge", &Summary::merge, py::arg("other"))
      .def("record", &to_record)
      .def_static("from_record", &from_record, py::arg("quantities"), py::arg("times"), py::arg("record"))
      .def("edges", [](const Summary& s, std::size_t i) {
        if (i >= s.quantities().size()) throw InvalidInput("quantity", "one of the summary's", std::to_string(i));
        const std::vector<double> edges = s.edges(i);
        return to_python(edges, {static_cast<py::ssize_t>(edges.size())});
      }, py::arg("quantity"))
      .def_property_readonly("bodies", &Summary::bodies)
      .def_property_readonly("failed", &Summary::failed)
      .def_property_readonly("times", &Summary::times);
  m.def("_mean_attitude", &mean_attitudes, py::arg("moments"));
}

}  // namespace polhode::python
