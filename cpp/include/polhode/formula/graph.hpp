#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "polhode/formula/ephemeris.hpp"
#include "polhode/formula/form.hpp"

namespace polhode::formula {

/// What a node computes from its operands a, b, c.
enum class Op : std::uint8_t {
  constant,     ///< a number, as an operand of another operation
  time,
  state,        ///< the state with the number `index`
  parameter,    ///< the parameter with the number `index`
  linear,       ///< a form of other nodes
  multiply,     ///< a b
  divide,       ///< a / b
  root,         ///< sqrt a
  power,        ///< a^constant
  exponential,  ///< e^a
  logarithm,    ///< log a
  sine,         ///< sin a
  cosine,       ///< cos a
  tanh,         ///< tanh a
  angle,        ///< atan2(a, b)
  choose,       ///< a > 0 ? b : c; where `index` is 1, a friction's sign of the rate a, which may hold a at 0
  to_body,      ///< component `index` of R_WB^T (a, b, c)
  ephemeris     ///< number `index` modulo eight of the ephemeris `index` / 8, a known function of time
};

/// The states of a body by their numbers: the rates, the attitude (x, y, z, w), then those of the formula.
inline constexpr int first_rate = 0, first_attitude = 3, first_extra = 7;

struct Node {
  Op op;
  int index = 0;
  std::array<int, 3> operands{-1, -1, -1};
  double constant = 0.0;

  friend bool operator==(const Node&, const Node&) = default;
};

/// @throws InvalidInput for a constant that left float64's range
void require_finite(const Form& form);

/// Nodes without duplicates: equal operations on equal operands are one node. Operands precede their node. The
/// functions fold constants, so an operation may come back as a form without a new node.
///
/// The factor of a product's operand is taken out of the product: all of a single node's, else a power of two, so that
/// no coefficient of a form is rounded by it.
class Graph {
 public:
  static constexpr int most_nodes = 10'000;
  static constexpr int most_ephemerides = 16;

  Form time();
  Form state(int number);
  Form parameter(int number);
  /// A number of an Ephemeris by its place there. Equal ephemerides are one.
  Form ephemeris(const Ephemeris& ephemeris, int number);

  Form multiply(const Form& a, const Form& b);
  Form divide(const Form& a, const Form& b);
  Form root(const Form& a);
  Form power(const Form& a, double exponent);
  Form exponential(const Form& a);
  Form logarithm(const Form& a);
  Form sine(const Form& a);
  Form cosine(const Form& a);
  Form tanh(const Form& a);
  Form angle(const Form& y, const Form& x);
  /// yes where guard > 0, else no.
  Form choose(const Form& guard, const Form& yes, const Form& no);
  /// The sign of a rate, whose product with a load is a friction: -1 at 0, where it may hold.
  Form slip(const Form& rate);
  /// R_WB^T v for the unit quaternion in the states.
  std::array<Form, 3> to_body(const std::array<Form, 3>& v);

  int size() const { return static_cast<int>(nodes_.size()); }
  const Node& operator[](int node) const { return nodes_[static_cast<std::size_t>(node)]; }
  /// The form of a linear node.
  const Form& linear(int node) const { return forms_[static_cast<std::size_t>((*this)[node].index)]; }
  const std::vector<Ephemeris>& ephemerides() const { return ephemerides_; }
  /// That of a node.
  const Ephemeris& ephemeris_of(const Node& node) const {
    return ephemerides_[static_cast<std::size_t>(node.index / Ephemeris::size)];
  }

 private:
  /// A node with the value of a form.
  int node_of(const Form& form);
  int intern(const Node& node);
  int find_linear(const Form& form);
  /// A node times a factor that has the value of a form, `all` of a single node's factor or the power of two alone.
  Term take_factor(const Form& form, bool all);
  Form apply(Op op, const Form& a, double constant = 0.0);
  Form raise(const Form& a, int exponent);

  std::vector<Node> nodes_;
  std::vector<Form> forms_;
  std::vector<Ephemeris> ephemerides_;
  std::unordered_multimap<std::size_t, int> found_;
};

}  // namespace polhode::formula
