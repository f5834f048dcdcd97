// An exception in the WebAssembly module ends the call with an error of the page's: wasm32's C++
// library has no unwinding. Everything that the module throws is a std::exception and nothing else.
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>

/// The page's: throws an error with this text; does not return.
extern "C" __attribute__((import_module("gnomon"), import_name("fail"))) void gnomon_fail(
    const char* text, std::size_t length);

extern "C" {

void* __cxa_allocate_exception(std::size_t size) noexcept { return std::malloc(size); }

[[noreturn]] void __cxa_throw(void* thrown, void*, void (*)(void*)) {
  const char* what = static_cast<std::exception*>(thrown)->what();
  gnomon_fail(what, std::strlen(what));
  std::abort();
}

}  // extern "C"
