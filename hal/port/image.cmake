# takt_image(NAME MEMORY file.ld LIBRARIES targets... SOURCES files...): an image for a processor without operating
# system. MEMORY: the linker script that says where its memories are (FLASH, RAM); the rest is image.ld. Leaves NAME.elf
# with its checksum, NAME.bin, NAME.hex and NAME.map.
set(TAKT_IMAGE_FOLDER ${CMAKE_CURRENT_LIST_DIR})
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# No vectors: coefficients of a volume are taken one by one. Who stops at a broken assertion wants its file and line alone.
target_compile_definitions(takt_flags INTERFACE GRID_LANES=1 "__ASSERT_FUNC=((char *)0)")

# What stands under every image: memory functions, conversions, and arithmetic where the core has no unit for doubles.
add_library(takt_under OBJECT ${TAKT_IMAGE_FOLDER}/memory.c)
set(wrapped __aeabi_l2d __aeabi_ul2d __aeabi_d2lz __aeabi_d2ulz)
# Or the compiler would find that they are memcpy and memset, and have them call themselves.
target_compile_options(takt_under PRIVATE -fno-tree-loop-distribute-patterns -O2)
target_link_libraries(takt_under PRIVATE takt_flags)
if(TAKT_CPU STREQUAL cortex-m4)
  enable_language(ASM)
  target_sources(takt_under PRIVATE ${TAKT_IMAGE_FOLDER}/conversion.c ${TAKT_IMAGE_FOLDER}/soft_double.c
    ${TAKT_IMAGE_FOLDER}/double_fast.S)
  list(APPEND wrapped __aeabi_dadd __aeabi_dsub __aeabi_drsub __aeabi_dmul __aeabi_ddiv __aeabi_dcmpeq __aeabi_dcmplt __aeabi_dcmple __aeabi_dcmpge __aeabi_dcmpgt)
else()
  target_sources(takt_under PRIVATE ${TAKT_IMAGE_FOLDER}/conversion_unit.c)
endif()
foreach(name IN LISTS wrapped)
  target_link_options(takt_under INTERFACE -Wl,--wrap=${name})
endforeach()

function(takt_image name)
  cmake_parse_arguments(IMAGE "" "MEMORY" "LIBRARIES;SOURCES" ${ARGN})
  cmake_path(GET IMAGE_MEMORY PARENT_PATH folder)
  cmake_path(GET IMAGE_MEMORY FILENAME memory)
  add_executable(${name} ${IMAGE_SOURCES} ${TAKT_IMAGE_FOLDER}/startup.c ${TAKT_IMAGE_FOLDER}/image.c)
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
