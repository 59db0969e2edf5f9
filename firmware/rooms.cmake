# How a room is built.
#
# A room is a folder of sources, a library, and one name to include it by: "plan/window.h" is found only by
# targets that link takt_plan. Each room therefore has an include folder of its own that holds nothing but a
# link to itself; a room that is not linked cannot be included, so data cannot flow backwards by accident
# (tests/unit/rooms proves it).

include(GNUInstallDirs)

# Flags of every target. -ffp-contract=off: a fused multiply-add rounds once where two operations round twice,
# so it would make the last bit depend on the processor.
add_library(takt_flags INTERFACE)
target_compile_options(takt_flags INTERFACE -ffp-contract=off -fno-math-errno)
# A broken invariant names its file: within the project.
target_compile_options(takt_flags INTERFACE $<BUILD_INTERFACE:-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=>)
# GCC for s390 else computes floats as doubles under -std=c11, though the processor need not.
if(CMAKE_C_COMPILER_ID STREQUAL GNU AND CMAKE_SYSTEM_PROCESSOR MATCHES "^s390")
  target_compile_options(takt_flags INTERFACE -fexcess-precision=fast)
endif()
if(TAKT_WARNINGS)
  target_compile_options(takt_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wundef
    -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition -Wcast-qual -Wpointer-arith
    -Wformat=2 -Wvla -Wswitch-enum -Werror)
  set(TAKT_SYSTEM "")
else()
  # The warnings of a project that takt is a part of are about its own sources.
  target_compile_options(takt_flags INTERFACE -w)
  set(TAKT_SYSTEM SYSTEM)
endif()
if(TAKT_SANITIZE)
  target_compile_options(takt_flags INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(takt_flags INTERFACE -fsanitize=address,undefined)
endif()

# takt_room(NAME AFTER rooms... SOURCES files...)
# AFTER: the rooms this one may include. Without SOURCES the room is headers alone.
function(takt_room name)
  cmake_parse_arguments(ROOM "" "" "AFTER;SOURCES" ${ARGN})
  set_property(GLOBAL APPEND PROPERTY TAKT_ROOMS ${name})
  set(doors ${CMAKE_BINARY_DIR}/rooms/${name})
  file(MAKE_DIRECTORY ${doors})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${doors}/${name} SYMBOLIC)
  list(TRANSFORM ROOM_AFTER PREPEND takt_ OUTPUT_VARIABLE before)
  if(ROOM_SOURCES)
    add_library(takt_${name} STATIC ${ROOM_SOURCES})
    target_include_directories(takt_${name} ${TAKT_SYSTEM} PUBLIC $<BUILD_INTERFACE:${doors}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/takt>)
    target_link_libraries(takt_${name} PUBLIC ${before} PRIVATE takt_flags)
    foreach(source IN LISTS ROOM_SOURCES)
      if(${name}/${source} IN_LIST TAKT_FAST_SOURCES)
        set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${TAKT_FAST_OPTION}")
      endif()
    endforeach()
  else()
    add_library(takt_${name} INTERFACE)
    target_include_directories(takt_${name} ${TAKT_SYSTEM} INTERFACE $<BUILD_INTERFACE:${doors}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/takt>)
    target_link_libraries(takt_${name} INTERFACE ${before})
  endif()
  add_library(takt::${name} ALIAS takt_${name})
endfunction()
