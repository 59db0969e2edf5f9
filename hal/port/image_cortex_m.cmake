# What stands under every image for a Cortex-M: memory functions, conversions, and arithmetic where the core has no unit for
# doubles.
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
