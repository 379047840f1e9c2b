# Runs as a script: installs each component, with what it needs, into an empty prefix, and builds and runs a consumer of
# it; then the core as a part of another project; then what must be refused, with the remedy.
include(${SOURCE_DIR}/cmake/GridmergeComponents.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set(consumer ${SOURCE_DIR}/tests/install/consumer)
file(REMOVE_RECURSE ${WORK_DIR})

set(configure ${CMAKE_COMMAND} -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=${CONFIG}
              -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})

function(refuse expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code ERROR_VARIABLE errors OUTPUT_QUIET)
  string(REGEX REPLACE "[ \n]+" " " errors "${errors}")
  if(code EQUAL 0 OR NOT errors MATCHES "${expected}")
    message(FATAL_ERROR "Expected an error with '${expected}', got (${code}): ${errors}")
  endif()
endfunction()

foreach(component IN LISTS GRIDMERGE_COMPONENTS)
  set(prefix ${WORK_DIR}/${component}/prefix)
  foreach(installed IN LISTS gridmerge_${component}_needs ITEMS ${component})
    run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --config ${CONFIG} --component ${installed})
  endforeach()
  set(build ${WORK_DIR}/${component}/build)
  run(${configure} -S ${consumer} -B ${build} -D CMAKE_PREFIX_PATH=${prefix} -D COMPONENT=${component})
  run(${CMAKE_COMMAND} --build ${build} --config ${CONFIG})
  find_program(program_${component} consumer PATHS ${build} ${build}/${CONFIG} NO_DEFAULT_PATH REQUIRED)
  run(${program_${component}})
endforeach()

file(GLOB_RECURSE headers RELATIVE ${WORK_DIR}/core/prefix/include/gridmerge ${WORK_DIR}/core/prefix/include/*.hpp)
foreach(header IN LISTS headers)
  if(header MATCHES "/" AND NOT header MATCHES "^(grid|similarity|search|match)/")
    message(FATAL_ERROR "The component core installs ${header}")
  endif()
endforeach()

set(core ${WORK_DIR}/core/prefix)
# Its sources take Eigen's headers, its users do not.
run(${configure} -S ${consumer} -B ${WORK_DIR}/no_eigen -D CMAKE_PREFIX_PATH=${core} -D COMPONENT=core
    -D CMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
refuse("There is no component 'cores'; there are core, merge"
       ${configure} -S ${consumer} -B ${WORK_DIR}/wrong -D CMAKE_PREFIX_PATH=${core} -D COMPONENT=cores)
refuse("The component merge is not installed"
       ${configure} -S ${consumer} -B ${WORK_DIR}/absent -D CMAKE_PREFIX_PATH=${core} -D COMPONENT=merge)
set(lacking ${configure} -S ${consumer} -B ${WORK_DIR}/lacking -D CMAKE_PREFIX_PATH=${core} -D COMPONENT=core
            -D CMAKE_DISABLE_FIND_PACKAGE_TBB=ON)
if(SHARED)  # it names the libraries that it needs itself
  run(${lacking})
else()
  refuse("component core needs TBB \\(Debian: libtbb-dev\\)" ${lacking})
endif()
refuse("component merge needs Ceres: install it \\(Debian: libceres-dev\\), or leave it out: -DGRIDMERGE_WITH_MERGE=OFF"
       ${configure} -S ${SOURCE_DIR} -B ${WORK_DIR}/no_ceres -D CMAKE_DISABLE_FIND_PACKAGE_Ceres=ON)
refuse("component evaluate needs simulate"
       ${configure} -S ${SOURCE_DIR} -B ${WORK_DIR}/no_simulate -D GRIDMERGE_WITH_SIMULATE=OFF)

set(build ${WORK_DIR}/subdirectory)
run(${configure} -S ${SOURCE_DIR}/tests/install/subdirectory -B ${build} -D GRIDMERGE_SOURCE=${SOURCE_DIR}
    -D CMAKE_DISABLE_FIND_PACKAGE_Ceres=ON -D CMAKE_DISABLE_FIND_PACKAGE_PNG=ON
    -D CMAKE_DISABLE_FIND_PACKAGE_yaml-cpp=ON -D CMAKE_DISABLE_FIND_PACKAGE_Python3=ON)
run(${CMAKE_COMMAND} --build ${build} --config ${CONFIG})
find_program(in_subdirectory consumer PATHS ${build} ${build}/bin ${build}/${CONFIG} NO_DEFAULT_PATH REQUIRED)
run(${in_subdirectory})
