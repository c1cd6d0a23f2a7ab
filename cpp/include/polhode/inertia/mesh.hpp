#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

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

/// A loop of open edges.
struct MeshHole {
  std::size_t edges = 0;
  Vector3d centre = Vector3d::Zero();  ///< the mean of the edges, by their lengths
  double radius = 0;                   ///< distance of the farthest vertex from the centre
};

/// Bounds of what open edges can change; infinite where nothing can be said.
struct MeshErrors {
  double mass = 0;     ///< of a given density, relative to the mass of integrate_mesh
  double centre = 0;   ///< [units of the vertices]
  double inertia = 0;  ///< about the centre, spectral norm, relative to the largest moment
};

/// Vertices of open edges nearer than this part of the mesh's size count as one. CAD programs write sin(pi) as 6e-17 in
/// one face, and as 0 in the next.
inline constexpr double default_weld = 1e-9;

/// What examine_mesh found in a surface.
struct MeshReport {
  std::size_t components = 0;    ///< surfaces that share no edge, cavities with them
  std::size_t cavities = 0;      ///< of these, wound inward inside another
  std::size_t strays = 0;        ///< wound inward, inside no other: a part turned inside out
  std::size_t stray_face = 0;    ///< the first face of the first stray
  std::size_t stray_faces = 0;   ///< the number of its faces
  std::size_t embedded = 0;      ///< wound outward inside a solid: counted twice (a cavity wound the wrong way?)
  std::size_t unjudged = 0;      ///< not checked for lying inside others: too many surfaces
  std::size_t degenerate = 0;    ///< faces with two corners at one vertex; they are ignored
  std::size_t open_edges = 0;    ///< edges of one face
  std::size_t turned_edges = 0;  ///< edges of two faces that pass them in the same direction
  std::size_t crowded_edges = 0; ///< edges of three faces or more
  bool merged = false;           ///< vertices at exactly the same place were merged
  bool inside_out = false;       ///< wound consistently, but inward
  std::size_t welded = 0;        ///< places given up by the weld
  double moved = 0;              ///< the farthest that a vertex moved [units of the vertices]
  double size = 0;               ///< the longest side of the box round the faces
  double closes_at = 0;          ///< of an open surface: the `weld` that closes it; 0 when none up to 0.01 does
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();  ///< the box round the faces
  std::vector<MeshHole> holes;   ///< the largest first
  MeshErrors errors;             ///< what the open edges can change
  std::vector<std::int64_t> welded_faces;  ///< the faces to integrate after a weld; empty where nothing was welded
  std::string faults;            ///< counts of the faulty edges and their first faces, for messages

  /// Every edge lies between two faces that pass it in opposite directions.
  bool closed() const { return open_edges + turned_edges + crowded_edges == 0; }
};

/// Judges a surface of triangles. Vertices at the same place are merged, where that is needed to close it. Where that
/// does not close it, vertices of faulty edges that lie nearer than `weld` times the size are taken as one, chains of
/// them too; all take the place of the first. 0: none are. Throws InvalidInput for indices out of range, vertices that
/// are not finite, and faces without area.
///
/// `errors` assumes that what is missing lies within the ball about each hole's centre through its farthest vertex, and
/// does not cross itself. With the fan from the centre to the loop as a cap, moments of the order n about the centre of
/// mass then differ by those of the cones from the reference point to the fans, plus at most the sum over the holes of
/// the ball's volume times D^n, where D reaches to the ball's far end. `docs/inertia.md` has the formulas.
MeshReport examine_mesh(const Mesh& mesh, double weld = default_weld);

/// Checks that the mesh is the surface of a body. Every edge lies between two faces that pass it in opposite
/// directions, and every inward shell lies inside another. Throws InvalidInput, with counts and the first faces, when
/// it is not. A mesh that is inside out as a whole passes, as does a solid inside another: see `inside_out`,
/// `embedded`. Surfaces that cross each other are not detected.
MeshReport check_mesh(const Mesh& mesh, double weld = default_weld);

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
/// The sums are compensated and have the same bits on avx2 and avx512, for any number of threads (0: two from
/// 200 000 faces on). The surface is not checked. Throws InvalidInput for an index out of range, a vertex that is not
/// finite, or no face at all.
MeshIntegrals integrate_mesh(const Mesh& mesh);
MeshIntegrals integrate_mesh(const Mesh& mesh, SimdLevel level, int threads = 0);

}  // namespace polhode
