#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <cmath>
#include <optional>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/inertia/mass_properties.hpp"
#include "polhode/inertia/shapes.hpp"

namespace polhode::python {

void bind_inertia_mesh(py::module_& m, py::class_<MassProperties>& cls);  // bind_inertia_mesh.cpp

namespace {

py::ssize_t hash_numbers(const Array& array) { return py::hash(py::tuple(array.attr("ravel")().attr("tolist")())); }

std::string to_repr(const InertiaTensor& tensor) {
  return "InertiaTensor(" + array_text(from_matrix3(tensor.matrix())) + (tensor.physical() ? ")" : ", physical=False)");
}

void bind_principal_axes(py::module_& m) {
  py::class_<PrincipalAxes> cls(m, "PrincipalAxes", R"(Principal moments and axes, and which directions are arbitrary.

Made by :meth:`InertiaTensor.principal`.)");
  cls.attr("__module__") = "polhode";
  cls.def_property_readonly(
         "moments", [](const PrincipalAxes& p) { return from_vector3(p.moments); },
         "(3,) principal moments, ascending [kg m^2].")
      .def_property_readonly(
          "axes", [](const PrincipalAxes& p) { return from_matrix3(p.axes); },
          "(3, 3) R_BP: the columns are the principal axes in the given axes, right-handed.")
      .def_property_readonly(
          "symmetry", [](const PrincipalAxes& p) { return to_text(p.symmetry); },
          "'spherical', 'oblate' (the largest moment apart), 'prolate' (the smallest) or 'triaxial'.")
      .def_property_readonly(
          "arbitrary", [](const PrincipalAxes& p) { return to_text(p.arbitrary()); },
          "'none', 'plane' (every direction across `normal`) or 'sphere' (every direction).")
      .def_property_readonly(
          "normal",
          [](const PrincipalAxes& p) -> std::optional<Array> {
            if (p.arbitrary() != Arbitrary::plane) return std::nullopt;
            return from_vector3(p.normal());
          },
          "(3,) the axis across the arbitrary plane, in the given axes; None when there is no such plane.")
      .def(py::self == py::self)
      .def("__hash__", [](const PrincipalAxes& p) { return hash_numbers(from_matrix3(p.axes)); })
      .def("__repr__", [](const PrincipalAxes& p) {
        std::string text = "PrincipalAxes(moments=" + array_text(from_vector3(p.moments)) +
                           ", axes=" + array_text(from_matrix3(p.axes)) + ", symmetry='" + to_text(p.symmetry) +
                           "', arbitrary='" + to_text(p.arbitrary()) + "'";
        if (p.arbitrary() == Arbitrary::plane) text += ", normal=" + array_text(from_vector3(p.normal()));
        return text + ")";
      });
  cls.def(py::pickle(
      [](const PrincipalAxes& p) {
        return py::make_tuple(from_vector3(p.moments), from_matrix3(p.axes), static_cast<int>(p.symmetry));
      },
      [](const py::tuple& state) {
        return from_state("PrincipalAxes", state, 3, [](const py::tuple& s) {
          return PrincipalAxes{to_vector3(s[0], "moments"), to_matrix3(s[1], "axes"),
                               static_cast<Symmetry>(s[2].cast<int>() & 3)};
        });
      }));
}

void bind_tensor(py::module_& m) {
  py::class_<InertiaTensor> cls(m, "InertiaTensor", R"(Inertia tensor of a body about a stated point, in given axes.

The angular momentum is L = matrix @ omega, so the products of inertia stand in the matrix with their minus sign,
I_xy = -sum of m x y. A tensor that no body can have is refused, by relative thresholds. A rod's zero axial moment and a
point's zero tensor are valid. Tensors never change, compare and hash by value; arrays read from one are copies.

Parameters
----------
matrix : array_like, shape (3, 3)
    In axes B [kg m^2]. Entries across the diagonal may differ by 1e-12 of the largest one; their mean is taken.
physical : bool
    False gives up the triangle inequality (no moment above the sum of the two others), for published cases that break
    it. Symmetry and moments that are not negative are asked for all the same.

Raises
------
InvalidInput
    Wrong shape, not finite, not symmetric, a negative moment, or a moment above the sum of the two others; with the
    axis, the deficit in per cent and the likely cause.)");
  cls.attr("__module__") = "polhode";
  cls.def(py::init(
              [](py::handle matrix, bool physical) { return InertiaTensor(to_tensor(matrix, "inertia"), physical); }),
          py::arg("matrix"), py::kw_only(), py::arg("physical") = true)
      .def_static(
          "from_moments",
          [](py::handle moments, bool physical) {
            return InertiaTensor::from_moments(to_moments(moments, "moments"), physical);
          },
          py::arg("moments"), py::kw_only(), py::arg("physical") = true,
          R"(The tensor with these moments about the given axes, in their order: unsorted is fine.

Parameters
----------
moments : array_like, shape (3,)
    About x, y, z [kg m^2].
physical : bool
    As for the class.)")
      .def_property_readonly(
          "matrix", [](const InertiaTensor& t) { return from_matrix3(t.matrix()); },
          "(3, 3) the tensor in the given axes, exactly symmetric [kg m^2].")
      .def_property_readonly(
          "moments", [](const InertiaTensor& t) { return from_vector3(t.moments()); },
          "(3,) principal moments, ascending [kg m^2].")
      .def_property_readonly(
          "axes", [](const InertiaTensor& t) { return from_matrix3(t.axes()); },
          "(3, 3) R_BP: the columns are the principal axes in the given axes, right-handed, in the moments' order; "
          "the\n"
          "signs by the rule of :func:`polhode.inertia.principal_axes`.")
      .def_property_readonly(
          "symmetry", [](const InertiaTensor& t) { return to_text(t.symmetry()); },
          "'spherical', 'oblate' (the largest moment apart), 'prolate' (the smallest) or 'triaxial'.")
      .def_property_readonly("physical", &InertiaTensor::physical, "True if the triangle inequality was checked.")
      .def(
          "principal",
          [](const InertiaTensor& t, py::object gap) {
            return gap.is_none() ? t.principal() : t.principal(to_real(gap, "gap"));
          },
          py::arg("gap") = py::none(),
          R"(Moments, axes, symmetry and which directions are arbitrary, in one object.

Parameters
----------
gap : float, optional
    Moments closer than this part of the largest count as equal. By default 16 units of rounding, 3.6e-15; data with six
    digits need 1e-6.

Returns
-------
PrincipalAxes)")
      .def(
          "about_axis",
          [](const InertiaTensor& t, py::handle direction) { return t.about_axis(to_vector3(direction, "direction")); },
          py::arg("direction"),
          R"(Moment of inertia about the line through the point of reference along a direction [kg m^2].

Parameters
----------
direction : array_like, shape (3,)
    In the given axes, of any length but zero.)")
      .def(
          "rotated",
          [](const InertiaTensor& t, py::handle rotation) { return t.rotated(to_attitude(rotation, "rotation")); },
          py::arg("rotation"),
          R"(The tensor in axes A, R_AB @ matrix @ R_AB.T.

Parameters
----------
rotation : Rotation or array_like, shape (4,)
    Takes components in the given axes B to components in A; a quaternion is scalar last.)")
      .def(py::self == py::self)
      .def("__hash__", [](const InertiaTensor& t) { return hash_numbers(from_matrix3(t.matrix())); })
      .def("__repr__", &to_repr)
      .def(py::pickle([](const InertiaTensor& t) { return py::make_tuple(from_matrix3(t.matrix()), t.physical()); },
                      [](const py::tuple& state) {
                        return from_state("InertiaTensor", state, 2, [](const py::tuple& s) {
                          return InertiaTensor::from_trusted(to_matrix3(s[0], "inertia"), s[1].cast<bool>());
                        });
                      }));
}

void bind_mass_properties(py::module_& m) {
  py::class_<MassProperties> cls(m, "MassProperties", R"(Mass, centre of mass and inertia of a body.

Parameters
----------
mass : float
    Positive [kg].
com : array_like, shape (3,)
    Centre of mass, from the origin of the body's axes B [m].
inertia : InertiaTensor or array_like, shape (3, 3)
    About the centre of mass, in axes B [kg m^2].

Raises
------
InvalidInput
    A mass that is not positive, anything not finite, and what InertiaTensor refuses.)");
  cls.attr("__module__") = "polhode";
  cls.def(py::init([](py::handle mass, py::handle com, py::handle inertia) {
            const double kilograms = to_real(mass, "mass");
            const Vector3d com_B = to_vector3(com, "com");
            if (py::isinstance<InertiaTensor>(inertia)) {
              return MassProperties(kilograms, com_B, inertia.cast<const InertiaTensor&>());
            }
            return MassProperties(kilograms, com_B, InertiaTensor(to_tensor(inertia, "inertia")));
          }),
          py::arg("mass"), py::arg("com"), py::arg("inertia"))
      .def_static(
          "from_points",
          [](py::handle masses, py::handle positions) {
            const Array weights = to_array(masses, "masses"), points = to_array_with_tail(positions, "positions", {3});
            if (weights.ndim() != 1 || points.ndim() != 2 || points.shape(0) != weights.shape(0)) {
              throw InvalidInput(
                  "positions", "of shape (n, 3) for masses of shape (n,)",
                  std::to_string(points.size() / 3) + " positions for " + std::to_string(weights.size()) + " masses");
            }
            require_finite(points, "positions");
            return MassProperties::from_points(weights.data(), points.data(), static_cast<std::size_t>(weights.size()));
          },
          py::arg("masses"), py::arg("positions"),
          R"(A rigid set of point masses.

Parameters
----------
masses : array_like, shape (n,)
    All positive [kg].
positions : array_like, shape (n, 3)
    In the body's axes [m].)")
      .def_static(
          "from_tensor",
          [](py::handle mass, py::handle com, py::handle inertia, py::handle about) {
            const InertiaTensor tensor = py::isinstance<InertiaTensor>(inertia)
                                             ? inertia.cast<const InertiaTensor&>()
                                             : InertiaTensor(to_tensor(inertia, "inertia"));
            return MassProperties::from_tensor(to_real(mass, "mass"), to_vector3(com, "com"), tensor,
                                               to_vector3(about, "about"));
          },
          py::arg("mass"), py::arg("com"), py::arg("inertia"), py::kw_only(),
          py::arg("about") = py::make_tuple(0, 0, 0),
          R"(From a tensor about another point, as CAD reports give it: the parallel axes theorem, backwards.

Parameters
----------
mass : float
    Positive [kg].
com : array_like, shape (3,)
    Centre of mass, from the origin of the body's axes [m].
inertia : InertiaTensor or array_like, shape (3, 3)
    About the point `about`, in the body's axes [kg m^2].
about : array_like, shape (3,)
    From the origin [m]; the origin itself unless given.

Raises
------
InvalidInput
    When no body has them: the tensor about the centre of mass has a negative moment, or one above the sum of the two
    others.)")
      .def_property_readonly("mass", &MassProperties::mass, "Mass [kg].")
      .def_property_readonly(
          "com", [](const MassProperties& p) { return from_vector3(p.com()); },
          "(3,) centre of mass, from the origin, in the body's axes [m].")
      .def_property_readonly(
          "inertia", [](const MassProperties& p) { return p.inertia(); },
          "InertiaTensor about the centre of mass, in the body's axes.")
      .def(
          "about", [](const MassProperties& p, py::handle point) { return p.about(to_vector3(point, "point")); },
          py::arg("point"),
          R"(InertiaTensor about another point: the parallel axes theorem.

Parameters
----------
point : array_like, shape (3,)
    From the origin, in the body's axes [m].)")
      .def(
          "moved",
          [](const MassProperties& p, py::handle rotation, py::handle translation) {
            return p.moved(to_attitude(rotation, "rotation"), to_vector3(translation, "translation"));
          },
          py::arg("rotation") = py::make_tuple(0, 0, 0, 1), py::arg("translation") = py::make_tuple(0, 0, 0),
          R"(The same body placed elsewhere: its point p goes to R_AB p + translation.

Parameters
----------
rotation : Rotation or array_like, shape (4,)
    Takes components in the body's axes B to components in A; a quaternion is scalar last.
translation : array_like, shape (3,)
    In axes A [m].)")
      .def(py::self + py::self, "Both bodies as one, given in the same axes from the same origin.")
      .def(py::self - py::self, "The first body with the second taken out of it; refused when no body is left.")
      .def(py::self == py::self)
      .def("__hash__",
           [](const MassProperties& p) {
             return py::hash(py::make_tuple(p.mass(), hash_numbers(from_vector3(p.com())),
                                            hash_numbers(from_matrix3(p.inertia().matrix()))));
           })
      .def("__repr__",
           [](const MassProperties& p) {
             return "MassProperties(mass=" + to_text(p.mass()) + ", com=" + array_text(from_vector3(p.com())) +
                    ", inertia=" + to_repr(p.inertia()) + ")";
           })
      .def(py::pickle(
          [](const MassProperties& p) { return py::make_tuple(p.mass(), from_vector3(p.com()), p.inertia()); },
          [](const py::tuple& state) {
            return from_state("MassProperties", state, 3, [](const py::tuple& s) {
              return MassProperties(s[0].cast<double>(), to_vector3(s[1], "com"), s[2].cast<const InertiaTensor&>());
            });
          }));
  bind_inertia_mesh(m, cls);
}

/// All parameters of a shape, one after the other, each checked against its size.
std::vector<double> shape_numbers(const shapes::Record& record, const py::sequence& values) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < record.parameters.size(); ++i) {
    const auto& [name, size, doc] = record.parameters[i];
    const py::object value = values[i];
    if (size.empty()) {
      numbers.push_back(to_real(value, name.c_str()));
    } else if (size.size() == 1) {
      const Vector3d v = to_vector3(value, name.c_str());
      numbers.insert(numbers.end(), v.data(), v.data() + 3);
    } else {
      const Array array = to_array_with_tail(value, name.c_str(), {size[1]});
      if (array.ndim() != 2 || array.shape(0) != size[0]) {
        throw InvalidInput(name, "of shape (" + std::to_string(size[0]) + ", " + std::to_string(size[1]) + ")",
                           "shape " + py::cast<std::string>(py::str(array.attr("shape"))));
      }
      require_finite(array, name.c_str());
      numbers.insert(numbers.end(), array.data(), array.data() + array.size());
    }
  }
  return numbers;
}

void bind_shapes(py::module_& m) {
  m.def(
      "shape_records",
      [] {
        py::list records;
        for (const shapes::Record& record : shapes::all()) {
          py::list parameters;
          for (const auto& p : record.parameters)
            parameters.append(py::make_tuple(p.name, py::tuple(py::cast(p.size)), p.doc));
          records.append(py::make_tuple(record.name, record.doc, py::tuple(parameters)));
        }
        return records;
      },
      "(name, doc, ((parameter, size, doc), ...)) of every shape.");
  m.def(
      "make_shape",
      [](const std::string& name, const py::sequence& values) {
        const shapes::Record& record = shapes::find(name);
        return record.make(shape_numbers(record, values).data());
      },
      py::arg("name"), py::arg("values"), "The body from all its parameters, in the record's order.");
  m.def(
      "shape_volume",
      [](const std::string& name, const py::sequence& values) {
        const shapes::Record& record = shapes::find(name);
        if (record.volume == nullptr)
          throw InvalidInput("shape", "one with a volume", name, "a thin body: give its mass");
        const std::vector<double> numbers = shape_numbers(record, values);
        record.make(numbers.data());  // refuses what is no body
        const auto volume = static_cast<double>(record.volume(numbers.data() + 1));
        if (!std::isfinite(volume)) {
          throw InvalidInput(name, "of a volume within float64", to_text(volume), "choose a larger unit of length");
        }
        return volume;
      },
      py::arg("name"), py::arg("values"), "The volume of a body, from all its parameters, in the record's order.");
}

py::typing::Tuple<Array, Array, py::int_> principal_axes(py::handle value) {
  const Array matrices = to_array_with_tail(value, "matrices", {3, 3});
  std::vector<py::ssize_t> shape(matrices.shape(), matrices.shape() + matrices.ndim());
  Array axes(shape);
  shape.pop_back();
  Array moments(shape);
  std::size_t not_finite = 0;
  {
    const double* const in = matrices.data();
    double* const out_moments = moments.mutable_data();
    double* const out_axes = axes.mutable_data();
    const auto count = static_cast<std::size_t>(matrices.size() / 9);
    in_parts(count, [&](std::size_t begin, std::size_t part) {
      not_finite += compute_principal_axes(in + 9 * begin, part, out_moments + 3 * begin, out_axes + 9 * begin);
      return part;
    });
  }
  return py::make_tuple(moments, axes, not_finite);
}

}  // namespace

void bind_inertia(py::module_& m) {
  bind_principal_axes(m);
  bind_tensor(m);
  bind_mass_properties(m);
  bind_shapes(m);
  m.def("principal_axes", &principal_axes, py::arg("matrices"),
        "(moments, axes, number of matrices that are not finite); see polhode.inertia.principal_axes.");
}

}  // namespace polhode::python
