#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/inertia/mesh.hpp"

namespace polhode::python {
namespace {

/// Faces as they come, int32 or int64 without a copy, any other whole numbers as int64.
py::array to_faces(py::handle value) {
  refuse_masked(value, "faces");
  py::array faces = py::array::ensure(value);
  if (!faces) {
    PyErr_Clear();
    throw InvalidInput("faces", "an array of whole numbers", std::string(py::str(py::type::of(value))));
  }
  if (faces.size() == 0) return py::array_t<std::int64_t>(std::vector<py::ssize_t>{0, 3});
  const char kind = faces.dtype().kind();
  if (kind != 'i' && kind != 'u') {
    throw InvalidInput("faces", "an array of whole numbers",
                       "dtype " + std::string(py::str(static_cast<py::object>(faces.dtype()))));
  }
  if (faces.ndim() != 2 || faces.shape(1) != 3) {
    throw InvalidInput("faces", "of shape (n, 3): triangles",
                       "shape " + std::string(py::str(faces.attr("shape"))),
                       faces.ndim() == 2 && faces.shape(1) == 4 ? "quadrilaterals? cut each in two" : "");
  }
  if (kind == 'i' && faces.itemsize() == 4) return py::array_t<std::int32_t, plain>::ensure(faces);
  return py::array_t<std::int64_t, plain>::ensure(faces);
}

/// The arrays, kept alive, and the view of them.
struct Triangles {
  Array vertices;
  py::array faces;

  Triangles(py::handle vertices_in, py::handle faces_in)
      : vertices(to_array_with_tail(vertices_in, "vertices", {3})), faces(to_faces(faces_in)) {
    if (vertices.ndim() != 2) {
      throw InvalidInput("vertices", "of shape (n, 3)", "shape " + std::string(py::str(vertices.attr("shape"))));
    }
  }

  Mesh view() const {
    const auto vertex_count = static_cast<std::size_t>(vertices.shape(0));
    const auto face_count = static_cast<std::size_t>(faces.shape(0));
    if (faces.itemsize() == 4) {
      return {vertices.data(), vertex_count, static_cast<const std::int32_t*>(faces.data()), face_count};
    }
    return {vertices.data(), vertex_count, static_cast<const std::int64_t*>(faces.data()), face_count};
  }
};

/// The most holes that a report describes one by one.
constexpr std::size_t most_holes = 100;

struct Unit {
  const char* name;
  double metres;
};
constexpr std::array<Unit, 8> units = {
    {{"m", 1}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"um", 1e-6}, {"km", 1000}, {"in", 0.0254}, {"ft", 0.3048}}};

double to_unit(py::handle value) {
  if (!py::isinstance<py::str>(value)) {
    const double metres = to_real(value, "unit");
    if (!(metres > 0)) throw InvalidInput("unit", "positive, in metres", to_text(metres));
    return metres;
  }
  const auto name = value.cast<std::string>();
  for (const Unit& unit : units)
    if (name == unit.name) return unit.metres;
  throw InvalidInput("unit", "a length in metres, or one of m, dm, cm, mm, um, km, in, ft", "'" + name + "'");
}

void warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

void ask_about_the_unit(const MeshReport& report, double metres) {
  const double extent = (report.high - report.low).maxCoeff() * metres;
  if (extent > 2000) {
    warn("vertices: the mesh is " + to_text(extent) + " m long: is that meant? unit=\"mm\" reads millimetres");
  } else if (extent < 2e-6) {
    warn("vertices: the mesh is " + to_text(extent) + " m long: is that meant? unit=\"km\" reads kilometres");
  }
}

struct Options {
  std::optional<double> density, mass;
  double unit;
  bool check, flip;
  double weld;
};

Options to_options(const py::object& density, const py::object& mass, py::handle unit, bool check,
                   const py::object& repair, py::handle weld) {
  Options options{{}, {}, to_unit(unit), check, false, to_real(weld, "weld")};
  if (density.is_none() == mass.is_none()) {
    throw InvalidInput("density", "given, or else the mass", density.is_none() ? "neither" : "both");
  }
  if (!density.is_none()) options.density = to_real(density, "density");
  if (!mass.is_none()) options.mass = to_real(mass, "mass");
  if (!repair.is_none()) {
    if (!py::isinstance<py::str>(repair) || repair.cast<std::string>() != "flip") {
      throw InvalidInput("repair", "\"flip\" or None", std::string(py::repr(repair)));
    }
    options.flip = true;
  }
  return options;
}

/// The mesh as it was checked.
Mesh welded(const Mesh& mesh, const MeshReport& report) {
  return {mesh.vertices, mesh.vertex_count, report.welded_faces.data(), mesh.face_count};
}

MassProperties properties_of(const Triangles& triangles, const Options& options) {
  const Mesh mesh = triangles.view();
  std::optional<MeshReport> report;
  MeshIntegrals integrals;
  {
    const WithoutGil nogil;
    if (options.check) report = check_mesh(mesh, options.weld);
    integrals = integrate_mesh(report && report->welded > 0 ? welded(mesh, *report) : mesh);
    if (options.flip && integrals.volume.hi < 0) integrals.flip();
  }
  const MassProperties body = options.mass ? integrals.with_mass(*options.mass, options.unit)
                                           : integrals.with_density(options.density.value(), options.unit);
  if (report) {
    ask_about_the_unit(*report, options.unit);
    if (report->unjudged > 0) {
      warn("faces: of " + std::to_string(report->components) + " surfaces, " + std::to_string(report->unjudged) +
           " were not asked whether they lie inside others: too many");
    }
    if (report->embedded > 0) {
      warn("faces: " + std::to_string(report->embedded) +
           " surfaces inside a solid are wound outward as it is: their volume counts twice (cavities wound the wrong "
           "way?)");
    }
  }
  if (integrals.flipped) warn("faces: wound inward, all of them: turned over");
  return body;
}

}  // namespace

