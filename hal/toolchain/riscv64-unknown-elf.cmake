# Debian's gcc-riscv64-unknown-elf, for a processor of 64 bits with a unit for doubles: an image for QEMU's board virt.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR riscv64)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

set(CMAKE_C_COMPILER riscv64-unknown-elf-gcc)
find_program(CMAKE_AR riscv64-unknown-elf-gcc-ar)
find_program(CMAKE_RANLIB riscv64-unknown-elf-gcc-ranlib)
find_program(TAKT_OBJCOPY riscv64-unknown-elf-objcopy)
find_program(TAKT_SIZE riscv64-unknown-elf-size)

# Every function and object in a section of its own, so that the linker leaves out what no image uses; no small data, which
# image.ld does not have. Both memories are one in this board.
set(CMAKE_C_FLAGS_INIT "-march=rv64imafdc -mabi=lp64d -mcmodel=medany -msmall-data-limit=0 --specs=picolibc.specs \
-ffunction-sections -fdata-sections")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostartfiles -Wl,--gc-sections -Wl,--fatal-warnings -Wl,--no-warn-rwx-segments")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
