#include "polhode/formula/modes.hpp"

#include <algorithm>
#include <string>

#include "polhode/core/error.hpp"

namespace polhode::formula {

std::vector<int> list_switches(const Program& program) {
  std::vector<int> found;
  const std::vector<bool> live = find_live(program.graph, program.outputs);
  for (int i = 0; i < program.graph.size(); ++i)
    if (live[static_cast<std::size_t>(i)] && program.graph[i].op == Op::choose) found.push_back(i);
  return found;
}

std::vector<Form> list_guards(const Program& program) {
  std::vector<Form> guards;
  for (const int node : list_switches(program)) guards.push_back(Form::of(program.graph[node].operands[0]));
  return guards;
}

Mode find_mode(const Program& program, double t, const double* y) {
  Evaluator evaluator(program);
  std::vector<double> outputs(program.outputs.size());
  evaluator(t, y, nullptr, outputs.data());
  Mode mode;
  for (const int node : list_switches(program)) mode.push_back(evaluator.value(program.graph[node].operands[0]) > 0.0);
  return mode;
}

Program in_mode(const Program& program, const Mode& mode, bool with_guards) {
  const std::vector<int> switches = list_switches(program);
  if (mode.size() != switches.size())
    throw InvalidInput("mode", std::to_string(switches.size()) + " switches", std::to_string(mode.size()));
  Program whole = program;
  if (with_guards)
    for (const Form& guard : list_guards(program)) whole.outputs.push_back(guard);
  Program made{{}, program.parameters, program.states, {}};
  Rewriter* own = nullptr;
  Rewriter rewriter(whole.graph, made.graph, [&](int node, Graph&) -> std::optional<Form> {
    const auto which = std::lower_bound(switches.begin(), switches.end(), node);
    if (which == switches.end() || *which != node) return std::nullopt;
    const bool first = mode[static_cast<std::size_t>(which - switches.begin())];
    return (*own)(Form::of(whole.graph[node].operands[first ? 1 : 2]));
  });
  own = &rewriter;
  for (const Form& output : whole.outputs) made.outputs.push_back(rewriter(output));
  for (const Form& rate : whole.rates) made.rates.push_back(rewriter(rate));
  return rewrite(made);
}

}  // namespace polhode::formula
