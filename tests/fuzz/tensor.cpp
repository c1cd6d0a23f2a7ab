#include "polhode/inertia/checks.hpp"
#include "polhode/inertia/mass_properties.hpp"
#include "polhode/inertia/shapes.hpp"

#include "input.hpp"

// Tensors, point masses and shapes of any numbers: refused, or bodies; and batches with the bits of single bodies.

namespace polhode::fuzz {
namespace {

Matrix3d matrix(Input& input) {
  Matrix3d I;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) I(i, j) = I(j, i) = input.number();
  if (input.below(8) == 0) I(2, 0) = input.number();
  return I;
}

void try_tensor(Input& input) {
  const Matrix3d I = matrix(input);
  double entries[18], moments[6], axes[18], margins[2];
  std::uint8_t flaws[2];
  for (int i = 0; i < 18; ++i) entries[i] = I(i % 9 / 3, i % 3);
  check_inertia(entries, 2, margins, flaws);
  require(is_same(margins[0], margins[1]) && flaws[0] == flaws[1], "checks do not depend on the neighbours");
  const bool batch = is_done([&] { compute_principal_axes(entries, 2, moments, axes); });
  const bool valid = is_done([&] {
    const InertiaTensor tensor(I, input.coin());
    require(batch, "a valid tensor is taken in a batch");
    // Negative moments within rounding are 0 in a tensor, and stay in a batch.
    for (int k = 0; k < 3; ++k)
      require(tensor.moments()[k] == (moments[k] > 0 ? moments[k] : 0.0), "moments have the bits of the batch");
    is_done([&] { tensor.about_axis(input.vector()); });
    is_done([&] { tensor.rotated(input.attitude()); });
    tensor.principal(input.number());
  });
  if (batch) require(is_same(moments, moments + 3, 3) && is_same(axes, axes + 9, 9), "rows alike");
  if (valid) require((flaws[0] & (flaw_not_finite | flaw_not_symmetric)) == 0, "no flaw in a valid tensor");
}

void try_bodies(Input& input) {
  const std::size_t n = input.below(6);
  std::vector<MassProperties> bodies;
  is_done([&] { bodies.emplace_back(input.number(), input.vector(), InertiaTensor(matrix(input))); });
  const std::vector<double> masses = input.numbers(n), positions = input.numbers(3 * n);
  is_done([&] { bodies.push_back(MassProperties::from_points(masses.data(), positions.data(), n)); });
  const std::vector<shapes::Record>& all = shapes::all();
  const shapes::Record& shape = all[input.below(all.size())];
  std::size_t count = 0;
  for (const shapes::Parameter& parameter : shape.parameters) {
    std::size_t size = 1;
    for (const int length : parameter.size) size *= static_cast<std::size_t>(length);
    count += size;
  }
  const std::vector<double> values = input.numbers(count);
  is_done([&] { bodies.push_back(shape.make(values.data())); });
  if (shape.volume != nullptr) is_done([&] { shape.volume(values.data() + 1); });
  for (const MassProperties& body : bodies) {
    require(body.mass() > 0 && body.com().allFinite() && body.inertia().matrix().allFinite(), "a body is finite");
    is_done([&] { body.about(input.vector()); });
    is_done([&] { body.moved(input.attitude(), input.vector()); });
    is_done([&] { body + bodies.front(); });
    is_done([&] { body - bodies.back(); });
  }
}

}  // namespace
}  // namespace polhode::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  polhode::fuzz::Input input(data, size);
  if (input.coin()) {
    polhode::fuzz::try_tensor(input);
  } else {
    polhode::fuzz::try_bodies(input);
  }
  return 0;
}
