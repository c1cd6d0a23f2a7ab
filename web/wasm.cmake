# Zig's Clang for WebAssembly, from the wheel `ziglang`: -DPOLHODE_ZIG names a program that calls `zig c++`.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER ${POLHODE_ZIG}/zig-cxx)
set(CMAKE_AR ${POLHODE_ZIG}/zig-ar)
set(CMAKE_RANLIB ${POLHODE_ZIG}/zig-ranlib)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES POLHODE_ZIG)
