# Finds Unity (github.com/ThrowTheSwitch/Unity), the unit test framework, and makes the target `unity` of it.
#
# Looked for in this order:
#   1. an installed Unity, if it was built with double precision assertions;
#   2. the folder UNITY_ROOT, a checkout of Unity or a folder with its three files;
#   3. the source package cjson of Debian or Ubuntu, which carries Unity for its own tests;
#   4. the release below, from upstream.
# What is found in 3 and 4 is kept in TAKT_UNITY_CACHE and is never committed.
set(UNITY_TAG v2.6.1)
set(UNITY_COMMIT cbcd08fa7de711053a3deec6339ee89cad5d2697)

set(UNITY_ROOT "" CACHE PATH "Folder of Unity's sources; empty: look for them")
set(TAKT_UNITY_CACHE ${CMAKE_BINARY_DIR}/unity CACHE PATH "Where fetched sources of Unity are kept")

# How every part of a test sees Unity, its own library included. UNITY_NO_WEAK: old releases supply setUp and
# tearDown, new ones do not; so that a test builds with both, every test has its own.
set(UNITY_DEFINITIONS UNITY_INCLUDE_DOUBLE= UNITY_DOUBLE_PRECISION=1e-12 UNITY_SUPPORT_64 UNITY_NO_WEAK)

# An installed library without doubles would fail at the first assertion on one: ask the linker beforehand.
function(unity_try_installed)
  find_path(UNITY_INSTALLED_INCLUDE unity.h PATH_SUFFIXES unity)
  find_library(UNITY_INSTALLED_LIBRARY unity)
  mark_as_advanced(UNITY_INSTALLED_INCLUDE UNITY_INSTALLED_LIBRARY)
  if(NOT UNITY_INSTALLED_INCLUDE OR NOT UNITY_INSTALLED_LIBRARY)
    return()
  endif()
  list(TRANSFORM UNITY_DEFINITIONS PREPEND -D OUTPUT_VARIABLE definitions)
  set(probe ${CMAKE_BINARY_DIR}/unity_probe.c)
  file(WRITE ${probe} "#include <unity.h>
void setUp(void) {}
void tearDown(void) {}
int main(void) { TEST_ASSERT_EQUAL_DOUBLE(1.0, 1.0); return 0; }
")
  try_compile(UNITY_INSTALLED_HAS_DOUBLE ${CMAKE_BINARY_DIR}/unity_probe ${probe}
    CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${UNITY_INSTALLED_INCLUDE}
    COMPILE_DEFINITIONS ${definitions}
    LINK_LIBRARIES ${UNITY_INSTALLED_LIBRARY})
  if(NOT UNITY_INSTALLED_HAS_DOUBLE)
    message(STATUS "Unity: the installed one has no double precision assertions, looking further")
    return()
  endif()
  add_library(unity INTERFACE)
  target_include_directories(unity SYSTEM INTERFACE ${UNITY_INSTALLED_INCLUDE})
  target_link_libraries(unity INTERFACE ${UNITY_INSTALLED_LIBRARY})
  message(STATUS "Unity: installed, ${UNITY_INSTALLED_LIBRARY}")
endfunction()

# Sets folder to the folder of unity.c below root, or to "".
function(unity_look_in root folder)
  set(${folder} "" PARENT_SCOPE)
  foreach(candidate ${root} ${root}/src)
    if(EXISTS ${candidate}/unity.c AND EXISTS ${candidate}/unity.h)
      set(${folder} ${candidate} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

function(unity_from_apt folder)
  set(kept ${TAKT_UNITY_CACHE}/cjson)
  if(NOT EXISTS ${kept}/src/unity.c)
    message(STATUS "Unity: getting the source package cjson")
    execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/unity_from_apt ${kept}
      RESULT_VARIABLE failed ERROR_VARIABLE reason OUTPUT_QUIET)
    if(failed)
      string(STRIP "${reason}" reason)
      message(STATUS "Unity: no source package: ${reason}")
    endif()
  endif()
  unity_look_in(${kept} found)
  set(${folder} "${found}" PARENT_SCOPE)
endfunction()

function(unity_from_upstream folder)
  message(STATUS "Unity: upstream, ${UNITY_TAG}")
  find_package(Git QUIET)
  if(NOT Git_FOUND)
    message(FATAL_ERROR "Unity is neither installed nor to be had from apt, and there is no git to fetch it with: "
      "give the folder of its sources by -DUNITY_ROOT=FOLDER, or build without tests by -DTAKT_TESTS=OFF")
  endif()
  set(FETCHCONTENT_BASE_DIR ${TAKT_UNITY_CACHE}/upstream)
  include(FetchContent)
  # Only the sources: a SOURCE_SUBDIR without a CMakeLists.txt keeps Unity's own targets out.
  FetchContent_Declare(unity_upstream
    GIT_REPOSITORY https://github.com/ThrowTheSwitch/Unity.git
    GIT_TAG ${UNITY_COMMIT}
    SOURCE_SUBDIR none)
  FetchContent_MakeAvailable(unity_upstream)
  unity_look_in(${unity_upstream_SOURCE_DIR} found)
  set(${folder} "${found}" PARENT_SCOPE)
endfunction()

function(unity_find_sources folder)
  if(UNITY_ROOT)
    unity_look_in(${UNITY_ROOT} found)
    if(NOT found)
      message(FATAL_ERROR "UNITY_ROOT is ${UNITY_ROOT}, but unity.c is neither there nor in src/")
    endif()
  else()
    unity_from_apt(found)
    if(NOT found)
      unity_from_upstream(found)
    endif()
  endif()
  message(STATUS "Unity: ${found}")
  set(${folder} ${found} PARENT_SCOPE)
endfunction()

if(NOT UNITY_ROOT)
  unity_try_installed()
endif()
if(NOT TARGET unity)
  unity_find_sources(UNITY_SOURCES)
  add_library(unity STATIC ${UNITY_SOURCES}/unity.c)
  target_include_directories(unity SYSTEM PUBLIC ${UNITY_SOURCES})
endif()
get_target_property(UNITY_TYPE unity TYPE)
if(UNITY_TYPE STREQUAL INTERFACE_LIBRARY)
  target_compile_definitions(unity INTERFACE ${UNITY_DEFINITIONS})
else()
  target_compile_definitions(unity PUBLIC ${UNITY_DEFINITIONS})
endif()
