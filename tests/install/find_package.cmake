# Runs as a script: install, configure and build the consumer, merge two maps with it.
set(prefix ${WORK_DIR}/prefix)
set(consumer ${WORK_DIR}/consumer)
set(maps ${SOURCE_DIR}/examples/three_robots)
file(REMOVE_RECURSE ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE output ECHO_OUTPUT_VARIABLE)
  set(output "${output}" PARENT_SCOPE)
endfunction()

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

run(${prefix}/bin/gridmerge --help)
