# clang for WebAssembly with the C library wasi-libc: Debian's clang-14, lld-14, wasi-libc and libclang-rt-14-dev-wasm32.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

find_program(CMAKE_C_COMPILER NAMES clang-14 clang REQUIRED)
find_program(CMAKE_AR NAMES llvm-ar-14 llvm-ar REQUIRED)
find_program(CMAKE_RANLIB NAMES llvm-ranlib-14 llvm-ranlib REQUIRED)

set(TAKT_WASM ON)
# posix/ has what is called of threads: CMake would look for the rest too, and then for a library.
set(CMAKE_HAVE_LIBC_PTHREAD ON)
# One thread: what is a thread's own is the module's. A function that posix/ lacks is an error, not an int from nowhere; of
# the deprecated ones it has its own.
set(CMAKE_C_FLAGS_INIT "--target=wasm32-wasi --sysroot=/usr -mbulk-memory -msimd128 -ffunction-sections -fdata-sections \
-Werror=implicit-function-declaration -Wno-deprecated-declarations -D_POSIX_C_SOURCE=200809L \
-D_Thread_local= -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_MMAN -isystem ${CMAKE_CURRENT_LIST_DIR}/posix \
-include ${CMAKE_CURRENT_LIST_DIR}/posix/posix.h")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
