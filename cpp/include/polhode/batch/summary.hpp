#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "polhode/batch/free_motion.hpp"
#include "polhode/core/quat.hpp"

namespace polhode {

/// What is summed up at each time.
struct SummaryQuantity {
  enum class Of {
    angle,       ///< between the attitude and the nominal one [rad]
    axis_angle,  ///< between a body axis and a direction in space [rad]
    omega,       ///< |omega| [rad/s]
    energy,      ///< kinetic [J]
    value,       ///< a number that is handed in, of either sign
    attitude,    ///< the second moments of conj(nominal) q: mean attitude and spread
  };
  Of of = Of::angle;
  std::vector<double> reference;        ///< nominal attitude (4) or target (3), or one a time, row by row; unit
  std::array<double, 3> axis{};         ///< of axis_angle, in body axes; unit
  int first = 0, last = 0;              ///< the histogram covers 2^first ... 2^last; 0, 0: chosen by the quantity
};

/// Sums over the bodies of an ensemble at `times` times. Bodies are numbered. 4096 of them are a block, added up in the
/// order of their numbers; blocks are combined by a binary tree on the number of the block. So the bits depend neither
/// on the number of threads, nor on the cut of the ensemble, nor on the order of merging. After an exception of
/// `add_free` or `add_states` a summary is of no use.
class Summary {
 public:
  static constexpr std::size_t block = 4096;
  static constexpr int bins_of_octave = 64;

  /// Throws InvalidInput for references that are not unit, or not one a time.
  Summary(std::vector<SummaryQuantity> quantities, std::size_t times);

  /// Bodies first, first + 1, ... in free motion. Their states are computed and used in the cache. There must be as
  /// many times as the summary has, finite, and the same for all bodies. A body without a motion is counted as failed.
  void add_free(std::uint64_t first, const FreeMotionBatch& batch, int threads = 0);

  /// States of n bodies: omega (n, times, 3), attitude (n, times, 4), tensors (n, 6) as xx, yy, zz, xy, xz, yz, or (6)
  /// of all with `one_tensor`, values (n, times, number of value quantities). What no quantity needs may be null. Rows
  /// that are not finite are left out, and their bodies counted as failed.
  struct States {
    std::size_t bodies = 0;
    const double *omega = nullptr, *attitude = nullptr, *tensors = nullptr, *values = nullptr;
    bool one_tensor = false;
  };
  void add_states(std::uint64_t first, const States& states);

  /// Adds the bodies of another summary of the same quantities. Throws InvalidInput if both have one of the blocks.
  void merge(const Summary& other);

  /// The sums at each time.
  struct Scalar {
    std::vector<double> count, sum, sum2, least, largest;   ///< (times)
    std::vector<std::uint32_t> histogram;                   ///< (times, bins)
    std::vector<double> moments;                            ///< of attitude: (times, 10) xx xy xz xw yy yz yw zz zw ww
  };
  struct Record {
    std::uint64_t first = 0, end = 0;   ///< of the bodies' numbers
    std::uint64_t bodies = 0, failed = 0;
    std::vector<Scalar> quantities;
  };
  Record record() const;
  /// A summary with these sums. Their bodies must be all of an aligned power of two of blocks; the last ones may miss.
  static Summary from_record(std::vector<SummaryQuantity> quantities, std::size_t times, const Record& record);

  std::size_t times() const { return times_; }
  std::size_t bins(std::size_t quantity) const;
  /// The edges of the bins, one more than bins: bin b holds edges[b] <= x < edges[b + 1].
  std::vector<double> edges(std::size_t quantity) const;
  const std::vector<SummaryQuantity>& quantities() const { return quantities_; }
  std::uint64_t bodies() const { return bodies_; }
  std::uint64_t failed() const { return totals_.failed; }

  /// What needs no order: counts, extremes and histograms. Rows are padded to whole vectors.
  struct Totals {
    std::vector<double> count, least, largest;   ///< (quantities, padded times)
    std::vector<std::vector<std::uint32_t>> bins;
    std::uint64_t failed = 0;
  };
  using Sums = std::vector<double>;   ///< what is added in order, of one block or more

 private:
  struct Node {
    int level;
    Sums sums;
  };
  void begin(std::uint64_t first, std::size_t bodies);
  template <class Source>
  void add(std::uint64_t first, std::size_t bodies, int threads, const Source& source);
  std::map<std::uint64_t, Node> all_nodes() const;

  std::vector<SummaryQuantity> quantities_;
  std::size_t times_ = 0;
  std::vector<std::vector<double>> planes_;   ///< references by component, padded
  Totals totals_;
  std::map<std::uint64_t, Node> nodes_;       ///< by their first block
  Sums open_;                                 ///< of the block that is not complete
  std::uint64_t first_ = 0, end_ = 0, bodies_ = 0;
  bool started_ = false;
};

/// The mean attitude (x, y, z, w) and the spread [rad] of second moments xx xy xz xw yy yz yw zz zw ww of quaternions:
/// the eigenvector of the largest eigenvalue (Markley, Cheng, Crassidis & Oshman 2007, J. Guidance 30, 1193), and
/// 2 asin sqrt(1 - that eigenvalue / trace), which for small angles is their rms about the mean. The quaternion's last
/// component that is not 0 is positive.
struct MeanAttitude {
  std::array<double, 4> attitude;
  double spread;
};
MeanAttitude mean_attitude(const double* moments);

}  // namespace polhode
