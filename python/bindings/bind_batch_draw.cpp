#include <cstdint>
#include <string>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/math/draw.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/normal.hpp"

namespace polhode::python {
namespace {

Distribution to_distribution(const std::string& name) {
  constexpr const char* names[] = {"uniform", "normal",   "log_uniform", "truncated_normal",
                                   "sphere",  "attitude", "rotation"};
  int found = 0;
  for (const char* known : names) {
    if (name == known) return static_cast<Distribution>(found);
    ++found;
  }
  throw InvalidInput("kind",
                     "a distribution: uniform, normal, log_uniform, truncated_normal, sphere, attitude or rotation",
                     name);
}

py::array_t<std::uint64_t> draw_words(std::uint64_t seed, const std::string& key, std::uint64_t first,
                                      std::size_t count, std::uint64_t attempt) {
  const DrawStream stream{seed, draw_key(key), attempt};
  py::array_t<std::uint64_t> words({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(DrawStream::words)});
  std::uint64_t* to = words.mutable_data();
  const WithoutGil nogil;
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint64_t word : stream(first + i)) *to++ = word;
  return words;
}

Array draw(const std::string& kind, std::uint64_t seed, const std::string& key, std::uint64_t first, std::size_t count,
           const py::object& parameters, std::uint64_t attempt) {
  const Array given = to_array(parameters, "parameters");
  if (given.ndim() != 2) throw InvalidInput("parameters", "of two axes", std::to_string(given.ndim()));
  const Draw drawn(to_distribution(kind), given.data(), static_cast<std::size_t>(given.shape(0)),
                   static_cast<std::size_t>(given.shape(1)));
  Array values({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(drawn.width())});
  double* to = values.mutable_data();
  const WithoutGil nogil;
  drawn(DrawStream{seed, draw_key(key), attempt}, first, count, to);
  return values;
}

}  // namespace

void bind_batch_draw(py::module_& m) {
  m.def("_draw_key", [](const std::string& key) { return draw_key(key); }, py::arg("key"));
  m.def("_draw_words", &draw_words, py::arg("seed"), py::arg("key"), py::arg("first"), py::arg("count"),
        py::arg("attempt") = 0);
  m.def("_upper_normal_quantile", &math::upper_normal_quantile);
  m.def("_upper_normal_tail", &math::upper_normal_tail);
  m.def("_draw", &draw, py::arg("kind"), py::arg("seed"), py::arg("key"), py::arg("first"), py::arg("count"),
        py::arg("parameters"), py::arg("attempt") = 0);
}

}  // namespace polhode::python
