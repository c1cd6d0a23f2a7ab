#include "gil.hpp"

#include <chrono>
#include <thread>

namespace polhode::python {

void wait_for_the_end() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

// catch (...) takes the unwinding of pthread_exit, too. It is never left.
WithGil::WithGil() {
  try {
    state_ = PyGILState_Ensure();
  } catch (...) {
    wait_for_the_end();
  }
}

WithGil::~WithGil() { PyGILState_Release(state_); }

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
