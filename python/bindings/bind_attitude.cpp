#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/attitude/detail/arrays.hpp"
#include "polhode/attitude/kinematics.hpp"
#include "polhode/attitude/matrix.hpp"
#include "polhode/core/error.hpp"

// Arrays in, arrays out: (..., k) of one thing to (..., m) of the other. The class is python/polhode/attitude.py.
namespace polhode::python {
namespace {

using Shape = std::vector<py::ssize_t>;

EulerSequence to_sequence(py::handle value) {
  if (py::isinstance<py::str>(value)) return EulerSequence(value.cast<std::string>());
  throw InvalidInput("sequence", "three axes such as 'ZXZ' (intrinsic) or 'zxz' (extrinsic)",
                     std::string(py::str(py::type::of(value))));
}

/// The shape without its last `dropped` dimensions, then the new ones.
Shape with_tail(const Array& array, py::ssize_t dropped, std::initializer_list<py::ssize_t> tail) {
  Shape shape(array.shape(), array.shape() + array.ndim() - dropped);
  shape.insert(shape.end(), tail);
  return shape;
}

std::size_t rows(const Array& array, std::size_t width) { return static_cast<std::size_t>(array.size()) / width; }

std::string at_row(const char* name, std::size_t row, const Array& array, py::ssize_t tail) {
  return array.ndim() == tail ? std::string(name) : std::string(name) + "[" + std::to_string(row) + "]";
}

/// Two operands (..., wide_a) and (..., wide_b), their leading dimensions broadcast as NumPy does; one without leading
/// dimensions is not repeated in memory but read with step 0.
struct Pair {
  Array a, b;
  std::size_t n, step_a, step_b;
  Shape shape;  ///< of the result, (..., width)

  Pair(Array a_in, const char* name_a, Array b_in, const char* name_b, py::ssize_t width)
      : a(std::move(a_in)), b(std::move(b_in)) {
    if (a.ndim() > 1 && b.ndim() > 1 && with_tail(a, 1, {}) != with_tail(b, 1, {})) broadcast(name_a, name_b);
    const Array& longer = a.ndim() > 1 ? a : b;
    const auto width_a = static_cast<std::size_t>(a.shape(a.ndim() - 1));
    const auto width_b = static_cast<std::size_t>(b.shape(b.ndim() - 1));
    n = a.ndim() > 1 ? rows(a, width_a) : rows(b, width_b);
    step_a = a.ndim() > 1 ? width_a : 0;
    step_b = b.ndim() > 1 ? width_b : 0;
    shape = with_tail(longer, 1, {width});
  }

