#include "polhode/inertia/mesh.hpp"

#include "input.hpp"

// Vertices and faces of any numbers, as every reader of mesh files hands them on: refused, or integrated with the same
// bits by both kinds of wide registers.

namespace polhode::fuzz {
namespace {

template <class Index>
void try_mesh(const std::vector<double>& vertices, const std::vector<Index>& faces, Input& input) {
  const Mesh mesh(vertices.data(), vertices.size() / 3, faces.data(), faces.size() / 3);
  is_done([&] { check_mesh(mesh); });
  for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level > simd_level()) continue;
    MeshIntegrals integrals;
    if (!is_done([&] { integrals = integrate_mesh(mesh, level); })) continue;
    if (level == SimdLevel::avx512) {
      const MeshIntegrals narrow = integrate_mesh(mesh, SimdLevel::avx2);
      require(is_same(integrals.volume.hi, narrow.volume.hi) && is_same(integrals.second[5].hi, narrow.second[5].hi),
              "the same bits on avx2 and avx512");
    }
    is_done([&] { integrals.with_density(input.number(), input.number()); });
    integrals.flip();
    is_done([&] { integrals.with_mass(input.number(), input.number()); });
  }
}

template <class Index>
void try_faces(Input& input) {
  // A tetrahedron to start from, so that closed surfaces are found at once.
  std::vector<double> vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<Index> faces = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  for (std::size_t changes = input.below(4); changes > 0; --changes)
    vertices[input.below(vertices.size())] = input.number();
  for (const double x : input.numbers(3 * input.below(20))) vertices.push_back(x);
  for (std::size_t copies = input.below(3); copies > 0; --copies) {   // other parts, cavities, the same part again
    const double factor = input.number(), shift = input.number();
    const Index first = static_cast<Index>(vertices.size() / 3);
    for (std::size_t i = 0; i < 12; ++i) vertices.push_back(factor * vertices[i] + shift);
    for (std::size_t i = 0; i < 12; ++i) faces.push_back(faces[i] + first);
  }
  while (!input.is_empty() && faces.size() < 3000) {
    const std::size_t place = input.take<std::uint16_t>() % (faces.size() + 3);
    const Index index = input.coin() ? input.take<Index>() : static_cast<Index>(input.below(vertices.size() / 3));
    if (place < faces.size()) {
      faces[place] = index;
    } else {
      faces.insert(faces.end(), {index, faces[input.below(12)], faces[input.below(12)]});
    }
  }
  try_mesh(vertices, faces, input);
}

}  // namespace
}  // namespace polhode::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  polhode::fuzz::Input input(data, size);
  if (input.coin()) {
    polhode::fuzz::try_faces<std::int32_t>(input);
  } else {
    polhode::fuzz::try_faces<std::int64_t>(input);
  }
  return 0;
}
