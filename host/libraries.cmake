# The two small libraries that files of machines and summaries are read and written with: takt_inih, takt_cjson.
#
# Those of the distribution; or, for another processor than this computer's, built from their sources, which lie in the
# folder TAKT_LIBRARIES (tests/support/libraries_from_apt makes one).
set(TAKT_LIBRARIES "" CACHE PATH "Folder of the sources of inih and cJSON; empty: those that are installed")

function(takt_foreign_library name folder)
  cmake_parse_arguments(FOREIGN "" "" "SOURCES" ${ARGN})
  list(TRANSFORM FOREIGN_SOURCES PREPEND ${TAKT_LIBRARIES}/${folder}/)
  add_library(takt_${name} STATIC ${FOREIGN_SOURCES})
  target_include_directories(takt_${name} SYSTEM PUBLIC ${TAKT_LIBRARIES}/${folder})
  set_target_properties(takt_${name} PROPERTIES C_EXTENSIONS ON)
endfunction()

if(TAKT_LIBRARIES)
  takt_foreign_library(inih inih SOURCES ini.c)
  takt_foreign_library(cjson cJSON SOURCES cjson/cJSON.c)
else()
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(inih REQUIRED IMPORTED_TARGET GLOBAL inih)
  pkg_check_modules(cjson REQUIRED IMPORTED_TARGET GLOBAL libcjson)
  add_library(takt_inih ALIAS PkgConfig::inih)
  add_library(takt_cjson ALIAS PkgConfig::cjson)
endif()
