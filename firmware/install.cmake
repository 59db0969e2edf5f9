# cmake --install: the firmware as libraries for somebody else's image, found by find_package(takt) or pkg-config.
#
#     find_package(takt REQUIRED)
#     target_link_libraries(machine PRIVATE takt::port)      and #include <takt.h>
#
# Installed from a preset of the processor the image is for: host, m4f, m7, stm32f405, stm32h743. host/examples/embedding has examples.
include(CMakePackageConfigHelpers)

# Sizes that this build fixes, so that whoever includes the headers sees the structs that were built.
get_target_property(sizes takt_flags INTERFACE_COMPILE_DEFINITIONS)
if(sizes)
  target_compile_definitions(takt_base INTERFACE ${sizes})
endif()

# takt.h stands above the folders of the rooms, installed or not.
file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/hal/port/takt.h ${CMAKE_BINARY_DIR}/rooms/port/takt.h SYMBOLIC)

option(TAKT_INSTALL "Install the firmware's libraries" ${PROJECT_IS_TOP_LEVEL})
if(NOT TAKT_INSTALL)
  return()
endif()

# What stops at a broken invariant where the image does not define that itself.
set(installed takt_flags takt_stop)
set_target_properties(takt_stop PROPERTIES EXPORT_NAME stop)
set(archives " -ltakt_stop")
get_property(rooms GLOBAL PROPERTY TAKT_ROOMS)
set(firmware ${CMAKE_CURRENT_LIST_DIR})
foreach(room IN LISTS rooms)
  get_target_property(folder takt_${room} SOURCE_DIR)
  cmake_path(IS_PREFIX firmware "${folder}" of_firmware)
  if(of_firmware OR room STREQUAL hal OR room STREQUAL port)
    list(APPEND installed takt_${room})
    set_target_properties(takt_${room} PROPERTIES EXPORT_NAME ${room})
    file(GLOB headers ${folder}/*.h)
    list(FILTER headers EXCLUDE REGEX "/takt\\.h$")
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/takt/${room})
    get_target_property(type takt_${room} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      string(PREPEND archives " -ltakt_${room}")
    endif()
  endif()
endforeach()
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/hal/port/takt.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/takt)

install(TARGETS ${installed} EXPORT takt ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/takt)
install(EXPORT takt NAMESPACE takt:: FILE taktConfig.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/takt)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/taktConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/taktConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/takt)

# For builds by other means. The archives stand in the order in which one calls the next; hal/port calls them all.
set(definitions "")
if(sizes)
  list(TRANSFORM sizes PREPEND " -D" OUTPUT_VARIABLE definitions)
endif()
string(REPLACE ";" "" definitions "${definitions}")
# Folders relative to the prefix make a package that may be moved.
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
  set(prefix ${CMAKE_INSTALL_PREFIX})
else()
  file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  set(prefix "\${pcfiledir}/${up}")
endif()
foreach(folder LIBDIR INCLUDEDIR)
  set(${folder} ${CMAKE_INSTALL_${folder}})
  if(NOT IS_ABSOLUTE ${CMAKE_INSTALL_${folder}})
    string(PREPEND ${folder} "\${prefix}/")
  endif()
endforeach()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/takt.pc "prefix=${prefix}
Name: takt
Description: ${PROJECT_DESCRIPTION}
Version: ${PROJECT_VERSION}
Cflags: -I${INCLUDEDIR}/takt${definitions}
Libs: -L${LIBDIR}/takt -Wl,--start-group${archives} -Wl,--end-group
")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/takt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
