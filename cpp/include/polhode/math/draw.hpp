#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace polhode {

/// Random words by counter: those of a body depend on the seed, the quantity and the number of the body alone. Another
/// quantity, another cut of the bodies or another machine moves none.
struct DrawStream {
  static constexpr std::size_t words = 8;   ///< of one body and quantity
  std::uint64_t seed = 0;
  std::uint64_t key = 0;        ///< of the quantity, from `draw_key`
  std::uint64_t attempt = 0;    ///< for a body that is drawn again, 1, 2, ...

  /// The words of a body, below 2^62. They are those of NumPy's
  /// Philox(key=[seed, key], counter=[2 body, attempt, 0, 0]).random_raw(8).
  std::array<std::uint64_t, words> operator()(std::uint64_t body) const;
};

/// The key of a quantity's name: its hash FNV-1a (64 bits).
std::uint64_t draw_key(std::string_view quantity);

/// What is drawn, and its parameters for each component.
enum class Distribution {
  uniform,           ///< (low, high)
  normal,            ///< (mean, standard deviation)
  log_uniform,       ///< (low, high), both positive: the logarithm is uniform
  truncated_normal,  ///< (mean, standard deviation, low, high): between bounds, which may be inf
  sphere,            ///< no parameters: a unit vector
  attitude,          ///< no parameters: a unit quaternion (x, y, z, w), uniform on the rotations
  rotation,          ///< one row of three standard deviations [rad]: the quaternion of a rotation vector drawn normal
};

/// A distribution, checked once.
class Draw {
 public:
  /// Parameters (rows, columns) row by row. Throws InvalidInput for what is no distribution.
  Draw(Distribution distribution, const double* parameters, std::size_t rows, std::size_t columns);

  std::size_t width() const { return width_; }   ///< the components of one draw

  /// Writes (count, width): the draws of bodies first, first + 1, ... Component i uses word i of the body, and those of
  /// sphere, attitude and rotation words 0 to 2. Only + - * / and roots take part: the bits are the same everywhere.
  void operator()(const DrawStream& stream, std::uint64_t first, std::size_t count, double* values) const;

 private:
  struct Component {
    double a, b, low, high;                  ///< mean and deviation, or low and high
    double lower[2], upper[2];               ///< truncated: probabilities below and above each bound
    double log_ratio[2];                     ///< log(high / low) = [0] + [1]
  };
  double component(const Component& c, std::uint64_t word) const;

  Distribution distribution_;
  std::size_t width_;
  std::vector<Component> components_;
};

}  // namespace polhode
