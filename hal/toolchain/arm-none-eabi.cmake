# Debian's gcc-arm-none-eabi, for a Cortex-M named by TAKT_CPU: cortex-m4 or cortex-m7, both with their unit for
# floating-point numbers (that of the M4 is for single precision: doubles are computed by libgcc).
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TAKT_CPU)

set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_ASM_COMPILER arm-none-eabi-gcc)
find_program(CMAKE_AR arm-none-eabi-gcc-ar)
find_program(CMAKE_RANLIB arm-none-eabi-gcc-ranlib)
find_program(TAKT_OBJCOPY arm-none-eabi-objcopy)
find_program(TAKT_SIZE arm-none-eabi-size)

set(TAKT_CPU cortex-m4 CACHE STRING "Processor of the target: cortex-m4 or cortex-m7")
if(TAKT_CPU STREQUAL cortex-m4)
  set(TAKT_FPU fpv4-sp-d16)
elseif(TAKT_CPU STREQUAL cortex-m7)
  set(TAKT_FPU fpv5-d16)
else()
  message(FATAL_ERROR "TAKT_CPU is ${TAKT_CPU}: cortex-m4 or cortex-m7 is expected")
endif()

set(TAKT_MACHINE_FLAGS "-mcpu=${TAKT_CPU} -mthumb -mfloat-abi=hard -mfpu=${TAKT_FPU}")
# Every function and object in a section of its own, so that the linker leaves out what no image uses.
set(CMAKE_C_FLAGS_INIT "${TAKT_MACHINE_FLAGS} -ffunction-sections -fdata-sections -fstack-usage")
set(CMAKE_ASM_FLAGS_INIT "${TAKT_MACHINE_FLAGS}")

# picolibc is a little smaller than newlib's nano (hal/port/README.md has the figures).
set(TAKT_LIBC picolibc CACHE STRING "C library of the target: picolibc or newlib")
if(TAKT_LIBC STREQUAL picolibc)
  string(APPEND CMAKE_C_FLAGS_INIT " --specs=picolibc.specs")
else()
  string(APPEND CMAKE_C_FLAGS_INIT " --specs=nano.specs")
endif()
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostartfiles -Wl,--gc-sections -Wl,--fatal-warnings")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)

# What every control cycle is in is built for speed, all else for size.
set(TAKT_FAST_SOURCES
  base/maths.c geometry/arc.c geometry/curve.c geometry/line.c geometry/spline.c
  motion/average.c motion/exchange.c motion/held.c motion/hold.c motion/hold_axes.c motion/hold_pieces.c motion/reference.c motion/reference_feed.c motion/reference_place.c motion/motion.c
  correction/correction.c correction/fade.c
  drive/drives_check.c drive/drives_receive.c drive/drives_send.c controller/controller.c)
set(TAKT_FAST_OPTION -O2)
# On the faster processor, whose images have flash to spare, with more of it inlined, and what only cycles are in that do
# more than others: 20 kB, and a cycle takes 90 to 280 instructions less in the mean, 160 to 440 at worst. Functions of twice the
# size that GCC itself inlines: 80 less at worst; of four times it nothing more.
if(TAKT_CPU STREQUAL cortex-m7)
  set(TAKT_FAST_OPTION -O3 --param=max-inline-insns-auto=60)
  list(APPEND TAKT_FAST_SOURCES canopen/sdo_client.c canopen/sync.c controller/approach.c controller/spindle_watch.c
    canopen/cia402.c canopen/nmt.c drive/drives_home.c drive/drives_start.c plan/ceiling.c plan/ceiling_backward.c
    plan/ramp_profile.c plan/record.c plan/record_parts.c motion/landing.c plan/path.c plan/ring.c plan/span.c program/move.c)
endif()
# With little flash memory, those of them for size as well that gain least: 2 kB, and a cycle takes 1 to 2 % longer.
if(TAKT_SMALL)
  list(REMOVE_ITEM TAKT_FAST_SOURCES motion/exchange.c motion/reference.c motion/motion.c motion/reference_feed.c motion/reference_place.c
    drive/drives_check.c drive/drives_receive.c drive/drives_send.c controller/controller.c)
endif()