 private:
  void broadcast(const char* name_a, const char* name_b) {
    const py::module_ numpy = py::module_::import("numpy");
    const py::tuple lead_a = py::cast(with_tail(a, 1, {})), lead_b = py::cast(with_tail(b, 1, {}));
    py::object lead;
    try {
      lead = numpy.attr("broadcast_shapes")(lead_a, lead_b);
    } catch (const py::error_already_set&) {
      throw InvalidInput(name_b, std::string("as many as ") + name_a + ", or one, or of shapes that broadcast",
                         std::string(py::str(lead_b)) + " to " + std::string(py::str(lead_a)));
    }
    for (Array* operand : {&a, &b}) {
      const py::tuple width = py::make_tuple(operand->shape(operand->ndim() - 1));
      *operand = Array::ensure(numpy.attr("broadcast_to")(*operand, lead + width));
    }
  }
};

double unit_of(bool degrees) { return degrees ? arrays::kDegrees : arrays::kRadians; }

Array normalize(py::handle value, bool scalar_first) {
  Array q = to_array_with_tail(value, "quat", {4});
  if (scalar_first) {
    const Array given = q;
    q = Array(with_tail(given, 0, {}));
    for (py::ssize_t i = 0; i < q.size(); ++i) q.mutable_data()[i] = given.data()[i % 4 == 3 ? i - 3 : i + 1];
  }
  Array out(with_tail(q, 0, {}));
  const std::size_t n = rows(q, 4);
  const double* in = q.data();
  double* unit = out.mutable_data();
  const std::size_t refused = in_parts(n, [&](std::size_t begin, std::size_t count) {
    return arrays::normalize(count, in + 4 * begin, unit + 4 * begin);
  });
  if (refused == n) return out;
  require_finite(q, "quat");
  const double* p = in + 4 * refused;
  const double size = norm({p[0], p[1], p[2], p[3]});
  throw InvalidInput(at_row("quat", refused, q, 1), "a unit quaternion (x, y, z, w) within 1e-6",
                     "norm " + to_text(size),
                     size == 0.0 ? "no attitude has norm 0" : "normalise it first, if it is meant to be an attitude");
}

/// One or two letters as three, whose missing angles are 0.
EulerSequence widened(py::handle value, std::size_t& letters) {
  const std::string text = py::isinstance<py::str>(value) ? value.cast<std::string>() : "";
  letters = text.size() == 1 || text.size() == 2 ? text.size() : 3;
  if (letters == 3) return to_sequence(value);
  std::string all = text;
  if (letters == 1) all += text == "z" || text == "Z" ? static_cast<char>(text[0] - 2) : static_cast<char>(text[0] + 1);
  try {
    return EulerSequence(all + text[0]);
  } catch (const InvalidInput&) {
    throw InvalidInput("sequence", "one to three axes such as 'Z', 'zx' or 'ZXZ'", "'" + text + "'");
  }
}

/// The angles (..., letters), one letter's also a plain number, as (..., 3).
Array wide_angles(py::handle value, std::size_t letters) {
  if (letters == 3) return to_array_with_tail(value, "angles", {3});
  Array given = to_array(value, "angles");
  const auto width = static_cast<py::ssize_t>(letters);
  if (given.ndim() > 0 || width > 1) given = to_array_with_tail(value, "angles", {width});
  Array wide(given.ndim() > 0 ? with_tail(given, 1, {3}) : Shape{3});
  double* out = wide.mutable_data();
  for (std::size_t i = 0; i < rows(wide, 3); ++i)
    for (std::size_t k = 0; k < 3; ++k) out[3 * i + k] = k < letters ? given.data()[letters * i + k] : 0.0;
  return wide;
}

Array from_euler(py::handle seq, py::handle value, bool degrees) {
  std::size_t letters;
  const EulerSequence sequence = widened(seq, letters);
  const Array angles = wide_angles(value, letters);
  Array q(with_tail(angles, 1, {4}));
  const std::size_t n = rows(angles, 3);
  const double* in = angles.data();
  double* out = q.mutable_data();
  const std::size_t refused = in_parts(n, [&](std::size_t begin, std::size_t count) {
    return arrays::quat_from_euler(sequence, count, in + 3 * begin, unit_of(degrees), out + 4 * begin);
  });
  if (refused != n) require_finite(angles, "angles");
  return q;
}

/// Rows (..., 4) to rows (..., tail) by a kernel that refuses nothing.
template <class Out, class Kernel, class Result = py::array_t<Out, plain>>
Result convert(const Array& q, std::initializer_list<py::ssize_t> tail, const Kernel& kernel) {
  Result result(with_tail(q, 1, tail));
  const std::size_t n = rows(q, 4);
  const double* in = q.data();
  Out* out = result.mutable_data();
  const std::size_t width = n == 0 ? 0 : static_cast<std::size_t>(result.size()) / n;
  in_parts(n, [&](std::size_t begin, std::size_t count) {
    kernel(count, in + 4 * begin, out + width * begin);
    return count;
  });
  return result;
}

Array as_euler(py::handle seq, const Array& q, bool degrees) {
  const EulerSequence sequence = to_sequence(seq);
  return convert<double>(q, {3}, [&](std::size_t n, const double* in, double* out) {
    arrays::to_euler(sequence, n, in, unit_of(degrees), out);
  });
}

py::array_t<bool> gimbal_lock_of(py::handle seq, const Array& q) {
  const EulerSequence sequence = to_sequence(seq);
  return convert<bool>(q, {}, [&](std::size_t n, const double* in, bool* out) {
    arrays::gimbal_lock(sequence, n, in, out);
  });
}

Array as_rotvec(const Array& q, bool degrees) {
  return convert<double>(q, {3}, [&](std::size_t n, const double* in, double* out) {
    arrays::to_rotation_vector(n, in, unit_of(degrees), out);
  });
}

Array as_matrix(const Array& q) { return convert<double>(q, {3, 3}, arrays::to_matrix); }
Array magnitude(const Array& q) { return convert<double>(q, {}, arrays::rotation_angle); }
Array canonical_of(const Array& q) { return convert<double>(q, {4}, arrays::canonical); }
Array conjugate_of(const Array& q) { return convert<double>(q, {4}, arrays::conjugate); }

Array from_matrix(py::handle value) {
  const Array matrix = to_array_with_tail(value, "matrix", {3, 3});
  Array q(with_tail(matrix, 2, {4}));
  const std::size_t n = rows(matrix, 9);
  const double* in = matrix.data();
  double* out = q.mutable_data();
  const std::size_t refused = in_parts(n, [&](std::size_t begin, std::size_t count) {
    return arrays::quat_from_matrix(count, in + 9 * begin, out + 4 * begin);
  });
  if (refused == n) return q;
  require_finite(matrix, "matrix");
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> found(in + 9 * refused);
  quat_from_matrix(found, at_row("matrix", refused, matrix, 2));  // throws, with the reason
  return q;
}

Array from_rotvec(py::handle value, bool degrees) {
  const Array rotvec = to_array_with_tail(value, "rotvec", {3});
  Array q(with_tail(rotvec, 1, {4}));
  const std::size_t n = rows(rotvec, 3);
  const double* in = rotvec.data();
  double* out = q.mutable_data();
  const std::size_t refused = in_parts(n, [&](std::size_t begin, std::size_t count) {
    return arrays::quat_from_rotation_vector(count, in + 3 * begin, unit_of(degrees), out + 4 * begin);
  });
  if (refused != n) require_finite(rotvec, "rotvec");
  return q;
}

template <auto kernel>
Array multiply(const Array& q_AB, const Array& q_BC) {
  const Pair pair(q_AB, "the left rotations", q_BC, "the right rotations", 4);
  Array q_AC(pair.shape);
  const double *a = pair.a.data(), *b = pair.b.data();
  double* out = q_AC.mutable_data();
  in_parts(pair.n, [&](std::size_t begin, std::size_t count) {
    kernel(count, a + pair.step_a * begin, pair.step_a, b + pair.step_b * begin, pair.step_b, out + 4 * begin);
    return count;
  });
  return q_AC;
}

Array apply(const Array& q, py::handle value, bool inverse) {
  const Pair pair(q, "the rotations", to_array_with_tail(value, "vectors", {3}), "vectors", 3);
  Array rotated(pair.shape);
  const double *a = pair.a.data(), *v = pair.b.data();
  double* out = rotated.mutable_data();
  const std::size_t refused = in_parts(pair.n, [&](std::size_t begin, std::size_t count) {
    return arrays::rotate(count, a + pair.step_a * begin, pair.step_a, v + pair.step_b * begin, pair.step_b, inverse,
                          out + 3 * begin);
  });
  if (refused != pair.n) require_finite(pair.b, "vectors");
  return rotated;
}

Pair rates_pair(py::handle angles_value, py::handle other_value, const char* other_name) {
  Array angles = to_array_with_tail(angles_value, "angles", {3});
  Array other = to_array_with_tail(other_value, other_name, {3});
  require_finite(angles, "angles");
  require_finite(other, other_name);
  return Pair(std::move(angles), "angles", std::move(other), other_name, 3);
}

Array body_rates_of(py::handle seq, py::handle angles, py::handle angle_rates) {
  const EulerSequence sequence = to_sequence(seq);
  const Pair pair = rates_pair(angles, angle_rates, "angle_rates");
  Array omega(pair.shape);
  const double *a = pair.a.data(), *rates = pair.b.data();
  double* out = omega.mutable_data();
  in_parts(pair.n, [&](std::size_t begin, std::size_t count) {
    arrays::body_rates(sequence, count, a + pair.step_a * begin, pair.step_a, rates + pair.step_b * begin, pair.step_b,
                       out + 3 * begin);
    return count;
  });
  return omega;
}

Array euler_rates_of(py::handle seq, py::handle angles, py::handle omega) {
  const EulerSequence sequence = to_sequence(seq);
  const Pair pair = rates_pair(angles, omega, "omega");
  Array rates(pair.shape);
  const double *a = pair.a.data(), *w = pair.b.data();
  double* out = rates.mutable_data();
  const std::size_t refused = in_parts(pair.n, [&](std::size_t begin, std::size_t count) {
    return arrays::euler_rates(sequence, count, a + pair.step_a * begin, pair.step_a, w + pair.step_b * begin,
                               pair.step_b, out + 3 * begin);
  });
  if (refused == pair.n) return rates;
  const double *angle = a + pair.step_a * refused, *w_B = w + pair.step_b * refused;
  euler_rates(sequence, {angle[0], angle[1], angle[2]}, {w_B[0], w_B[1], w_B[2]},
              at_row("angles", refused, pair.a, 1));  // throws, with the reason
  return rates;
}

}  // namespace

void bind_attitude(py::module_& m) {
  py::module_ a = m.def_submodule("attitude", "Kernels of polhode.attitude on arrays (..., 4) of unit quaternions.");
  a.def("normalize", &normalize, py::arg("quat"), py::arg("scalar_first"));
  a.def("canonical", &canonical_of, py::arg("quat"));
  a.def("conjugate", &conjugate_of, py::arg("quat"));
  a.def("from_euler", &from_euler, py::arg("sequence"), py::arg("angles"), py::arg("degrees"));
  a.def("as_euler", &as_euler, py::arg("sequence"), py::arg("quat"), py::arg("degrees"));
  a.def("gimbal_lock", &gimbal_lock_of, py::arg("sequence"), py::arg("quat"));
  a.def("from_matrix", &from_matrix, py::arg("matrix"));
  a.def("as_matrix", &as_matrix, py::arg("quat"));
  a.def("from_rotvec", &from_rotvec, py::arg("rotvec"), py::arg("degrees"));
  a.def("as_rotvec", &as_rotvec, py::arg("quat"), py::arg("degrees"));
  a.def("magnitude", &magnitude, py::arg("quat"));
  a.def("multiply", &multiply<&arrays::multiply>, py::arg("quat_AB"), py::arg("quat_BC"), "Of unit quaternions, unit.");
  a.def("product", &multiply<&arrays::product>, py::arg("quat_AB"), py::arg("quat_BC"), "Of any quaternions.");
  a.def("apply", &apply, py::arg("quat"), py::arg("vectors"), py::arg("inverse"));
  a.def("body_rates", &body_rates_of, py::arg("sequence"), py::arg("angles"), py::arg("angle_rates"));
  a.def("euler_rates", &euler_rates_of, py::arg("sequence"), py::arg("angles"), py::arg("omega"));
}

}  // namespace polhode::python
