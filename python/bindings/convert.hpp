#pragma once

#include <pybind11/numpy.h>

#include "bind.hpp"
#include "polhode/core/quat.hpp"

// What comes from Python is checked here, once. Every refusal is an InvalidInput (a ValueError) that names the
// argument, also where pybind11 by itself would say TypeError.
namespace polhode::python {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Any array-like of real numbers as a C-contiguous float64 array (no copy when it is one already).
/// Refused: complex, text, objects, ragged lists. NaN and inf pass: see require_finite.
Array to_array(py::handle value, const char* name);

/// Throws unless every entry is finite.
void require_finite(const Array& array, const char* name);

/// to_array with the shape (..., last...) asked for: `tail` gives the last dimensions, e.g. {3} or {3, 3}.
Array to_array_with_tail(py::handle value, const char* name, std::initializer_list<py::ssize_t> tail);

double to_real(py::handle value, const char* name);             ///< one finite number
Vector3d to_vector3(py::handle value, const char* name);        ///< shape (3,), finite
Matrix3d to_matrix3(py::handle value, const char* name);        ///< shape (3, 3), finite

/// One attitude: (4,) scalar last, or any object with as_quat() (polhode's and SciPy's Rotation); unit, or refused.
Quat to_attitude(py::handle value, const char* name);

Array from_vector3(const Vector3d& v);
Array from_matrix3(const Matrix3d& m);
Array from_quat(const Quat& q);

}  // namespace polhode::python
