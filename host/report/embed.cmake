# Makes a C source of a file: cmake -DNAME=style -DINPUT=page.css -DOUTPUT=asset_style.c -P embed.cmake
# Plain C, so that any compiler can build it. INPUT may be empty: an asset of size 0.
set(bytes 0x00)
set(size 0)
if(INPUT)
  file(READ ${INPUT} hex HEX)
  string(LENGTH "${hex}" digits)
  math(EXPR size "${digits} / 2")
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
endif()
file(WRITE ${OUTPUT} "#include \"report/asset.h\"\n\n"
  "static const unsigned char bytes[] = {\n${bytes}};\n"
  "const struct asset asset_${NAME} = {${size}, bytes};\n")
