#include <cstdlib>
#include <exception>
#include <typeinfo>

// Zig's C++ library cannot unwind. A refusal therefore leaves through the page: `raise` throws a JavaScript error with
// the text. No destructor runs on the way, so a refusal costs some hundred bytes of memory.
extern "C" {

__attribute__((import_module("env"), import_name("raise"))) void polhode_raise(const char* text);

void* __cxa_allocate_exception(std::size_t size) noexcept { return std::malloc(size); }
/// The page has one thread, which does not end.
int __cxa_thread_atexit(void (*)(void*), void*, void*) { return 0; }

void __cxa_free_exception(void* object) noexcept { std::free(object); }

/// Every exception of polhode and of the standard library is a std::exception, which stands first in it.
[[noreturn]] void __cxa_throw(void* object, std::type_info*, void (*)(void*)) {
  polhode_raise(static_cast<std::exception*>(object)->what());
  std::abort();
}
}
