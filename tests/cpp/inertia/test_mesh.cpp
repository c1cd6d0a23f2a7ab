#include "polhode/inertia/mesh.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

#include "polhode/core/error.hpp"
#include "polhode/core/simd.hpp"

using namespace polhode;

namespace {

/// Those that this processor has.
std::vector<SimdLevel> list_levels() {
  std::vector<SimdLevel> found;
  for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512})
    if (level <= simd_level()) found.push_back(level);
  return found;
}

struct Surface {
  std::vector<double> vertices;
  std::vector<std::int32_t> faces;

  Mesh view() const { return {vertices.data(), vertices.size() / 3, faces.data(), faces.size() / 3}; }
};

Surface make_box(const Vector3d& low, const Vector3d& high) {
  Surface box;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) box.vertices.push_back(((i >> k) & 1) == 1 ? high[k] : low[k]);
  box.faces = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return box;
}

/// Rings of `around` vertices from pole to pole of an egg.
Surface make_egg(int around, int along) {
  Surface egg;
  const auto add = [&](double theta, double phi) {
    const double z = std::cos(theta), r = std::sin(theta) * (1 + 0.2 * z);
    egg.vertices.insert(egg.vertices.end(), {2 + r * std::cos(phi), 1.5 * r * std::sin(phi) - 3, 2 * z + 0.1 * r});
  };
  add(0, 0);
  for (int j = 1; j < along; ++j)
    for (int i = 0; i < around; ++i) add(3.141592653589793 * j / along, 6.283185307179586 * i / around);
  add(3.141592653589793, 0);
  const auto at = [&](int j, int i) { return 1 + (j - 1) * around + i % around; };
  const int last = 1 + (along - 1) * around;
  for (int i = 0; i < around; ++i) {
    egg.faces.insert(egg.faces.end(), {0, at(1, i), at(1, i + 1), at(along - 1, i), last, at(along - 1, i + 1)});
    for (int j = 1; j < along - 1; ++j) {
      egg.faces.insert(egg.faces.end(), {at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      egg.faces.insert(egg.faces.end(), {at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  }
  return egg;
}

std::vector<double> numbers(const MeshIntegrals& m) {
  std::vector<double> all{m.volume.hi};
  for (const math::DD& c : m.centre) all.push_back(c.hi);
  for (const math::DD& s : m.second) all.push_back(s.hi);
  return all;
}

bool same_bits(const MeshIntegrals& a, const MeshIntegrals& b) {
  const auto x = numbers(a), y = numbers(b);
  return std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0 && a.refined == b.refined;
}

}  // namespace

TEST_CASE("a mesh of a box: mass, centre and moments") {
  const Surface box = make_box({0, 0, 0}, {2, 4, 6});
  const MassProperties body = integrate_mesh(box.view()).with_density(2);
  CHECK(body.mass() == 96);
  CHECK(body.com() == Vector3d(1, 2, 3));
  CHECK(body.inertia().matrix().diagonal() == Vector3d(8 * 52, 8 * 40, 8 * 20));
  CHECK(body.inertia().is_diagonal());
  const MassProperties small = integrate_mesh(box.view()).with_mass(96, 0.001);
  CHECK(small.mass() == 96);
  CHECK(small.com() == Vector3d(0.001, 0.002, 0.003));
  CHECK(small.inertia().matrix()(0, 0) == 416e-6);
}

TEST_CASE("meshes: the same bits on avx2 and avx512, for 32 and 64 bits an index, and the baseline near") {
  for (const int size : {8, 33, 100}) {
    const Surface egg = make_egg(2 * size, size);
    const MeshIntegrals best = integrate_mesh(egg.view(), list_levels().back());
    CHECK(best.refined == (size < 33));
    if (list_levels().size() > 1) CHECK(same_bits(best, integrate_mesh(egg.view(), SimdLevel::avx2)));
    const std::vector<std::int64_t> wide(egg.faces.begin(), egg.faces.end());
    const Mesh mesh(egg.vertices.data(), egg.vertices.size() / 3, wide.data(), wide.size() / 3);
    CHECK(same_bits(best, integrate_mesh(mesh, list_levels().back())));
    const auto a = numbers(best), b = numbers(integrate_mesh(egg.view(), SimdLevel::baseline));
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) < 3e-15);
  }
}

TEST_CASE("meshes: every number of faces left over, against one face at a time") {
  const Surface egg = make_egg(9, 5);
  for (std::size_t faces = 1; faces <= egg.faces.size() / 3; ++faces) {
    double volume = 0;  // of an open surface, from the same reference point, whatever it is
    const Mesh part(egg.vertices.data(), egg.vertices.size() / 3, egg.faces.data(), faces);
    MeshIntegrals found;
    try {
      found = integrate_mesh(part);
    } catch (const InvalidInput&) {
      continue;  // the first face alone encloses nothing
    }
    for (std::size_t f = 0; f < faces; ++f) {
      const auto p = [&](std::size_t k) -> Vector3d {
        return Vector3d(Eigen::Map<const Vector3d>(egg.vertices.data() + 3 * egg.faces[3 * f + k])) - found.reference;
      };
      Matrix3d corners;
      corners << p(0), p(1), p(2);
      volume += corners.determinant() / 6;
    }
    CHECK(found.volume.hi == doctest::Approx(volume).epsilon(1e-12));
  }
}

TEST_CASE("seams are welded, and holes described") {
  Surface box = make_box({-1, -1, -1}, {1, 1, 1});
  box.vertices.insert(box.vertices.end(), {-1, -1, -1 + 1e-10});  // vertex 0 again, nearly
  box.faces[0] = 8;
  CHECK(check_mesh(box.view()).welded == 1);
  CHECK_THROWS_AS(check_mesh(box.view(), 0), InvalidInput);
  CHECK_THROWS_AS(check_mesh(box.view(), 0.5), InvalidInput);
  box.faces.resize(box.faces.size() - 3);
  const MeshReport report = examine_mesh(box.view());
  CHECK_FALSE(report.closed());
  CHECK(report.holes.size() == 1);
  CHECK(report.open_edges == 3);
  CHECK(report.errors.mass > 1.0 / 12);  // a twelfth of the surface is missing
}

TEST_CASE("vertices whose distance leaves float64 are not welded") {
  // A pyramid without its base of five vertices. The last two stood in one cell, which had no number.
  const double far = 1.7e308;
  const std::vector<double> vertices = {-far, 0, 0,   0,   -far, 0,    0,       0,   -far, far,
                                        far,  far, far, 0.9 * far, far, 0.5, 0.5, 0.5};
  const std::vector<std::int32_t> faces = {0, 1, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 0, 5};
  const MeshReport report = examine_mesh(Mesh(vertices.data(), 6, faces.data(), 5));
  CHECK(report.welded == 0);
  CHECK(report.open_edges == 5);
}

TEST_CASE("what checks find in a mesh") {
  Surface box = make_box({-1, -1, -1}, {1, 1, 1});
  CHECK(check_mesh(box.view()).components == 1);
  CHECK_FALSE(check_mesh(box.view()).inside_out);
  std::swap(box.faces[0], box.faces[1]);
  CHECK_THROWS_AS(check_mesh(box.view()), InvalidInput);
  std::swap(box.faces[0], box.faces[1]);
  box.faces[5] = 8;
  CHECK_THROWS_AS(check_mesh(box.view()), InvalidInput);
  for (const SimdLevel level : list_levels()) {
    CHECK_THROWS_AS(integrate_mesh(box.view(), level), InvalidInput);
    box.faces[5] = -1;
  }
}

#if defined(__linux__)
TEST_CASE("meshes: nothing is read beyond the last vertex") {
  const Surface egg = make_egg(60, 30);
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t bytes = egg.vertices.size() * sizeof(double), pages = (bytes + page - 1) / page;
  void* const place = mmap(nullptr, (pages + 1) * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  REQUIRE(place != MAP_FAILED);
  char* const end = static_cast<char*>(place) + pages * page;
  REQUIRE(mprotect(end, page, PROT_NONE) == 0);
  std::memcpy(end - bytes, egg.vertices.data(), bytes);
  const double* const vertices = reinterpret_cast<const double*>(end - bytes);
  for (const SimdLevel level : list_levels()) {
    const Mesh guarded(vertices, egg.vertices.size() / 3, egg.faces.data(), egg.faces.size() / 3);
    CHECK(same_bits(integrate_mesh(guarded, level), integrate_mesh(egg.view(), level)));
  }
  munmap(place, (pages + 1) * page);
}
#endif

TEST_CASE("meshes: the same bits by any number of threads, and a wrong index is seen by each") {
  Surface egg = make_egg(500, 301);
  for (const int cut : {0, 1, 7, 8, 250}) {
    const Mesh mesh{egg.vertices.data(), egg.vertices.size() / 3, egg.faces.data(),
                    egg.faces.size() / 3 - static_cast<std::size_t>(cut)};
    for (const SimdLevel level : list_levels()) {
      const MeshIntegrals one = integrate_mesh(mesh, level, 1);
      for (const int threads : {0, 2, 3}) CHECK(same_bits(one, integrate_mesh(mesh, level, threads)));
    }
  }
  for (const std::size_t at : {std::size_t{0}, egg.faces.size() / 2 + 9, egg.faces.size() - 1}) {
    const std::int32_t before = egg.faces[at];
    egg.faces[at] = 1 << 30;
    CHECK_THROWS_WITH_AS(integrate_mesh(egg.view(), simd_level(), 2), doctest::Contains("faces"), InvalidInput);
    egg.faces[at] = before;
  }
}