void bind_inertia_mesh(py::module_& m, py::class_<MassProperties>& cls) {
  cls.def_static(
      "from_mesh",
      [](py::handle vertices, py::handle faces, const py::object& density, const py::object& mass, py::handle unit,
         bool check, const py::object& repair, py::handle weld) {
        const Options options = to_options(density, mass, unit, check, repair, weld);
        return properties_of(Triangles(vertices, faces), options);
      },
      py::arg("vertices"), py::arg("faces"), py::kw_only(), py::arg("density") = py::none(),
      py::arg("mass") = py::none(), py::arg("unit") = "m", py::arg("check") = true, py::arg("repair") = py::none(),
      py::arg("weld") = default_weld,
      R"(The solid of uniform density inside a surface of triangles, exact for its vertices wherever they are.

The surface must be closed, every edge between two faces that pass it in opposite directions. Vertices at one place
count as one; so do those of open edges that lie nearer than `weld` times the mesh's size, as CAD programs write them.
:func:`polhode.mesh.report` counts them, and describes holes. The surface may have several parts and cavities (shells
wound inward); where parts overlap, the overlap counts twice: a part inside another is warned of, surfaces that cross are not looked for.

Parameters
----------
vertices : array_like, shape (n, 3)
    In the body's axes, in units of `unit`. C-contiguous float64 is taken without a copy.
faces : array_like of integers, shape (m, 3)
    Vertices of each triangle, counter-clockwise as seen from outside. C-contiguous int32 and int64 need no copy.
density : float
    [kg/m^3]; or else
mass : float
    [kg] of the whole.
unit : float or str
    Length of a unit of the vertices [m], or one of "m", "dm", "cm", "mm", "um", "km", "in", "ft".
check : bool
    False leaves out all that is asked of the surface: fast, and wrong without a word when it is open.
repair : {"flip"}, optional
    Turns a surface that is wound inward as a whole, and warns that it did.
weld : float
    Part of the longest side of the box round the mesh, 0 or from 1e-15 to 0.01. Where open edges are left, their
    vertices nearer than that take the place of the first of them. 0 takes equal vertices alone.

Returns
-------
MassProperties

Warns
-----
UserWarning
    A mesh longer than 2 km or shorter than 2 um, which may be a wrong unit; one that was turned; a solid inside
    another, which may be a cavity wound the wrong way.

Raises
------
InvalidInput
    An open, inverted or non-manifold surface, with counts and the first faces; an index that names no vertex; a vertex
    that is not finite; no volume; density or mass not positive.

References
----------
B. Mirtich, J. Graphics Tools 1(2) (1996) 31; D. Eberly, Polyhedral mass properties (revisited) (2002).)");
  cls.def_static(
      "from_file",
      [](const py::object& path, const py::object& density, const py::object& mass, py::handle unit, bool check,
         const py::object& repair, py::handle weld) {
        const Options options = to_options(density, mass, unit, check, repair, weld);
        const py::tuple arrays = py::module_::import("polhode.mesh").attr("read")(path);
        try {
          return properties_of(Triangles(arrays[0], arrays[1]), options);
        } catch (const InvalidInput& error) {
          throw InvalidInput(std::string(py::str(path)) + ": " + error.what());
        }
      },
      py::arg("path"), py::kw_only(), py::arg("density") = py::none(), py::arg("mass") = py::none(),
      py::arg("unit") = "m", py::arg("check") = true, py::arg("repair") = py::none(),
      py::arg("weld") = default_weld,
      R"(The solid inside the surface that a file holds: STL, or with the `mesh` extra OBJ, PLY, glTF.

Files do not tell their unit: say it. The rest is as for :meth:`from_mesh`.

Parameters
----------
path : str or PathLike
    The format goes by the suffix.
density, mass : float
    One of them [kg/m^3], [kg].
unit : float or str
    Length of a unit of the file [m], or one of "m", "dm", "cm", "mm", "um", "km", "in", "ft".
check : bool
    As for `from_mesh`.
repair : {"flip"}, optional
    As for `from_mesh`.
weld : float
    As for `from_mesh`.

Returns
-------
MassProperties

Raises
------
InvalidInput
    A file that cannot be read, is cut short or does not hold what it says, and what `from_mesh` refuses.)");
  m.def(
      "mesh_report",
      [](py::handle vertices, py::handle faces, py::handle weld) {
        const Triangles triangles(vertices, faces);
        const Mesh mesh = triangles.view();
        const double within = to_real(weld, "weld");
        MeshReport report;
        {
          const WithoutGil nogil;
          report = examine_mesh(mesh, within);
        }
        py::list holes;
        for (std::size_t i = 0; i < std::min(report.holes.size(), most_holes); ++i) {
          py::dict hole;
          hole["edges"] = report.holes[i].edges;
          hole["centre"] = from_vector3(report.holes[i].centre);
          hole["radius"] = report.holes[i].radius;
          holes.append(hole);
        }
        py::dict errors;
        errors["mass"] = report.errors.mass;
        errors["centre"] = report.errors.centre;
        errors["inertia"] = report.errors.inertia;
        py::dict found;
        found["faces"] = mesh.face_count;
        found["closed"] = report.closed();
        found["open_edges"] = report.open_edges;
        found["turned_edges"] = report.turned_edges;
        found["crowded_edges"] = report.crowded_edges;
        found["hole_count"] = report.holes.size();
        found["holes"] = holes;
        found["closes_at"] = report.closes_at > 0 ? py::object(py::float_(report.closes_at)) : py::none();
        found["errors"] = errors;
        found["components"] = report.components;
        found["cavities"] = report.cavities;
        found["strays"] = report.strays;
        found["embedded"] = report.embedded;
        found["unjudged"] = report.unjudged;
        found["degenerate"] = report.degenerate;
        found["merged"] = report.merged;
        found["welded"] = report.welded;
        found["moved"] = report.moved;
        found["inside_out"] = report.inside_out;
        found["size"] = report.size;
        found["low"] = from_vector3(report.low);
        found["high"] = from_vector3(report.high);
        return found;
      },
      py::arg("vertices"), py::arg("faces"), py::arg("weld") = default_weld,
      "What was found in a surface; see polhode.mesh.report.");
  m.def("unit_in_metres", &to_unit, py::arg("unit"), "Length of a unit, given by its name or in metres.");
  m.def(
      "mesh_is_refined",
      [](py::handle vertices, py::handle faces) {
        return integrate_mesh(Triangles(vertices, faces).view()).refined;
      },
      py::arg("vertices"), py::arg("faces"), "Integrated in double-double, as plain numbers would lose digits.");
}

}  // namespace polhode::python
