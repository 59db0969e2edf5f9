# cmake --install: the firmware as libraries for somebody else's image, found by find_package(takt).
#
#     find_package(takt REQUIRED)
#     target_link_libraries(machine PRIVATE takt::port)      and #include <takt.h>
#
# Installed from a preset of the processor the image is for: host, m4f, m7, stm32f405. tests/target/embedder is an
# example.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Sizes that this build fixes, so that whoever includes the headers sees the structs that were built.
get_target_property(sizes takt_flags INTERFACE_COMPILE_DEFINITIONS)
if(sizes)
  target_compile_definitions(takt_base INTERFACE ${sizes})
endif()

set(installed takt_flags)
get_property(rooms GLOBAL PROPERTY TAKT_ROOMS)
foreach(room IN LISTS rooms)
  get_target_property(folder takt_${room} SOURCE_DIR)
  if(folder MATCHES "^${CMAKE_CURRENT_SOURCE_DIR}/firmware/" OR room STREQUAL hal OR room STREQUAL port)
    list(APPEND installed takt_${room})
    set_target_properties(takt_${room} PROPERTIES EXPORT_NAME ${room})
    install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/takt/${room}
      FILES_MATCHING PATTERN "*.h" PATTERN port EXCLUDE PATTERN mps2 EXCLUDE PATTERN remote EXCLUDE
      PATTERN stm32f405 EXCLUDE PATTERN toolchain EXCLUDE PATTERN host EXCLUDE)
  endif()
endforeach()
install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/hal/port/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/takt/port
  FILES_MATCHING PATTERN "*.h")
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/hal/port/takt.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/takt)

install(TARGETS ${installed} EXPORT takt ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/takt)
install(EXPORT takt NAMESPACE takt:: FILE taktConfig.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/takt)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/taktConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/taktConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/takt)
