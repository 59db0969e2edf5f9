# Gets the plotting library, once per build tree: sets PLOTLY_SCRIPT to a verified file, or to "" when there is none.
#
# Looked for in this order: TAKT_PLOTLY_TARBALL; npm, from whatever registry it is configured for; the release tag in
# the library's public repository. Whatever the source, the script must have the SHA-256 below.
set(PLOTLY_VERSION 3.7.0)
set(PLOTLY_SHA256 fa6ebaf365ea5ad46a9843ea98fb2635c998558b9d876578aa12f765f823cc3d)
set(PLOTLY_PACKAGE plotly.js-gl3d-dist-min)
set(PLOTLY_FILE plotly-gl3d.min.js)
set(PLOTLY_UPSTREAM
  https://raw.githubusercontent.com/plotly/plotly.js/v${PLOTLY_VERSION}/dist/${PLOTLY_FILE})

set(TAKT_PLOTLY_TARBALL "" CACHE STRING
  "Plotting library for reports: its package or script, a file or an address; empty: look for it; OFF: none")

set(PLOTLY_FOLDER ${CMAKE_CURRENT_BINARY_DIR}/plotly)
set(PLOTLY_SCRIPT ${PLOTLY_FOLDER}/${PLOTLY_FILE})

# Makes PLOTLY_SCRIPT of candidate, a package or the script itself, if the script has the right digest.
function(plotly_take candidate)
  set(script ${candidate})
  if(candidate MATCHES "\\.(tgz|tar\\.gz)$")
    execute_process(COMMAND ${CMAKE_COMMAND} -E tar xzf ${candidate} package/${PLOTLY_FILE}
      WORKING_DIRECTORY ${PLOTLY_FOLDER} OUTPUT_QUIET ERROR_QUIET)
    set(script ${PLOTLY_FOLDER}/package/${PLOTLY_FILE})
  endif()
  set(digest "none: no ${PLOTLY_FILE} in it")
  if(EXISTS ${script})
    file(SHA256 ${script} digest)
  endif()
  if(digest STREQUAL PLOTLY_SHA256)
    configure_file(${script} ${PLOTLY_SCRIPT} COPYONLY)
  else()
    message(WARNING "${candidate} is not used: SHA-256 ${digest}, expected ${PLOTLY_SHA256}")
  endif()
endfunction()

function(plotly_download address name)
  message(STATUS "Plotting library: downloading ${address}")
  file(DOWNLOAD ${address} ${PLOTLY_FOLDER}/${name} STATUS status TIMEOUT 60 INACTIVITY_TIMEOUT 10)
  list(GET status 0 failed)
  if(failed)
    list(GET status 1 reason)
    message(STATUS "Plotting library: ${reason}")
    file(REMOVE ${PLOTLY_FOLDER}/${name})
  else()
    plotly_take(${PLOTLY_FOLDER}/${name})
  endif()
endfunction()

function(plotly_pack)
  find_program(TAKT_NPM npm)
  mark_as_advanced(TAKT_NPM)
  if(NOT TAKT_NPM)
    return()
  endif()
  message(STATUS "Plotting library: npm pack ${PLOTLY_PACKAGE}@${PLOTLY_VERSION}")
  execute_process(
    COMMAND ${TAKT_NPM} pack ${PLOTLY_PACKAGE}@${PLOTLY_VERSION} --ignore-scripts --fetch-retries=0
      --fetch-timeout=20000
    WORKING_DIRECTORY ${PLOTLY_FOLDER} TIMEOUT 60 OUTPUT_QUIET ERROR_QUIET)
  set(package ${PLOTLY_FOLDER}/${PLOTLY_PACKAGE}-${PLOTLY_VERSION}.tgz)
  if(EXISTS ${package})
    plotly_take(${package})
  endif()
endfunction()

function(plotly_find)
  file(MAKE_DIRECTORY ${PLOTLY_FOLDER})
  if(TAKT_PLOTLY_TARBALL MATCHES "^[a-z]+://")
    get_filename_component(name ${TAKT_PLOTLY_TARBALL} NAME)
    plotly_download(${TAKT_PLOTLY_TARBALL} ${name})
  elseif(TAKT_PLOTLY_TARBALL)
    get_filename_component(given ${TAKT_PLOTLY_TARBALL} ABSOLUTE BASE_DIR ${CMAKE_SOURCE_DIR})
    plotly_take(${given})
  else()
    plotly_pack()
    if(NOT EXISTS ${PLOTLY_SCRIPT})
      plotly_download(${PLOTLY_UPSTREAM} upstream.js)
    endif()
  endif()
endfunction()

if(TAKT_PLOTLY_TARBALL MATCHES "^(OFF|NO|FALSE)$")
  set(PLOTLY_SCRIPT "")
elseif(NOT EXISTS ${PLOTLY_SCRIPT})
  plotly_find()
  if(NOT EXISTS ${PLOTLY_SCRIPT})
    set(PLOTLY_SCRIPT "")
    message(WARNING "No plotting library: `takt run --report` will write tables without plots. "
      "Give the package by -DTAKT_PLOTLY_TARBALL=FILE (host/report/README.md).")
  endif()
endif()
