# How a test is built and registered with CTest. tests/README.md says which kind belongs where.

# No test measures its own time by it.
set(TAKT_TEST_TIMEOUT_S 600 CACHE STRING "Seconds after which a test that hangs is ended")
set(TAKT_TEST_ENVIRONMENT TAKT_SOURCE=${CMAKE_SOURCE_DIR})
if(TARGET takt)
  list(APPEND TAKT_TEST_ENVIRONMENT TAKT=$<TARGET_FILE:takt>)
endif()
if(TAKT_SANITIZE)
  list(APPEND TAKT_TEST_ENVIRONMENT
    ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1)
endif()

# Settings common to every test: status 77 is a skip, its reason the last line printed.
function(takt_test_properties name label)
  set_tests_properties(${name} PROPERTIES
    LABELS "${label}"
    SKIP_RETURN_CODE 77
    TIMEOUT ${TAKT_TEST_TIMEOUT_S}
    ENVIRONMENT "${TAKT_TEST_ENVIRONMENT}")
endfunction()

# Builds NAME.c of the current folder against the rooms named.
function(takt_test_program name)
  list(TRANSFORM ARGN PREPEND takt_ OUTPUT_VARIABLE rooms)
  add_executable(${name} ${name}.c)
  target_link_libraries(${name} PRIVATE ${rooms} takt_flags m)
endfunction()

# A test inside a program cannot be skipped or left out unseen: Unity's IGNORE and a run of no tests fail.
function(takt_test_with_unity name label)
  takt_test_program(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE unity)
  add_test(NAME ${name} COMMAND ${name})
  takt_test_properties(${name} ${label})
  set_tests_properties(${name} PROPERTIES FAIL_REGULAR_EXPRESSION ":IGNORE;(^|\n)0 Tests ")
endfunction()

# takt_unit_test(NAME rooms...): NAME.c, a Unity program, about one thing of one room.
function(takt_unit_test name)
  takt_test_with_unity(${name} unit ${ARGN})
endfunction()

# takt_property_test(NAME rooms...): NAME.c, a Unity program that checks a law on random inputs of a fixed seed.
function(takt_property_test name)
  takt_test_with_unity(${name} property ${ARGN})
endfunction()

# takt_long_test(NAME LABEL argument...): a test program with Unity once more, with these arguments: NAME_long. Tests with
# the label `long` are those of `tests/run --all`.
function(takt_long_test name label)
  add_test(NAME ${name}_long COMMAND ${name} ${ARGN})
  takt_test_properties(${name}_long "${label};long")
  set_tests_properties(${name}_long PROPERTIES FAIL_REGULAR_EXPRESSION ":IGNORE;(^|\n)0 Tests ")
endfunction()

# takt_benchmark(NAME rooms...): NAME.c prints figures. Built with everything else, run by the target `bench`, not
# by CTest: a figure is neither passed nor failed.
function(takt_benchmark name)
  takt_test_program(${name} ${ARGN})
  if(NOT TARGET bench)
    add_custom_target(bench)
  endif()
  add_custom_target(run_${name} COMMAND ${name} USES_TERMINAL)
  add_dependencies(bench run_${name})
endfunction()

# takt_script_test(NAME LABEL [argument...]): the script NAME of the current folder, bash or python (NAME.py), in an
# empty folder of its own. It finds the command in $TAKT and the repository in $TAKT_SOURCE.
function(takt_script_test name label)
  cmake_path(GET name STEM test)
  add_test(NAME ${test} COMMAND ${CMAKE_SOURCE_DIR}/tests/support/run_script
    ${CMAKE_CURRENT_BINARY_DIR}/${test} ${CMAKE_CURRENT_SOURCE_DIR}/${name} ${ARGN})
  takt_test_properties(${test} ${label})
endfunction()

# takt_absent_test(NAME LABEL REASON): a test that this configuration cannot build. It is skipped, with its reason.
function(takt_absent_test name label reason)
  add_test(NAME ${name} COMMAND ${CMAKE_SOURCE_DIR}/tests/support/skip ${reason})
  takt_test_properties(${name} ${label})
endfunction()

# takt_system_test(NAME): drives the built command from outside and reads what it wrote.
function(takt_system_test name)
  takt_script_test(${name} system ${ARGN})
endfunction()

# takt_long_system_test(NAME [argument...]): the same, one of `tests/run --all`. With arguments it is the test NAME once
# more: NAME_long.
function(takt_long_system_test name)
  cmake_path(GET name STEM test)
  if(ARGN)
    string(APPEND test _long)
  endif()
  add_test(NAME ${test} COMMAND ${CMAKE_SOURCE_DIR}/tests/support/run_script
    ${CMAKE_CURRENT_BINARY_DIR}/${test} ${CMAKE_CURRENT_SOURCE_DIR}/${name} ${ARGN})
  takt_test_properties(${test} "system;long")
endfunction()

# takt_peer_test(NAME): compares with a foreign program, which may be absent. Peers judge results, not memory
# errors, so once, in the optimised build, is enough.
function(takt_peer_test name)
  if(NOT TAKT_SANITIZE)
    takt_script_test(${name} peers ${ARGN})
  endif()
endfunction()
