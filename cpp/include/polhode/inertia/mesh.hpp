#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "polhode/core/simd.hpp"
#include "polhode/inertia/mass_properties.hpp"
#include "polhode/math/detail/double_double.hpp"

// Solids of uniform density inside a surface of triangles.
namespace polhode {

/// A view of the caller's triangles: x, y, z of each vertex, and three vertices of each face, counter-clockwise as seen
/// from outside. Cavities are shells wound the other way round.
struct Mesh {
  Mesh(const double* vertices_in, std::size_t vertex_count_in, const std::int32_t* faces_in, std::size_t face_count_in)
      : vertices(vertices_in), vertex_count(vertex_count_in), faces(faces_in), face_count(face_count_in) {}
  Mesh(const double* vertices_in, std::size_t vertex_count_in, const std::int64_t* faces_in, std::size_t face_count_in)
      : vertices(vertices_in), vertex_count(vertex_count_in), faces(faces_in), face_count(face_count_in) {}

  const double* vertices;
  std::size_t vertex_count;
  std::variant<const std::int32_t*, const std::int64_t*> faces;
  std::size_t face_count;
};

/// What check_mesh found in a surface that encloses a body.
struct MeshReport {
  std::size_t components = 0;  ///< surfaces that share no edge, cavities with them
  std::size_t cavities = 0;    ///< of these, wound inward inside another
  std::size_t embedded = 0;    ///< wound outward inside a solid: counted twice (a cavity wound the wrong way?)
  std::size_t unjudged = 0;    ///< not checked for lying inside others: too many surfaces
  std::size_t degenerate = 0;  ///< faces with two corners at one vertex; they are ignored
  bool merged = false;         ///< closed only after merging vertices at exactly the same place
  bool inside_out = false;     ///< wound consistently, but inward
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();  ///< the box round the faces
};

/// Checks that the mesh is the surface of a body. Every edge lies between two faces that pass it in opposite
/// directions, and every inward shell lies inside another. Throws InvalidInput, with counts and the first faces, when
/// it is not. A mesh that is inside out as a whole passes, as does a solid inside another: see `inside_out`,
/// `embedded`. Surfaces that cross each other are not detected.
MeshReport check_mesh(const Mesh& mesh);

/// Volume and moments of the solid, in units of the vertices. In double-double, so that the result is rounded once.
/// Negative volume: wound inward.
struct MeshIntegrals {
  Vector3d reference = Vector3d::Zero();  ///< a point near the mesh, from which the sums were taken
  math::DD volume;
  math::DD centre[3];    ///< centre of volume
  math::DD second[6];    ///< integral of xx, yy, zz, xy, xz, yz about the centre
  bool flipped = false;  ///< `flip` was called
  bool refined = false;  ///< integrated in double-double, because plain numbers would lose digits

  /// Reverses the orientation of the surface.
  void flip();

  /// With a density [kg/m^3] and the length of a vertex unit [m]. Throws InvalidInput unless the volume is positive.
  MassProperties with_density(double density, double unit = 1) const;
  /// With the mass [kg] of the whole.
  MassProperties with_mass(double mass, double unit = 1) const;
};

/// Sums over the tetrahedra between a reference point and each face ([Mirtich1996], [Eberly2002]); no approximation.
/// The sums are compensated and have the same bits on avx2 and avx512, whatever the number of threads (0: two from
/// 200 000 faces on). The surface is not checked. Throws InvalidInput for an index out of range, a vertex that is not
/// finite, or no face at all.
MeshIntegrals integrate_mesh(const Mesh& mesh);
MeshIntegrals integrate_mesh(const Mesh& mesh, SimdLevel level, int threads = 0);

}  // namespace polhode
