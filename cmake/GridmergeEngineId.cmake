# What tells engines apart whose matches may differ: the version, and a digest of the sources of the rooms that compare and match pairs.
# Included, it writes ${GRIDMERGE_ENGINE_ID_SOURCE} when the project is built; run as a script (cmake -P), it is what writes.
set(engine_rooms grid similarity search match preselect)

if(CMAKE_SCRIPT_MODE_FILE)
  set(digests "")
  foreach(file IN LISTS FILES)
    file(SHA256 ${SOURCE_DIR}/${file} digest)
    string(APPEND digests "${file} ${digest}\n")
  endforeach()
  string(SHA256 digest "${digests}")
  string(SUBSTRING ${digest} 0 16 digest)
  file(WRITE ${OUTPUT} "// Written by cmake/GridmergeEngineId.cmake.
#include \"gridmerge/match/stored_match.hpp\"

namespace gridmerge {

const char* engine_id() {
  return \"${VERSION}+${digest}\";
}

}  // namespace gridmerge
")
  return()
endif()

set(engine_files "")
foreach(room IN LISTS engine_rooms)
  foreach(folder src include/gridmerge)
    file(GLOB files RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/${room}/*.[ch]pp)
    list(APPEND engine_files ${files})
  endforeach()
endforeach()
list(SORT engine_files)
set(GRIDMERGE_ENGINE_ID_SOURCE ${CMAKE_CURRENT_BINARY_DIR}/engine_id.cpp)
set(engine_depends ${engine_files})
list(TRANSFORM engine_depends PREPEND ${PROJECT_SOURCE_DIR}/)
add_custom_command(
  OUTPUT ${GRIDMERGE_ENGINE_ID_SOURCE}
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DOUTPUT=${GRIDMERGE_ENGINE_ID_SOURCE}
          -DVERSION=${PROJECT_VERSION} "-DFILES=${engine_files}" -P ${CMAKE_CURRENT_LIST_FILE}
  DEPENDS ${engine_depends} ${CMAKE_CURRENT_LIST_FILE}
  VERBATIM)
