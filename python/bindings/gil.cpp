#include "gil.hpp"

#include <chrono>
#include <thread>

namespace polhode::python {

void wait_for_the_end() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

// catch (...) takes the unwinding of pthread_exit, too. It is never left.
PyGILState_STATE take_gil() {
  try {
    return PyGILState_Ensure();
  } catch (...) {
    wait_for_the_end();
  }
}

WithoutGil::WithoutGil() : guard_([] { check_signals(); }), state_(PyEval_SaveThread()) {}

WithoutGil::~WithoutGil() {
  try {
    PyEval_RestoreThread(state_);
  } catch (...) {
    wait_for_the_end();
  }
}

void check_signals() {
  with_gil([] {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  });
}

}  // namespace polhode::python
