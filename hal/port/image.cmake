# takt_image(NAME MEMORY file.ld LIBRARIES targets... SOURCES files...): an image for a processor without operating
# system. MEMORY: the linker script that says where its memories are (FLASH, RAM); the rest is image.ld. Leaves NAME.elf
# with its checksum, NAME.bin, NAME.hex and NAME.map.
set(TAKT_IMAGE_FOLDER ${CMAKE_CURRENT_LIST_DIR})
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# No vectors: coefficients of a volume are taken one by one. Who stops at a broken invariant wants its file and line alone.
target_compile_definitions(takt_flags INTERFACE GRID_LANES=1 TAKT_ASSERT_WITHOUT_TEXT)

# The start of an image, and what stands under it.
if(CMAKE_SYSTEM_PROCESSOR MATCHES riscv)
  set(TAKT_IMAGE_START startup_riscv.c)
  add_library(takt_under INTERFACE)
else()
  set(TAKT_IMAGE_START startup.c)
  include(${TAKT_IMAGE_FOLDER}/image_cortex_m.cmake)
endif()

function(takt_image name)
  cmake_parse_arguments(IMAGE "" "MEMORY" "LIBRARIES;SOURCES" ${ARGN})
  cmake_path(GET IMAGE_MEMORY PARENT_PATH folder)
  cmake_path(GET IMAGE_MEMORY FILENAME memory)
  add_executable(${name} ${IMAGE_SOURCES} ${TAKT_IMAGE_FOLDER}/${TAKT_IMAGE_START} ${TAKT_IMAGE_FOLDER}/image.c)
  set_target_properties(${name} PROPERTIES SUFFIX .elf LINK_DEPENDS
    "${TAKT_IMAGE_FOLDER}/image.ld;${IMAGE_MEMORY}")
  target_compile_definitions(${name} PRIVATE TAKT_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${name} PRIVATE takt_under ${IMAGE_LIBRARIES} takt_flags)
  target_link_options(${name} PRIVATE -T${memory} -L${folder} -L${TAKT_IMAGE_FOLDER} -Wl,-Map=${CMAKE_CURRENT_BINARY_DIR}/${name}.map)
  add_custom_command(TARGET ${name} POST_BUILD
    COMMAND ${Python3_EXECUTABLE} ${TAKT_IMAGE_FOLDER}/seal_image.py ${TAKT_OBJCOPY} $<TARGET_FILE:${name}>
    COMMAND ${TAKT_OBJCOPY} -O binary $<TARGET_FILE:${name}> ${name}.bin
    COMMAND ${TAKT_OBJCOPY} -O ihex $<TARGET_FILE:${name}> ${name}.hex
    COMMAND ${TAKT_SIZE} $<TARGET_FILE:${name}>
    VERBATIM)
endfunction()
