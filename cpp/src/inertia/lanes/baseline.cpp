// One triangle at a time, for any processor.
#define POLHODE_ISA isa_baseline
#include "inertia/lanes/levels.hpp"
#include "math/lanes/scalar.hpp"

namespace polhode::POLHODE_ISA {

using Wide = One;

POLHODE_INLINE Wide nmadd(Wide a, Wide b, Wide c) { return c - a * b; }

template <bool last, class Index>
POLHODE_INLINE void load_rows(const double* vertices, const Index* index, Wide& x, Wide& y, Wide& z) {
  const double* p = vertices + 3 * static_cast<std::ptrdiff_t>(*index);
  x = p[0], y = p[1], z = p[2];
}

}  // namespace polhode::POLHODE_ISA

#include "inertia/lanes/mesh_loops.hpp"

namespace polhode::inertia {
const MeshKernels* baseline_mesh_kernels() { return &POLHODE_ISA::mesh_kernels; }
}  // namespace polhode::inertia
