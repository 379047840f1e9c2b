# The letters of pictures: src/report/font.png as C++ source, so that nothing has to be found when gridmerge runs.
# Sets GRIDMERGE_FONT_SOURCE, for a target of the including folder.
set(font ${PROJECT_SOURCE_DIR}/src/report/font.png)
set(GRIDMERGE_FONT_SOURCE ${PROJECT_BINARY_DIR}/font_picture.cpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${font})
file(READ ${font} font_hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," FONT_BYTES "${font_hex}")
configure_file(${PROJECT_SOURCE_DIR}/src/report/font_picture.cpp.in ${GRIDMERGE_FONT_SOURCE} @ONLY)
