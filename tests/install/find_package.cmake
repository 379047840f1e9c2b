# Runs as a script: install, configure and build the consumer and the tutorial's project, merge maps with them.
set(prefix ${WORK_DIR}/prefix)
set(consumer ${WORK_DIR}/consumer)
set(maps ${SOURCE_DIR}/examples/three_robots)
file(REMOVE_RECURSE ${WORK_DIR})

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --config ${CONFIG})
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/examples/cpp -B ${consumer} -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=${CONFIG})
run(${CMAKE_COMMAND} --build ${consumer} --config ${CONFIG})

find_program(merge_maps merge_maps PATHS ${consumer} ${consumer}/${CONFIG} NO_DEFAULT_PATH REQUIRED)
run(${merge_maps} ${maps}/robot_1.yaml ${maps}/robot_2.yaml ${maps}/elsewhere.yaml)
foreach(expected "one map of 2 inputs" "left out: .*elsewhere.yaml")
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "The consumer's output lacks: ${expected}")
  endif()
endforeach()

# The tutorial's project, as its page has it, says what its page says.
set(tutorial ${WORK_DIR}/tutorial)
file(READ ${SOURCE_DIR}/docs/tutorials/cpp.md page)
function(take_block language result)
  string(FIND "${page}" "```${language}\n" begin)
  string(SUBSTRING "${page}" ${begin} -1 block)
  string(FIND "${block}" "\n" head)
  math(EXPR head "${head} + 1")
  string(SUBSTRING "${block}" ${head} -1 block)
  string(FIND "${block}" "```" end)
  string(SUBSTRING "${block}" 0 ${end} block)
  set(${result} "${block}" PARENT_SCOPE)
endfunction()
take_block(cmake lists)
take_block(cpp program)
take_block(text said)
file(WRITE ${tutorial}/CMakeLists.txt "${lists}")
file(WRITE ${tutorial}/main.cpp "${program}")
run(${CMAKE_COMMAND} -S ${tutorial} -B ${tutorial}/build -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=${CONFIG})
run(${CMAKE_COMMAND} --build ${tutorial}/build --config ${CONFIG})
find_program(merge_floor merge_floor PATHS ${tutorial}/build ${tutorial}/build/${CONFIG} NO_DEFAULT_PATH REQUIRED)
run(${CMAKE_COMMAND} -E chdir ${tutorial}
    ${merge_floor} ${maps}/robot_1.yaml ${maps}/robot_2.yaml ${maps}/robot_3.yaml ${maps}/elsewhere.yaml)
if(NOT output STREQUAL said)
  message(FATAL_ERROR "The tutorial's program says\n${output}and its page\n${said}")
endif()

run(${prefix}/bin/gridmerge --help)
