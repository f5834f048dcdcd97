# Debian's clang, lld, wasi-libc and libc++ for WebAssembly (packages.txt). No file of the system is reached: what the
# module imports is answered by the page.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
find_program(GNOMON_WASM_COMPILER clang++-16 REQUIRED)
set(CMAKE_CXX_COMPILER ${GNOMON_WASM_COMPILER})
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# There is no unwinding in this C++ library: what throws ends the call (apps/inspector/failure.cpp). clang finds libc++ itself
# only in a folder that Debian does not use.
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fignore-exceptions -nostdinc++ -isystem /usr/lib/llvm-16/include/wasm32-wasi/c++/v1")
# -O0: else clang runs whatever wasm-opt it meets over the module, and Debian's refuses what clang 16 writes.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-mexec-model=reactor -Wl,-z,stack-size=1048576 -Wl,--stack-first -Wl,--strip-all -Wl,--export=__stack_pointer -O0")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
