# AArch64 with Debian's cross compiler, its programs run by qemu's user mode.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
# Highway's NEON kernels use the AES instructions that the base architecture leaves out.
set(CMAKE_CXX_FLAGS_INIT -march=armv8-a+crypto)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
