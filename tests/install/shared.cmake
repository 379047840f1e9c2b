# Runs as a script: installs shared libraries into an empty prefix. A program that hides its own symbols runs with them, and
# catches their exceptions. One that declares a function of gridmerge::internal itself does not link.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set(prefix ${WORK_DIR}/prefix)
file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --config ${CONFIG})

foreach(program exceptions internal)
  set(build_${program} ${WORK_DIR}/${program})
  run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/install/consumer -B ${build_${program}} -G ${GENERATOR}
      -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=${CONFIG}
      -D CMAKE_CXX_VISIBILITY_PRESET=hidden -D COMPONENT=io -D PROGRAM=${program})
endforeach()

run(${CMAKE_COMMAND} --build ${build_exceptions} --config ${CONFIG})
find_program(exceptions consumer PATHS ${build_exceptions} ${build_exceptions}/${CONFIG} NO_DEFAULT_PATH REQUIRED)
run(${exceptions})

execute_process(COMMAND ${CMAKE_COMMAND} --build ${build_internal} --config ${CONFIG}
                RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(code EQUAL 0 OR NOT output MATCHES "undefined (reference to|symbol).*gridmerge::internal::facing_class")
  message(FATAL_ERROR "Expected that gridmerge::internal::facing_class is not found, got (${code}): ${output}")
endif()
