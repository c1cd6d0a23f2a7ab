#include <pybind11/stl.h>

#include <array>

#include "bind.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/spectrum/lines.hpp"
#include "polhode/spectrum/quadratics.hpp"

namespace polhode::python {
namespace {

using spectrum::Grid;

using GridOfPython = std::array<double, 3>;   // first, step, count

Grid to_grid(const GridOfPython& grid) {
  if (!(grid[2] >= 1 && grid[2] <= 1e9)) throw InvalidInput("count", "from 1 to 1e9 trials", to_text(grid[2]));
  return {grid[0], grid[1], static_cast<std::size_t>(grid[2])};
}

std::span<const double> to_span(const Array& array) { return {array.data(), static_cast<std::size_t>(array.size())}; }

Array project(const Array& t, const Array& y, const Array& weight, const std::vector<std::array<int, 2>>& lines,
              const GridOfPython& f, const GridOfPython& g, std::size_t block) {
  const std::size_t n = static_cast<std::size_t>(t.size());
  const spectrum::Series series{to_span(t), to_span(y), to_span(weight),
                                n == 0 ? 1 : static_cast<std::size_t>(y.size()) / n};
  std::vector<spectrum::Line> wanted;
  for (const auto& [a, b] : lines) {
    if (std::abs(a) > 64 || std::abs(b) > 64) throw InvalidInput("lines", "at most 64 of each", std::to_string(a));
    wanted.push_back({a, b});
  }
  const Grid first = to_grid(f), second = to_grid(g);
  const auto side = static_cast<py::ssize_t>(block);
  Array out({static_cast<py::ssize_t>(first.count), static_cast<py::ssize_t>(second.count),
             static_cast<py::ssize_t>(series.count / std::max<std::size_t>(block, 1)), side, side});
  double* const data = out.mutable_data();
  const WithoutGil nogil;
  spectrum::project(series, wanted, first, second, block, data);
  return out;
}

Array periodogram(const Array& t, const Array& z, std::size_t count, const GridOfPython& f) {
  const Grid grid = to_grid(f);
  Array out(static_cast<py::ssize_t>(grid.count));
  double* const data = out.mutable_data();
  const WithoutGil nogil;
  spectrum::periodogram(to_span(t), to_span(z), count, grid, data);
  return out;
}

std::pair<Array, Array> match_quadratics(const Array& t, const Array& y, const Array& weight, const Array& curves,
                                         std::size_t phases, const std::vector<std::size_t>& which, const Array& f, const Array& g,
                                         std::size_t shifts, const Array& functions, bool scale, bool offset) {
  std::vector<spectrum::Trial> trials;
  for (std::size_t k = 0; k < which.size(); ++k) trials.push_back({which[k], f.data()[k], g.data()[k]});
  const std::array<py::ssize_t, 2> shape{static_cast<py::ssize_t>(which.size()), static_cast<py::ssize_t>(shifts)};
  Array cost(shape), found(shape);
  double *const cost_data = cost.mutable_data(), *const found_data = found.mutable_data();
  {
    const WithoutGil nogil;
    spectrum::match_quadratics({to_span(t), to_span(y), to_span(weight), 1}, {to_span(curves), phases}, trials, shifts,
                               to_span(functions), {scale, offset}, cost_data, found_data);
  }
  return {cost, found};
}

}  // namespace

// Of `polhode._spectrum`, which checks what it gives.
void bind_spectrum(py::module_& m) {
  m.def("_project_lines", &project);
  m.def("_periodogram", &periodogram);
  m.def("_match_quadratics", &match_quadratics);
}

}  // namespace polhode::python
