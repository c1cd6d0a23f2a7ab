#pragma once

#include "polhode/formula/table.hpp"

namespace polhode::formula {

/// The memory of one expansion.
struct Workspace {
  double* values;    ///< octets of row n
  double* waves;     ///< [row][octet][8]
  double* stores;    ///< [row][octet][left, right][8]
  double* constants; ///< general stages: [stage][alpha, c1, c2][8]
  double* older;     ///< [octet][row n, row n + 1][8]
  double* scratch;   ///< one octet for each of the states, at least one
};

/// Values of row 0 of the states and waves are in the workspace.
using TableKernel = void (*)(const TableParts& parts, const Recurrence* operations, const Workspace& workspace,
                             double unit, int order, double* rows, double* extras);

/// Null if the compiler could not build the instruction set.
TableKernel baseline_table_kernel();
TableKernel avx2_table_kernel();
TableKernel avx512_table_kernel();

}  // namespace polhode::formula
